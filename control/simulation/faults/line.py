"""What can go wrong on the serial line between computer and board."""

from __future__ import annotations

from control.registry import Parameters
from control.simulation.faults.kind import WHEN_TAKEN_AWAY, Family, FaultKind, quantity, share
from control.simulation.faults.points import FaultPoints

MS = 1e-3


class Lost(Parameters):
    share: float = share(0.3, "Share of the messages that are lost, each way")


class Repeated(Parameters):
    share: float = share(0.3, "Share of the messages that come again later")


class Reordered(Parameters):
    share: float = share(0.3, "Share of the messages that are overtaken by the next one")


class Garbage(Parameters):
    share: float = share(0.3, "Share of the messages that are spoilt or have garbage before them")


class Slow(Parameters):
    delay_ms: float = quantity(100.0, "ms", 0.0, 2000.0, "Delay of every byte, each way")


def _unplugged(points: FaultPoints, on: bool) -> None:
    points.line.unplugged = on


def _silent(points: FaultPoints, on: bool) -> None:
    points.line.silent = on


def _jammed(points: FaultPoints, on: bool) -> None:
    points.line.jammed = on


def _garbage(points: FaultPoints, spoilt: float) -> None:
    points.line.garbage = spoilt


def _lost(points: FaultPoints, lost: float) -> None:
    points.line.lost = lost


def _repeated(points: FaultPoints, repeated: float) -> None:
    points.line.repeated = repeated


def _reordered(points: FaultPoints, reordered: float) -> None:
    points.line.reordered = reordered


def _delay(points: FaultPoints, delay: float) -> None:
    points.line.delay = delay


KINDS = (
    FaultKind(
        "line_unplugged", 9, Family.LINE, "Board unplugged",
        "The board's cable is out.",
        "when the cable is back: the rig finds the board again; arm anew",
        lambda points, _: _unplugged(points, True), lambda points: _unplugged(points, False),
    ),
    FaultKind(
        "line_silent", 9, Family.LINE, "Board silent",
        "Nothing comes from the board any more, though its port is there.",
        "when the board speaks again; arm anew",
        lambda points, _: _silent(points, True), lambda points: _silent(points, False),
    ),
    FaultKind(
        "line_jammed", 10, Family.LINE, "Line jammed",
        "The port takes no bytes any more.",
        "when the port takes bytes again; arm anew",
        lambda points, _: _jammed(points, True), lambda points: _jammed(points, False),
    ),
    FaultKind(
        "line_garbage", 11, Family.LINE, "Garbage on the line",
        "Interference spoils messages both ways.",
        WHEN_TAKEN_AWAY,
        lambda points, garbage: _garbage(points, garbage.share), lambda points: _garbage(points, 0.0),
        Garbage,
    ),
    FaultKind(
        "line_loses", 12, Family.LINE, "Messages lost",
        "A share of the messages does not arrive.",
        WHEN_TAKEN_AWAY,
        lambda points, lost: _lost(points, lost.share), lambda points: _lost(points, 0.0), Lost,
    ),
    FaultKind(
        "line_repeats", 12, Family.LINE, "Messages repeated",
        "Old messages come again.",
        WHEN_TAKEN_AWAY,
        lambda points, repeated: _repeated(points, repeated.share), lambda points: _repeated(points, 0.0),
        Repeated,
    ),
    FaultKind(
        "line_reorders", 12, Family.LINE, "Messages out of order",
        "Messages overtake each other.",
        WHEN_TAKEN_AWAY,
        lambda points, late: _reordered(points, late.share), lambda points: _reordered(points, 0.0),
        Reordered,
    ),
    FaultKind(
        "line_slow", 12, Family.LINE, "Line slow",
        "Every byte takes its time, each way.",
        WHEN_TAKEN_AWAY,
        lambda points, slow: _delay(points, slow.delay_ms * MS), lambda points: _delay(points, 0.0), Slow,
    ),
)  # fmt: skip
