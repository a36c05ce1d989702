"""Faults of the serial line, put before any port: pulled plugs, jams, noise, lost, repeated and swapped messages.

The switches may be changed at any time; all are off at first, and then every byte passes as it came.
"""

from __future__ import annotations

import errno
import random
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from serial.serialutil import SerialException, SerialTimeoutException

from control.link.line import SerialLine

MOST_HELD = 1024
"""Frames that a delayed line holds each way; what comes when it is full is lost."""

MOST_PARTIAL = 256
"""Bytes without a delimiter that are taken for the beginning of a frame; longer ones pass as they are."""

REMEMBERED = 16
"""Frames that may come once more."""

LONGEST_NOISE = 40
"""Bytes of one burst of noise."""


@dataclass(slots=True)
class LineFaults:
    """unplugged: the port is gone and cannot be opened.  jammed: it takes no bytes.  silent: nothing comes.

    lost, repeated, reordered, garbage: share (0..1) of the frames, each way, that vanish, come once more a while
    later, swap places with the next one, or meet with noise (every other one is broken by it).
    delay: of every frame, each way, s; looked after whenever the port is used, so to a tick.
    clock: of the rig, s.  met: how many frames met with what.
    """

    clock: Callable[[], float]
    seed: int = 1
    unplugged: bool = False
    jammed: bool = False
    silent: bool = False
    lost: float = 0.0
    repeated: float = 0.0
    reordered: float = 0.0
    garbage: float = 0.0
    delay: float = 0.0
    met: Counter[str] = field(default_factory=Counter)

    def wrap(self, port: SerialLine) -> SerialLine:
        """The port behind these faults; raises SerialException while it is unplugged."""
        self.check_plugged()
        return FaultyPort(port, self)

    def check_plugged(self) -> None:
        if self.unplugged:
            raise SerialException(errno.ENODEV, "the cable is unplugged (an injected fault)")

    def clear(self) -> None:
        """All switches off."""
        self.unplugged = self.jammed = self.silent = False
        self.lost = self.repeated = self.reordered = self.garbage = self.delay = 0.0

    @property
    def touch_frames(self) -> bool:
        return any((self.lost, self.repeated, self.reordered, self.garbage, self.delay))


class FaultyPort:
    """A port behind `LineFaults`."""

    def __init__(self, port: SerialLine, faults: LineFaults) -> None:
        self._port = port
        self._faults = faults
        self._from_board = Lane(faults, f"{faults.seed} in")
        self._to_board = Lane(faults, f"{faults.seed} out")
        self._ready = bytearray()

    @property
    def in_waiting(self) -> int:
        self._faults.check_plugged()
        self._send_due()
        self._receive()
        return len(self._ready)

    def _receive(self) -> None:
        waiting = self._port.in_waiting
        arrived = self._port.read(waiting) if waiting else b""
        if not self._faults.silent:
            self._from_board.put(arrived)
            self._ready += self._from_board.take()

    def _send_due(self) -> None:
        due = self._to_board.take()
        if due:
            self._port.write(due)

    @property
    def out_waiting(self) -> int:
        self._faults.check_plugged()
        return self._port.out_waiting

    def read(self, size: int = 1, /) -> bytes:
        self._faults.check_plugged()
        taken = bytes(self._ready[:size])
        del self._ready[:size]
        return taken

    def write(self, b: Any, /) -> int:
        self._faults.check_plugged()
        if self._faults.jammed:
            raise SerialTimeoutException("Write timeout")
        self._to_board.put(bytes(b))
        self._send_due()
        return len(b)

    def reset_output_buffer(self) -> None:
        self._port.reset_output_buffer()

    def close(self) -> None:
        self._port.close()


class Lane:
    """One direction: bytes go in, come out later, fewer, twice or broken."""

    def __init__(self, faults: LineFaults, seed: str) -> None:
        self._faults = faults
        self._dice = random.Random(seed)
        self._partial = b""
        self._swapped = b""
        self._passed: deque[bytes] = deque(maxlen=REMEMBERED)
        self._queue: deque[tuple[float, bytes]] = deque()

    def put(self, data: bytes) -> None:
        if not self._faults.touch_frames:
            self._let_everything_out(data)
            return
        *pieces, self._partial = (self._partial + data).split(b"\0")
        for piece in pieces:
            if piece:
                self._meet_faults(b"\0" + piece + b"\0")
        if len(self._partial) > MOST_PARTIAL:
            self._hold(self._partial)
            self._partial = b""

    def _let_everything_out(self, data: bytes) -> None:
        """Nothing that passes now is repeated by a later fault, when the board may have booted anew."""
        rest = self._swapped + self._partial + data
        self._swapped = self._partial = b""
        self._passed.clear()
        if rest:
            self._hold(rest)

    def _meet_faults(self, frame: bytes) -> None:
        if self._meets("lost"):
            return
        if self._meets("garbage"):
            frame = self._noise() + self._broken(frame)
        if not self._swapped and self._meets("reordered"):
            self._swapped = frame
            return
        self._pass_on(frame)
        if self._swapped:
            late, self._swapped = self._swapped, b""
            self._pass_on(late)

    def _pass_on(self, frame: bytes) -> None:
        self._hold(frame)
        self._passed.append(frame)
        if self._meets("repeated"):
            self._hold(self._dice.choice(self._passed))

    def _meets(self, fault: str) -> bool:
        share = {
            "lost": self._faults.lost,
            "garbage": self._faults.garbage,
            "reordered": self._faults.reordered,
            "repeated": self._faults.repeated,
        }[fault]
        met = self._dice.random() < share
        self._faults.met[fault] += met
        return met

    def _noise(self) -> bytes:
        return self._dice.randbytes(self._dice.randint(1, LONGEST_NOISE))

    def _broken(self, frame: bytes) -> bytes:
        """With one bit turned over, or, every other time, as it was."""
        if self._dice.random() < 0.5:
            return frame
        bit = self._dice.randrange(8 * len(frame))
        broken = bytearray(frame)
        broken[bit // 8] ^= 1 << bit % 8
        return bytes(broken)

    def _hold(self, data: bytes) -> None:
        if len(self._queue) < MOST_HELD:
            self._queue.append((self._faults.clock() + self._faults.delay, data))

    def take(self) -> bytes:
        """What is due, in the order in which it came; a stop from another thread may be under way meanwhile."""
        due = bytearray()
        now = self._faults.clock()
        while self._queue:
            try:
                entry = self._queue.popleft()
            except IndexError:
                break  # the other thread took it
            if not entry[0] <= now:
                self._queue.appendleft(entry)
                break
            due += entry[1]
        return bytes(due)
