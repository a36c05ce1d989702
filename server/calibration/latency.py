"""Latency calibration: turn the robot to and fro on the rig, and find how late its camera is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from control.calibration.latency import Delay, WiggleRecord, delay_of
from control.calibration.turning import Unclear
from control.controllers.wiggle import WiggleParameters
from control.gait import Gait
from control.model import Pose
from control.runs import Choice, RunRequest, Selection
from control.snapshot import Snapshot
from server.assembly import Machine
from server.calibration.walk import ENOUGH_PASSES, Findings, measured_today
from server.headless import run_headless
from server.settings import MS

GRID = 0.001
"""The field's heading is noted so often, s: its corners are then off by no more than 0.1 degrees at 100 degrees/s."""
ACTUATION = 0.001
"""Standard error of the rig file's actuation delay, s: a tick of the board, and what a command takes to get there."""
BELOW_ZERO = 0.005
"""An answer may be below zero by this, s, which is what the rig file's actuation delay may be off."""


@dataclass(frozen=True, slots=True)
class Latency:
    """The camera's, in all, s.  delay: what the wiggle showed beyond what the rig file had."""

    latency: float
    delay: Delay

    @property
    def standard_error(self) -> float:
        """Of the fit, and of what is subtracted with the actuation delay, s."""
        return math.hypot(self.delay.standard_error, ACTUATION)


class LatencyWalk:
    """What to walk, what to note meanwhile, and what it says."""

    advice = ""
    rests_on: tuple[str, ...] = ("camera", "estimator.actuation_delay_ms")

    def __init__(self, machine: Machine, gait: Gait, wiggle: WiggleParameters) -> None:
        self._loop = machine.loop
        self._known = machine.settings.subtracted_latency_ms * MS
        self._actuation_delay = machine.settings.estimator.actuation_delay_ms * MS
        self._turns = wiggle.turns
        self._record = WiggleRecord()
        choice = Choice("wiggle", wiggle.model_dump())
        self.request = RunRequest(
            Selection(choice, Choice("eight"), gait), passes=ENOUGH_PASSES, label="latency calibration"
        )

    def check(self, pose: Pose) -> None:
        """It turns on the spot; where a turn leads out of the workspace, the walk itself is held."""

    def watch(self, snapshot: Snapshot) -> None:
        """Note the newest sighting and what the field has done since the last tick."""
        if snapshot.run is None:
            return
        self._note_field(snapshot.time)
        sighting = snapshot.observation.measurement if snapshot.observation is not None else None
        if sighting is not None and sighting.captured_at > self._record.seen_until:
            self._record.sighting(sighting.captured_at, sighting.pose)

    def _note_field(self, now: float) -> None:
        since = self._record.field_known_until
        if not math.isfinite(since):
            self._note_field_at(now)
            return
        for step in range(1, 1 + math.floor((now - since) / GRID)):
            self._note_field_at(since + step * GRID)

    def _note_field_at(self, time: float) -> None:
        self._record.field(time, self._loop.field_at(time - self._actuation_delay)[0])

    def progress(self, snapshot: Snapshot) -> float:
        """0..1."""
        return 0.0 if snapshot.run is None else min(1.0, snapshot.run.sweeps / self._turns)

    def findings(self) -> Findings:
        """The figures, and what of them the rig file has a place for."""
        found = self.found()
        return Findings(figures(found), changes(found))

    def found(self) -> Latency:
        """Raises `Unclear`."""
        delay = delay_of(self._record.wiggled)
        latency = self._known + delay.delay
        if not latency >= -BELOW_ZERO:
            raise Unclear(
                f"the picture shows the robot {-latency / MS:.1f} ms before the field has turned it: "
                "estimator.actuation_delay_ms is too large by as much, or the camera's stamps are wrong"
            )
        return Latency(max(0.0, latency), delay)


def calibrate_latency(
    machine: Machine, id: str, gait: Gait, wiggle: WiggleParameters, *, consent: bool = False
) -> Latency:
    """Arm (consent: as in `run_headless`), turn to and fro, disarm, work it out. Raises `Refused`, `Unclear`."""
    walk = LatencyWalk(machine, gait, wiggle)
    run_headless(machine, id, walk.request, walk.watch, consent=consent)
    return walk.found()


def figures(found: Latency) -> dict[str, Any]:
    """Each figure with its standard error where it has one, in the lab's units."""
    delay = found.delay
    return {
        "latency_ms": {
            "value": round(found.latency / MS, 3),
            "standard_error": round(found.standard_error / MS, 3),
        },
        "play_deg": round(math.degrees(delay.play), 3),
        "residual_deg": round(math.degrees(delay.residual), 4),
        "gain": round(delay.gain, 4),
        "sightings": delay.sightings,
    }


def changes(found: Latency) -> dict[str, Any]:
    """What of it belongs into the rig file."""
    source = measured_today(f"standard error {found.standard_error / MS:.2f} ms")
    return {"camera": {"latency_ms": round(found.latency / MS, 2), "latency_source": source}}
