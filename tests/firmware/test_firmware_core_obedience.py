"""What the C++ core obeys, refuses and counts is what the twin does, message by message."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from twins import ARMING, CALM, CONFIGURE, Twins

from control.link import messages, wire
from control.link.board_limits import CONFIGURATION_LIMITS
from control.link.messages import BoardCode, Hello, Refusal


def refused(twins: Twins) -> Refusal:
    twins.run(20)
    return Refusal(twins.reports[-1].last_refusal)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"flags": 2}, Refusal.FLAGS),
        ({"flags": 3}, Refusal.FLAGS),
        ({"pivot": 0}, Refusal.PIVOT),
        ({"pivot": 2}, Refusal.PIVOT),
        ({"rate": CONFIGURE.max_rate + 1}, Refusal.RATE),
        ({"rate": -CONFIGURE.max_rate - 1}, Refusal.RATE),
        ({"tilt": CONFIGURE.max_tilt + 1}, Refusal.TILT),
        ({"field": CONFIGURE.max_field + 1}, Refusal.FIELD),
        ({"time_to_live": 0}, Refusal.LIFETIME),
        ({"rate": CONFIGURE.max_rate, "tilt": CONFIGURE.max_tilt, "field": 20000}, Refusal.NONE),
        ({"rate": -CONFIGURE.max_rate, "tilt": 0, "field": 0, "time_to_live": 1}, Refusal.NONE),
    ],
)
def test_a_drive_outside_its_limits_is_refused(driving: Twins, changes: dict, reason: Refusal) -> None:
    driving.say(replace(CALM, **changes))
    assert refused(driving) == reason


def test_a_drive_without_arm_edge_configuration_or_greeting_is_refused(twins: Twins) -> None:
    twins.say(ARMING)
    twins.say(CONFIGURE)
    twins.say(Hello())
    twins.say(ARMING)
    assert refused(twins) == Refusal.STATE
    twins.say(CONFIGURE)
    twins.say(CALM)
    assert refused(twins) == Refusal.STATE
    assert twins.twin.state == BoardCode.READY


@pytest.mark.parametrize("changes", [{"sequence": 2}, {"sequence": 1003}, {"boot_id": 8}])
def test_a_message_out_of_order_or_for_another_boot_is_not_obeyed(ready: Twins, changes: dict) -> None:
    ready.say(ARMING, **changes)
    assert ready.twin.state == BoardCode.READY
    ready.run(20)
    assert ready.reports[-1].stale + ready.reports[-1].refused == 1


@pytest.mark.parametrize("sequence", [3, 1002])
def test_a_message_within_the_window_is_obeyed(ready: Twins, sequence: int) -> None:
    ready.say(ARMING, sequence=sequence)
    assert ready.twin.state == BoardCode.DRIVING


def test_another_version_is_greeted_but_not_obeyed(twins: Twins) -> None:
    twins.say(Hello(), version=9)
    twins.say(Hello())
    twins.say(CONFIGURE, version=9)
    assert refused(twins) == Refusal.VERSION
    assert twins.reports[-1].bad == 1


def test_a_greeting_keeps_the_configuration_and_zeroes_the_drive(driving: Twins) -> None:
    driving.say(Hello())
    assert driving.twin.state == BoardCode.READY
    driving.run(20)
    assert driving.reports[-1].configuration_hash == wire.configuration_hash(CONFIGURE)


def test_a_message_of_the_other_direction_is_refused(ready: Twins) -> None:
    ready.say(messages.Banner((1, 2, 3), 4, 5))
    assert refused(ready) == Refusal.DIRECTION
    ready.say(messages.Banner((1, 2, 3), 4, 5), version=3)
    ready.say(ready.reports[-1])
    ready.run(20)
    assert ready.reports[-1].refused == 3


def just_outside() -> list[tuple[str, Any]]:
    """Every allowed range of a configuration, one below and one above where the wire can say it."""
    cases: list[tuple[str, Any]] = []
    for name, (low, high) in CONFIGURATION_LIMITS.items():
        value = getattr(CONFIGURE, name)
        top = 2**32 - 1 if name == "max_rate" else 65535
        for limit in (low - 1, low, high, high + 1):
            if not 0 <= limit <= top:
                continue
            if not isinstance(value, tuple):
                cases.append((name, limit))
                continue
            cases += [(name, (*value[:place], limit, *value[place + 1 :])) for place in range(len(value))]
    return cases


@pytest.mark.parametrize(("name", "value"), just_outside())
def test_a_configuration_at_the_edge_of_a_range(twins: Twins, name: str, value: Any) -> None:
    twins.say(Hello())
    twins.say(replace(CONFIGURE, **{name: value}))
    twins.say(ARMING)
    twins.run(20)


def test_a_coil_that_is_too_fast_to_regulate_is_refused(twins: Twins) -> None:
    twins.say(Hello())
    twins.say(replace(CONFIGURE, resistances=(2500, 2000, 2801)))
    assert refused(twins) == Refusal.CONFIGURATION
    twins.say(replace(CONFIGURE, resistances=(2500, 2000, 2800)))
    assert twins.twin.state == BoardCode.READY


def test_a_configuration_is_refused_while_driving(driving: Twins) -> None:
    driving.say(CONFIGURE)
    assert refused(driving) == Refusal.STATE


def test_a_configuration_whose_checksum_is_zero_has_the_hash_one(twins: Twins) -> None:
    """0 stands for no configuration."""
    body = next(layout for layout in wire.LAYOUTS if layout.message is messages.Configure)
    zero = next(
        message
        for supply in range(5000, 50001)
        for message in [replace(CONFIGURE, supply=supply)]
        for field in (message, replace(message, max_field=19999))
        if wire.crc_hqx(body.pack(field), 0xFFFF) == 0
        for message in [field]
    )
    twins.say(Hello())
    twins.say(zero)
    twins.run(20)
    assert twins.reports[-1].configuration_hash == 1


def test_broken_frames_are_counted_once_each(ready: Twins) -> None:
    frame = wire.encode(CALM, 3, 7)
    unknown = wire.cobs.encode(bytes.fromhex("09 01 0300 0700") + b"\x12\x34")
    short = wire.encode(CALM, 3, 7)[:-3] + b"\0"
    pieces = (
        *(
            b"\0\0",
            b"\x01\0",
            b"\x05\x01\0",
            b"\xff" * 64 + b"\0",
            b"\x01" * 65 + b"\0",
            b"\x02" * 200 + b"\0",
        ),
        *(frame[:9] + b"\x55" + frame[10:], b"\0" + unknown + b"\0", short),
    )
    for piece in pieces:
        for byte in piece:
            ready.receive(bytes([byte]))
    wrong = bytes.fromhex("05 01 0300 0700 00")  # a Stop with a body
    unknown = bytes.fromhex("63 01 0300 0700")
    for payload in (wrong, unknown):
        crc = wire.crc_hqx(payload, 0xFFFF).to_bytes(2, "little")
        ready.receive(b"\0" + wire.cobs.encode(payload + crc) + b"\0")
    ready.run(20)
    assert ready.reports[-1].bad == 10


def test_a_message_that_finds_no_room_is_dropped_whole(twins: Twins) -> None:
    """The banner of 17 bytes fits 15 times, and reports of 57 bytes as they can."""
    for number in range(1, 40):
        frame = wire.encode(Hello(), number, 0)
        twins.twin.receive(frame)
        twins.core.receive(frame)
    for _ in range(50):
        twins.tick((0, 0, 0), most=5)
    twins.drain()
    assert len(twins.heard) > 255
