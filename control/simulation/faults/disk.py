"""What can go wrong with the disk that the recordings go to."""

from __future__ import annotations

from control.registry import Parameters
from control.simulation.faults.kind import Family, FaultKind, quantity
from control.simulation.faults.points import FaultPoints


class Slow(Parameters):
    delay_s: float = quantity(3.0, "s", 0.1, 60.0, "Until written data is on the disk")


def _full(points: FaultPoints, full: bool) -> None:
    points.disk.full = full


def _read_only(points: FaultPoints, read_only: bool) -> None:
    points.disk.read_only = read_only


def _slow(points: FaultPoints, delay: float) -> None:
    points.disk.delay = delay


KINDS = (
    FaultKind(
        "disk_full", 23, Family.DISK, "Disk full",
        "No room is left for the recording.",
        "when there is room again; arm anew",
        lambda points, _: _full(points, True), lambda points: _full(points, False),
    ),
    FaultKind(
        "disk_read_only", 23, Family.DISK, "Disk read-only",
        "The folder of the recordings cannot be written to.",
        "when it can be written to; arm anew",
        lambda points, _: _read_only(points, True), lambda points: _read_only(points, False),
    ),
    FaultKind(
        "disk_slow", 23, Family.DISK, "Disk slow",
        "The disk takes long to write; up to ten seconds of a run wait for it in memory.",
        "when the disk keeps up; arm anew where a run has ended",
        lambda points, slow: _slow(points, slow.delay_s), lambda points: _slow(points, 0.0), Slow,
    ),
)  # fmt: skip
