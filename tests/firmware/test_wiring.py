"""The wiring table and the drawing show the pins that the firmware uses."""

from __future__ import annotations

import re
from pathlib import Path

FIRMWARE = Path(__file__).parents[2] / "control" / "firmware"
PURPOSES = ("INA", "INB", "EN/DIAG", "PWM", "CS")
PWM_PINS = {"OCR1A": "D9", "OCR1B": "D10", "OCR2B": "D3"}
FIRST_PIN = {"B": ("D", 8), "C": ("A", 0), "D": ("D", 0)}
"""What bit 0 of each port is called on an UNO (datasheet and the UNO's pinout)."""

Wiring = list[dict[str, str]]


def in_the_code() -> Wiring:
    bridges = (FIRMWARE / "avr" / "bridges.cpp").read_text(encoding="utf-8")
    sensing = (FIRMWARE / "avr" / "sensing.cpp").read_text(encoding="utf-8")
    inputs = re.search(r"inputs\[input_count\] = \{(.*?)\}", sensing)
    assert inputs is not None
    senses = [f"A{number.strip()}" for number in inputs[1].split(",")]
    assert senses[3] == "A5"
    bodies = re.findall(r"^struct Bridge\d \{(.*?)^\};", bridges, re.MULTILINE | re.DOTALL)
    return [_pins(body, sense) for body, sense in zip(bodies, senses, strict=False)]


def _pins(body: str, sense: str) -> dict[str, str]:
    compare = re.search(r"void compare\(.*?\) \{ (\w+) =", body)
    assert compare is not None
    pins = (
        _set_in(body, "forward"),
        _set_in(body, "backward"),
        _set_in(body, "disable"),
        PWM_PINS[compare[1]],
        sense,
    )
    return dict(zip(PURPOSES, pins, strict=True))


def _set_in(body: str, function: str) -> str:
    """The pin whose bit that function sets."""
    found = re.search(rf"void {function}\(\) \{{[^}}]*?set\(\w+, (?:PORT|DD)(\w)(\d)\)", body)
    assert found is not None, function
    letter, first = FIRST_PIN[found[1]]
    return f"{letter}{first + int(found[2])}"


def in_the_table() -> Wiring:
    readme = (FIRMWARE / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| coil \d .*$", readme, re.MULTILINE)
    return [dict(zip(PURPOSES, re.split(r"\s*\|\s*", row)[2:7], strict=True)) for row in rows]


def in_the_drawing() -> Wiring:
    drawing = (FIRMWARE / "wiring.svg").read_text(encoding="utf-8")
    at_the_uno = r'class="pin" [^>]*y="(\d+)" text-anchor="end">([DA]\d+)<'
    pins = {int(height): pin for height, pin in re.findall(at_the_uno, drawing)}
    purposes = re.findall(r'class="pin" [^>]*y="(\d+)">(\S+?)<', drawing)
    drawn = [(purpose, pins[int(height)]) for height, purpose in purposes if purpose in PURPOSES]
    return [dict(drawn[start : start + len(PURPOSES)]) for start in range(0, len(drawn), len(PURPOSES))]


def test_the_table_and_the_drawing_show_the_pins_that_the_firmware_uses() -> None:
    assert len(in_the_code()) == 3
    assert in_the_table() == in_the_code()
    assert in_the_drawing() == in_the_code()
