"""The raw traffic of a serial line in a file: every byte of both directions, with the rig's time.

    python -m control.link.traffic FILE

prints such a file decoded. Writing happens on a thread of its own; whoever reads or writes the port only leaves a
note for it, and when it cannot keep up, notes are dropped and counted in the file.

A file is the 8 bytes PVTLOG1\\n and then entries: time (f64, s), kind (u8), length (u16), and that many bytes; all
little-endian. Kind 0 came from the board, 1 went to it, 2 says how many entries (u32) were dropped here.
"""

from __future__ import annotations

import argparse
import logging
import struct
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import Any, BinaryIO

from control.link import wire
from control.link.line import SerialLine
from control.link.quality import broken_by_kind

log = logging.getLogger(__name__)

MAGIC = b"PVTLOG1\n"

LARGEST_FILE = 16 << 20
"""Bytes, about 20 minutes of driving."""

KEPT_FILES = 5
"""With the one that is written: at most 80 MiB, the last hour and a half."""

MOST_NOTES = 4096
"""Notes that wait for the writer: 20 s of driving."""

PACE = 0.25
"""How often the writer looks, s."""

LAST_NOTES = 1.0
"""The writer gets this long to come to an end, s: the rig's own end does not wait for a disk."""

_ENTRY = struct.Struct("<dBH")
_COUNT = struct.Struct("<I")
_LONGEST = 0xFFFF


class Kind(IntEnum):
    FROM_BOARD = 0
    TO_BOARD = 1
    DROPPED = 2


@dataclass(frozen=True, slots=True)
class Entry:
    """time: of the rig, s."""

    time: float
    kind: Kind
    data: bytes


class TrafficLog:
    """Writes what passes the lines that it wraps, to `file` and its predecessors `file`.1, .2 and so on."""

    def __init__(self, file: Path, clock: Callable[[], float], largest: int = LARGEST_FILE) -> None:
        self.file = file
        self.problem = ""
        """Why nothing is written any more; a log that fails does not concern the rig."""
        self._clock = clock
        self._largest = largest
        self._notes: deque[Entry] = deque()
        self._dropped = 0
        self._ending = threading.Event()
        self._writer: threading.Thread | None = None

    def wrap(self, port: SerialLine) -> SerialLine:
        """The port with this log listening; begins a new file at the first one."""
        if self._writer is None:
            self._ending = threading.Event()
            self._writer = threading.Thread(
                target=self._write, args=(self._ending,), name="traffic log", daemon=True
            )
            self._writer.start()
        return TappedPort(port, self)

    def note(self, kind: Kind, data: bytes) -> None:
        """Takes a note, from any thread; never waits."""
        if len(self._notes) >= MOST_NOTES:
            self._dropped += 1
            return
        self._notes.append(Entry(self._clock(), kind, data))

    def close(self) -> None:
        """Writes what is noted and ends, without waiting for a disk that hangs; `wrap` begins anew."""
        self._ending.set()
        if self._writer is not None:
            self._writer.join(LAST_NOTES)
            self._writer = None

    # ---- on the writer's thread

    def _write(self, ending: threading.Event) -> None:
        try:
            has_ended = False
            while not has_ended:
                has_ended = self._write_one_file(ending)
        except OSError as error:
            self.problem = f"the traffic log stopped: {error}"
            log.warning("%s", self.problem)

    def _write_one_file(self, ending: threading.Event) -> bool:
        """Until it is full, or the log is to end: true then."""
        self.file.parent.mkdir(parents=True, exist_ok=True)
        rotate(self.file)
        with self.file.open("xb") as out:
            out.write(MAGIC)
            while out.tell() < self._largest:
                is_ending = ending.wait(PACE)
                self._write_notes(out)
                if is_ending:
                    return True
        return False

    def _write_notes(self, out: BinaryIO) -> None:
        for _ in range(len(self._notes)):
            out.write(packed(self._notes.popleft()))
        dropped, self._dropped = self._dropped, 0
        if dropped:
            out.write(packed(Entry(self._clock(), Kind.DROPPED, _COUNT.pack(dropped))))
        out.flush()


