"""Files that are not what they were, for tests of what reads them."""

from __future__ import annotations

import contextlib
import random
import struct
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import zstandard
from mcap.exceptions import McapError
from mcap.reader import NonSeekingReader, make_reader
from mcap.records import Statistics
from mcap_doctor import placed
from recordings_bench import RecordingsBench, Walk

from server.recording.reading.recording import Recording, Unreadable
from server.recording.reading.tick_reading import Tick

HUGE = (1 << 20, (1 << 31) - 1, 1 << 31, (1 << 32) - 1, 1 << 40, 1 << 62, (1 << 63) - 1, (1 << 64) - 1)
"""What a length field may claim."""


def small_recording(data: Path) -> Path:
    """A second with three tiny pictures, as the recorder writes it."""
    bench = RecordingsBench()
    bench.frame = replace(bench.frame, image=bench.frame.image[200:232, 300:348].copy())
    id = bench.record(data, Walk(duration=0.75, rate=16.0, frame_rate=4.0, trajectory="line"))
    return data / "recordings" / f"{id}.mcap"


def read_all(path: Path) -> list[Tick]:
    """Everything that a recording can be asked for; its ticks, none for a file that is no recording."""
    try:
        with Recording.open(path) as recording:
            _ask(recording)
            return list(recording.ticks())
    except Unreadable:
        return []


def ticks_of(path: Path) -> list[Tick]:
    """As `read_all`, without asking for anything else."""
    try:
        with Recording.open(path) as recording:
            return list(recording.ticks())
    except Unreadable:
        return []


def is_recording(path: Path) -> bool:
    try:
        Recording.open(path).close()
    except Unreadable:
        return False
    return True


def newest_tick(path: Path) -> Tick:
    """The last tick of a recording, found without reading all of it; empty where there is none."""
    try:
        with Recording.open(path) as recording:
            return recording.tick_at(recording.duration) or {}
    except Unreadable:
        return {}


def outcome_of(path: Path) -> dict[str, Any]:
    with Recording.open(path) as recording:
        assert recording.outcome is not None
        return recording.outcome


def overview_of(path: Path) -> dict[str, Any]:
    with Recording.open(path) as recording:
        assert recording.overview is not None
        return recording.overview


def statistics_of(path: Path) -> Statistics:
    """By the public reader, which seeks to the end for them."""
    with path.open("rb") as file:
        summary = make_reader(file, validate_crcs=True).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    return summary.statistics


def ticks_by_public_reader(path: Path) -> int:
    """As somebody without pivotrig reads a torn file: from its beginning, until the reader says that it is over."""
    return _count(path, "/state")


def frames_by_public_reader(path: Path) -> int:
    return _count(path, "/camera")


def _count(path: Path, topic: str) -> int:
    found = 0
    with path.open("rb") as file, contextlib.suppress(McapError, struct.error, zstandard.ZstdError):
        for _ in NonSeekingReader(file).iter_messages(topic, log_time_order=False):
            found += 1
    return found


def _ask(recording: Recording) -> None:
    for _ in recording.messages():
        pass
    for _ in recording.frames():
        pass
    for time in (-1.0, 0.0, 0.3, recording.duration, 1e12, float("nan")):
        recording.tick_at(time)
        recording.frame_at(time)
    recording.events()
    for told in (recording.settings, recording.outcome, recording.overview, recording.metadata):
        assert told is None or isinstance(told, dict)
    assert recording.duration >= 0.0
    assert recording.ended_at >= recording.started_at


def damaged(data: bytes, count: int, seed: int) -> Iterator[bytes]:
    """Copies of a file with one to twenty places changed at random: a bit, a byte, or eight bytes that claim much."""
    chance = random.Random(seed)
    for _ in range(count):
        changed = bytearray(data)
        for _ in range(chance.choice((1, 1, 2, 20))):
            at = chance.randrange(len(changed) - 8)
            kind = chance.random()
            if kind < 0.4:
                changed[at] ^= 1 << chance.randrange(8)
            elif kind < 0.7:
                changed[at] = chance.randrange(256)
            else:
                changed[at : at + 8] = chance.choice(HUGE).to_bytes(8, "little")
        yield bytes(changed)


def with_lengths(path: Path, length: int) -> Iterator[bytes]:
    """Copies of a file in each of which another record claims to be that long."""
    data = path.read_bytes()
    for at, _, _ in placed(path):
        yield data[: at + 1] + length.to_bytes(8, "little") + data[at + 9 :]
