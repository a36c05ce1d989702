"""How good the line is: the share of broken frames lately, and the time that answers take."""

from __future__ import annotations

import math
from collections import deque

from control.link import messages, wire

WINDOW = 1.0
"""How far back the share of broken frames looks, s (faults.md: bad frames a second)."""

FEWEST = 50
"""Frames that a share is taken of at least: half a second's reports. One broken frame on a quiet line is no trend."""

MOST_ENTRIES = 512
"""Polls that a second may have."""

_COUNT_MODULUS = 1 << 16

MOST_ROUND_TRIPS = 512
"""Round trips that the figures are made of: some ten seconds of driving."""


def broken_by_kind(decoder: wire.Decoder) -> dict[str, int]:
    """The frames that a decoder has dropped, by what was wrong with them."""
    return {
        "encoding": decoder.bad_cobs,
        "checksum": decoder.bad_crc,
        "oversize": decoder.oversize,
        "length": decoder.wrong_length,
        "type": decoder.unknown_type,
        "version": decoder.wrong_version,
    }


class BrokenShare:
    """The share of broken frames among all frames of the last second."""

    def __init__(self) -> None:
        self._entries: deque[tuple[float, int, int]] = deque()
        self._whole = self._broken = 0

    def add(self, now: float, whole: int, broken: int) -> None:
        """whole, broken: frames that came since the last call."""
        if whole or broken:
            self._entries.append((now, whole, broken))
            self._whole += whole
            self._broken += broken
        self._forget_before(now - WINDOW)

    def _forget_before(self, time: float) -> None:
        while self._entries and (self._entries[0][0] < time or len(self._entries) > MOST_ENTRIES):
            _, whole, broken = self._entries.popleft()
            self._whole -= whole
            self._broken -= broken

    def share(self, now: float) -> float:
        """0..1."""
        self._forget_before(now - WINDOW)
        return self._broken / max(self._whole + self._broken, FEWEST)


class RoundTrips:
    """The last round trips, s."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=MOST_ROUND_TRIPS)
        self._figures: tuple[float, float] | None = None

    @property
    def newest(self) -> float | None:
        return self._times[-1] if self._times else None

    def add(self, time: float) -> None:
        self._times.append(time)
        self._figures = None

    @property
    def figures(self) -> tuple[float, float] | None:
        """Median and 99th percentile, s; None before the first."""
        if self._figures is None and self._times:
            ordered = sorted(self._times)
            rank = math.ceil(0.99 * len(ordered)) - 1
            self._figures = ordered[(len(ordered) - 1) // 2], ordered[rank]
        return self._figures


class Echoes:
    """Times one command after the other on its way to the board and back, from the arm edge on."""

    def __init__(self) -> None:
        self.round_trips = RoundTrips()
        self._waiting: tuple[int, float] | None = None
        self._certain = 0.0
        self._heard_at = -math.inf

    def begin(self) -> None:
        """The next command is the first one that counts."""
        self._waiting = None
        self._certain = 0.0

    def sent(self, sequence: int, now: float) -> None:
        if self._waiting is None:
            self._waiting = sequence, now

    def heard(self, echoed: int, now: float) -> None:
        """A report names the newest command that the board had heard."""
        if self._waiting is not None:
            self._compare(echoed, *self._waiting, now)
        self._heard_at = now

    def _compare(self, echoed: int, sequence: int, sent_at: float, now: float) -> None:
        if wire.sequence_distance(echoed, sequence) < wire.SEQUENCE_WINDOW:
            self.round_trips.add(now - sent_at)
            self._certain = max(0.0, self._heard_at - sent_at)
            self._waiting = None

    def unheard(self, now: float) -> float:
        """How long a command has been waiting for its echo, s; 0 when none does."""
        return 0.0 if self._waiting is None else now - self._waiting[1]

    @property
    def lateness(self) -> float:
        """How long a command and its echo certainly take, s.

        An echo counts only up to the last report before it: if nobody looked, or the board is silent, the line is
        not slow.
        """
        return max(self._certain, self.unheard(self._heard_at))


class BoardCounts:
    """The board's own 16-bit counts of what it heard, as steps from report to report."""

    def __init__(self) -> None:
        self._last: tuple[int, int, int, int] | None = None

    def step(self, report: messages.Telemetry) -> tuple[int, int]:
        """Whole and broken frames that the board has heard since the last report."""
        counts = (report.bad, report.good, report.refused, report.stale)
        last, self._last = self._last or counts, counts
        broken, *whole = ((new - old) % _COUNT_MODULUS for new, old in zip(counts, last, strict=True))
        return sum(whole), broken
