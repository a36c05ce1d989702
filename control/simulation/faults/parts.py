"""Parts of the rig that can fail on demand: each is the real part with a fault point in front of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from control.controllers import Decision, Law, Situation
from control.link.conversion import Telemetry
from control.link.port import Link
from control.model import Expectation, Frame, Observation, Pose
from control.perception import Tracker
from control.simulation.faults.points import Decisions, Nonsense, Reports, Sighting

HANG_STEP = 0.02
"""A hanging controller looks this often whether it may come back, s."""

NO_NUMBERS = (math.nan, math.nan, math.nan)


class FaultyTracker:
    """A tracker whose measurements may be wrong."""

    def __init__(self, tracker: Tracker, sighting: Sighting) -> None:
        self._tracker = tracker
        self._sighting = sighting

    def update(self, frame: Frame, expected: Expectation | None) -> Observation:
        observation = self._tracker.update(frame, expected)
        measurement = observation.measurement
        if measurement is None:
            return observation
        return replace(observation, measurement=replace(measurement, pose=self._spoilt(measurement.pose)))

    def _spoilt(self, pose: Pose) -> Pose:
        if self._sighting.not_a_number:
            return Pose(math.nan, math.nan, math.nan)
        dx, dy = self._sighting.offset
        return Pose(pose.x + dx, pose.y + dy, pose.heading)

    def reset(self) -> None:
        self._tracker.reset()


class FaultyLink(Link):
    """A link whose reports may be wrong although they came whole."""

    reports: Reports = Reports()

    def poll(self) -> Telemetry | None:
        telemetry = super().poll()
        if telemetry is None or not self.reports.not_a_number:
            return telemetry
        return replace(telemetry, currents=NO_NUMBERS, measured_currents=NO_NUMBERS, heading=math.nan)


class FaultyController:
    """A controller that may raise, hang or return nonsense. pass_time: lets rig time pass while it hangs."""

    def __init__(self, controller: Law, decisions: Decisions, pass_time: Callable[[float], None]) -> None:
        self._controller = controller
        self._decisions = decisions
        self._pass_time = pass_time
        self.name = controller.name

    def step(self, situation: Situation) -> Any:
        decision = self._controller.step(situation)
        if self._decisions.raises:
            raise ZeroDivisionError("injected")
        if self._decisions.hangs > 0.0:
            self._hang()
        if self._decisions.nonsense is not None:
            return _nonsense(self._decisions.nonsense, decision)
        return decision

    def _hang(self) -> None:
        """Until the time is over or the fault has been taken away, which may happen while it hangs."""
        hung = 0.0
        while hung < self._decisions.hangs:
            self._pass_time(HANG_STEP)
            hung += HANG_STEP
        self._decisions.hangs = 0.0


def _nonsense(kind: Nonsense, decision: Decision) -> Any:
    return {
        "nan": replace(decision, rate=math.nan),
        "inf": replace(decision, rate=math.inf),
        "text": "left",
        "nothing": None,
        "pivot": replace(decision, pivot=7),  # type: ignore[arg-type]
    }[kind]
