"""Sizes and ages as people write them."""

from __future__ import annotations

import math
import re

import typer

UNITS = {"kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}
"""Bytes."""
DAYS = {"h": 1 / 24, "d": 1.0, "w": 7.0, "y": 365.25}
_WRITTEN = re.compile(r"(\d+(?:\.\d+)?)\s*([a-zA-Z]*)")


def size_text(size: float) -> str:
    """Three digits and a unit. size: bytes."""
    if size < 1e3:
        return f"{size:.0f} B"
    unit = max((unit for unit, value in UNITS.items() if value <= size), key=UNITS.__getitem__)
    number = size / UNITS[unit]
    return f"{number:.{max(0, 2 - int(math.log10(number)))}f} {unit}"


def gigabytes(text: str) -> float:
    """`20GB`, `500 MB`, `1.5TB`; a bare number is GB. Raises typer.BadParameter."""
    by_name = {unit.lower(): value for unit, value in UNITS.items()}
    return _read(text, by_name, "GB", "a size such as 20GB or 500MB") / 1e9


def days(text: str) -> float:
    """`30d`, `12h`, `4w`, `1y`; a bare number is days. Raises typer.BadParameter."""
    return _read(text, DAYS, "d", "an age such as 30d, 12h or 4w")


def _read(text: str, units: dict[str, float], bare: str, allowed: str) -> float:
    written = _WRITTEN.fullmatch(text.strip())
    unit = (written[2] or bare).lower() if written else ""
    if written is None or unit not in units or not 0.0 < float(written[1]) <= 1e9:
        raise typer.BadParameter(f"{text!r} is not {allowed}")
    return float(written[1]) * units[unit]