class TappedPort:
    """A port whose traffic is noted."""

    def __init__(self, port: SerialLine, traffic: TrafficLog) -> None:
        self._port = port
        self._traffic = traffic

    @property
    def in_waiting(self) -> int:
        return self._port.in_waiting

    @property
    def out_waiting(self) -> int:
        return self._port.out_waiting

    def read(self, size: int = 1, /) -> bytes:
        data = self._port.read(size)
        if data:
            self._traffic.note(Kind.FROM_BOARD, data)
        return data

    def write(self, b: Any, /) -> int | None:
        """Noted when the port has taken it."""
        taken = self._port.write(b)
        self._traffic.note(Kind.TO_BOARD, bytes(b))
        return taken

    def reset_output_buffer(self) -> None:
        self._port.reset_output_buffer()

    def close(self) -> None:
        self._port.close()


def rotate(file: Path) -> None:
    """Makes room for a new `file`: it becomes .1, that one .2, and the oldest is deleted."""
    names = [file, *(file.with_name(f"{file.name}.{number}") for number in range(1, KEPT_FILES))]
    for older, newer in zip(reversed(names), reversed(names[:-1]), strict=False):
        if newer.exists():
            newer.replace(older)


def packed(entry: Entry) -> bytes:
    data = entry.data[:_LONGEST]
    return _ENTRY.pack(entry.time, entry.kind, len(data)) + data


class NotATrafficLog(ValueError):
    """The file is something else; the text says what it begins with."""


def read_log(file: Path) -> Iterator[Entry]:
    """The entries of a file, oldest first; one that was cut off at the end is left out."""
    with file.open("rb") as source:
        begin = source.read(len(MAGIC))
        if begin != MAGIC:
            raise NotATrafficLog(f"{file} is no traffic log: it begins with {begin!r}, not {MAGIC!r}")
        while len(header := source.read(_ENTRY.size)) == _ENTRY.size:
            time, kind, length = _ENTRY.unpack(header)
            data = source.read(length)
            if len(data) < length or kind not in tuple(Kind):
                return
            yield Entry(time, Kind(kind), data)


def in_words(entries: Iterator[Entry]) -> Iterator[str]:
    """One line for each message, each broken frame and each gap."""
    decoders = {Kind.FROM_BOARD: wire.Decoder(), Kind.TO_BOARD: wire.Decoder()}
    arrows = {Kind.FROM_BOARD: "board ->", Kind.TO_BOARD: "-> board"}
    for entry in entries:
        if entry.kind is Kind.DROPPED:
            yield f"{entry.time:12.4f}  {_COUNT.unpack(entry.data)[0]} entries are missing here"
            continue
        begin = f"{entry.time:12.4f}  {arrows[entry.kind]}  "
        yield from (begin + line for line in _decoded(decoders[entry.kind], entry.data))


def _decoded(decoder: wire.Decoder, data: bytes) -> Iterator[str]:
    before = broken_by_kind(decoder)
    for packet in decoder.feed(data):
        yield f"#{packet.sequence} boot {packet.boot_id}  {packet.message}"
    for kind, count in broken_by_kind(decoder).items():
        if count > before[kind]:
            yield f"{count - before[kind]} broken ({kind}) in {data.hex(' ')}"


def main() -> None:
    parser = argparse.ArgumentParser(description="Prints a traffic log of the serial line, decoded.")
    parser.add_argument(
        "file", type=Path, help="link-traffic.log of the data folder, or one of its predecessors"
    )
    options = parser.parse_args()
    try:
        for line in in_words(read_log(options.file)):
            print(line)
    except (OSError, NotATrafficLog) as error:
        sys.exit(f"traffic: {error}")


if __name__ == "__main__":
    main()
