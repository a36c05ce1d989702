"""What can go wrong on the computer: its time, its numbers, and the controllers that run on it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from control.registry import Parameters
from control.simulation.faults.kind import WHEN_TAKEN_AWAY, Family, FaultKind, quantity
from control.simulation.faults.points import FaultPoints, Nonsense

MS = 1e-3


class Stall(Parameters):
    stall_ms: float = quantity(400.0, "ms", 10.0, 1000.0, "How long the loop stands still")


class Sleep(Parameters):
    gap_s: float = quantity(2.0, "s", 0.1, 5.0, "How far the clock is ahead afterwards")


class Hang(Parameters):
    hang_s: float = quantity(3.0, "s", 0.1, 60.0, "How long the controller does not come back")


class Answer(Parameters):
    answer: Annotated[
        Nonsense,
        Field(
            title="Answer",
            description="A rate that is no number or endless, a text, nothing, or a pivot that there is not.",
        ),
    ] = "nan"


def _reports(points: FaultPoints, not_a_number: bool) -> None:
    points.reports.not_a_number = not_a_number


def _raises(points: FaultPoints, raises: bool) -> None:
    points.decisions.raises = raises


def _hangs(points: FaultPoints, duration: float) -> None:
    points.decisions.hangs = duration


def _answers(points: FaultPoints, nonsense: Nonsense | None) -> None:
    points.decisions.nonsense = nonsense


KINDS = (
    FaultKind(
        "loop_stalls", 17, Family.COMPUTER, "Loop stalls",
        "The computer is too busy to look at the robot for a moment.",
        "at once; resume",
        lambda points, stall: points.camera.pass_time(stall.stall_ms * MS),
        parameters=Stall, happens_once=True,
    ),
    FaultKind(
        "computer_sleeps", 31, Family.COMPUTER, "Computer sleeps",
        "The computer was asleep, or its clock jumped: suddenly it is later.",
        "at once; resume",
        lambda points, sleep: points.camera.jump(sleep.gap_s), parameters=Sleep, happens_once=True,
    ),
    FaultKind(
        "report_nan", 19, Family.COMPUTER, "Report is not a number",
        "The currents that the board reports are not numbers.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _reports(points, True), lambda points: _reports(points, False),
    ),
    FaultKind(
        "controller_raises", 18, Family.CONTROLLER, "Controller fails",
        "The controller has a mistake and raises an error; only while a run is on.",
        "when the controller is mended; reset and arm anew",
        lambda points, _: _raises(points, True), lambda points: _raises(points, False),
    ),
    FaultKind(
        "controller_hangs", 18, Family.CONTROLLER, "Controller hangs",
        "The controller does not come back with its decision; only while a run is on.",
        "when it comes back; reset and arm anew",
        lambda points, hang: _hangs(points, hang.hang_s), lambda points: _hangs(points, 0.0), Hang,
    ),
    FaultKind(
        "controller_nonsense", 18, Family.CONTROLLER, "Controller returns nonsense",
        "The controller's decision is nothing that a rig can do; only while a run is on.",
        "when the controller is mended; reset and arm anew",
        lambda points, answer: _answers(points, answer.answer), lambda points: _answers(points, None),
        Answer,
    ),
)  # fmt: skip
