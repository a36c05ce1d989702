"""Gait calibration: walk a star on the rig and identify what its camera saw."""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.gait import Gait
from control.gait_model import GaitModel
from control.identification import Sample, identify
from control.model import Pose
from control.runs import Choice, RunRequest, Selection
from control.safety import Refused
from control.snapshot import Snapshot
from server.assembly import Machine
from server.headless import HeadlessRun, run_headless
from server.settings import MM, MS

ENOUGH_PASSES = 1000.0
"""The star ends by itself; the path, which it does not look at, must not end it sooner."""
DRIFT = 0.010
"""The slip of all legs together may carry the robot this far from where it began, m."""


@dataclass(frozen=True, slots=True)
class Star:
    """legs: walked out and back.  leg: m.  rate: rad/s, on the way out."""

    legs: int = 5
    leg: float = 0.020
    rate: float = math.radians(100.0)


@dataclass(frozen=True, slots=True)
class GaitCalibration:
    """model: what was identified.  sightings: how many the camera contributed."""

    model: GaitModel
    run: HeadlessRun
    sightings: int


def calibrate_gait(
    machine: Machine, id: str, gait: Gait, star: Star, *, consent: bool = False
) -> GaitCalibration:
    """Arm (consent: as in `run_headless`), walk, disarm, identify.

    Raises `Refused`, and `TooLittle` when the walk does not show enough.
    """
    recorder = _Recorder(machine, star)
    run = run_headless(machine, id, _request(gait, star), recorder.watch, consent=consent)
    model = identify(recorder.samples, switch_time=machine.settings.link.ramp_ms * MS)
    return GaitCalibration(model, run, len(recorder.samples))


def _request(gait: Gait, star: Star) -> RunRequest:
    parameters = {
        "legs": star.legs,
        "leg_mm": star.leg / MM,
        "rate_deg_s": math.degrees(star.rate),
    }
    selection = Selection(Choice("star", parameters), Choice("eight"), gait)
    return RunRequest(selection, passes=ENOUGH_PASSES, label="gait calibration")


class _Recorder:
    """Keeps each accepted sighting of the run with the field of its instant."""

    def __init__(self, machine: Machine, star: Star) -> None:
        self.samples: list[Sample] = []
        self._loop = machine.loop
        self._delay = machine.settings.estimator.actuation_delay_ms * MS
        self._room = machine.coils.workspace - star.leg - DRIFT
        self._newest = -math.inf

    def watch(self, snapshot: Snapshot) -> None:
        sighting = snapshot.observation.measurement if snapshot.observation is not None else None
        if snapshot.run is None or sighting is None or sighting.captured_at <= self._newest:
            return
        if not self.samples:
            self._require_room(sighting.pose)
        self._newest = sighting.captured_at
        heading, elevation = self._loop.field_at(sighting.captured_at - self._delay)
        self.samples.append(Sample(sighting.captured_at, sighting.pose, heading, elevation))

    def _require_room(self, pose: Pose) -> None:
        if not max(abs(pose.x), abs(pose.y)) <= self._room:
            raise Refused(
                f"the robot stands at ({pose.x / MM:.0f}, {pose.y / MM:.0f}) mm, which leaves no room for the "
                f"star; put it within ±{max(self._room, 0.0) / MM:.0f} mm of the centre, or walk shorter legs"
            )
