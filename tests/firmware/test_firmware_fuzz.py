"""No bytes crash the board or make it drive: random ones, broken messages, and every single wrong bit."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path

import pytest
from core_library import SANITIZERS, compiled, run_stream
from exchanges import mutated
from twins import ARMING, CALM, CONFIGURE, Twins

from control.link import messages, wire
from control.link.messages import Banner, Hello, Message, Stop, Telemetry
from control.simulation.twin import FirmwareTwin

TELEMETRY = Telemetry(
    *(100000, 3221225472, -4551, (6000, -30, 0), (5980, -35, 0), (20000, 0, -256), 24000),
    *(2, 8, 4711, 6000, 3, 2, 1, 7, 0xBEEF),
)
EXAMPLES: tuple[Message, ...] = (Hello(), Stop(), Banner((0, 1, 0), 1, 2), CONFIGURE, CALM, ARMING, TELEMETRY)
CHUNK = 50
"""Bytes of one millisecond at 500 kbaud."""


@pytest.fixture(scope="module")
def fuzz_program() -> Path:
    """The core with address and undefined-behaviour sanitizers."""
    return compiled("fuzz", "fuzz.cpp", *SANITIZERS)


def twin_through(data: bytes) -> list[int]:
    """What the fuzz program prints, by the twin: state, three PWM steps, ticks that drove."""
    twin, noise, driven = FirmwareTwin(7), 0, 0
    for start in range(0, len(data), CHUNK):
        twin.receive(data[start : start + CHUNK])
        noise = (noise * 25173 + 13849) & 0xFFFF
        counts = noise >> 8
        twin.tick((counts, counts >> 3, counts >> 5), counts)
        twin.transmit(4096)
        driven += twin.state == messages.BoardCode.DRIVING
    return [int(twin.state), *twin.duty, driven]


def test_random_bytes_crash_nothing_and_drive_nothing(fuzz_program: Path, full: bool) -> None:
    data = random.Random(1).randbytes(1_000_000 if full else 100_000)
    assert twin_through(data) == run_stream(fuzz_program, data) == [0, 0, 0, 0, 0]


def test_small_numbers_crash_nothing_and_drive_nothing(fuzz_program: Path, full: bool) -> None:
    """Short frames with many delimiters and code bytes."""
    source = random.Random(2)
    data = bytes(source.choices(range(12), k=1_000_000 if full else 100_000))
    assert twin_through(data) == run_stream(fuzz_program, data) == [0, 0, 0, 0, 0]


def broken_conversation(size: int) -> bytes:
    """Valid messages in order, every third one broken; a fault is followed by a new beginning."""
    source = random.Random(3)
    data, sequence = bytearray(wire.encode(Hello(), 0, 7)), 0
    while len(data) < size:
        sequence = (sequence + 1) & 0xFFFF
        message = source.choices((CALM, ARMING, CONFIGURE, Stop(), Hello(), TELEMETRY), (20, 4, 2, 1, 1, 1))[
            0
        ]
        if message is CALM:
            message = replace(CALM, pivot=source.choice((1, -1)), rate=source.randrange(-(10**6), 10**6))
        frame = wire.encode(message, sequence, 7)
        data += mutated(source, frame) if source.random() < 0.33 else frame
    return bytes(data)


def test_broken_messages_among_whole_ones_crash_nothing(fuzz_program: Path, full: bool) -> None:
    data = broken_conversation(1_000_000 if full else 100_000)
    seen = twin_through(data)
    assert run_stream(fuzz_program, data) == seen
    assert seen[-1] > 0.1 * len(data) / CHUNK


@pytest.mark.parametrize("message", EXAMPLES, ids=lambda message: type(message).__name__)
@pytest.mark.parametrize("boot_id", [7, 0x0100, 0xFFFF])
@pytest.mark.parametrize("number", [0, 250, 0x1234])
def test_no_single_wrong_bit_is_obeyed(message: Message, boot_id: int, number: int) -> None:
    """Neither by the twin nor by the core; a delimiter follows, so that nothing is left over."""
    with Twins(boot_id) as twins:
        twins.say(Hello(), sequence=number)
        twins.say(CONFIGURE)
        good, refused = twins.twin._good, twins.twin._refused
        frame = wire.encode(message, number + 2, boot_id)
        for bit in range(8 * len(frame)):
            broken = bytearray(frame)
            broken[bit // 8] ^= 1 << (bit % 8)
            twins.receive(bytes(broken) + b"\0")
            assert twins.twin.state == messages.BoardCode.READY
        assert (twins.twin._good, twins.twin._refused) == (good, refused)
        twins.run(10)
        assert twins.reports[-1].good == good
        assert twins.reports[-1].bad >= 8 * (len(frame) - 2)


@pytest.mark.parametrize("pivot", [1, -1])
def test_no_single_wrong_bit_of_a_command_renews_a_drive(pivot: int) -> None:
    with Twins() as twins:
        for message in (Hello(), CONFIGURE, ARMING):
            twins.say(message)
        good = twins.twin._good
        frame = wire.encode(replace(CALM, pivot=pivot), twins.sequence + 1, 7)
        for bit in range(8 * len(frame)):
            broken = bytearray(frame)
            broken[bit // 8] ^= 1 << (bit % 8)
            twins.receive(bytes(broken) + b"\0")
        assert twins.twin._good == good
        twins.run(150)
        assert twins.twin.state == messages.BoardCode.EXPIRED
