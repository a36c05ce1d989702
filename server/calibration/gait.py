"""Gait calibration: walk a star on the rig and identify what its camera saw."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from control.controllers.star import SHORT_SWEEP
from control.gait import Gait
from control.gait_model import GaitModel
from control.identification import Sample, identify
from control.model import TURN, Pose, wrap
from control.runs import Choice, RunRequest, Selection
from control.safety import Refused
from control.snapshot import Snapshot
from server.assembly import Machine
from server.calibration.walk import ENOUGH_PASSES, Findings, measured_today, with_advice
from server.headless import HeadlessRun, run_headless
from server.settings import MM, MS, RigFile

DRIFT = 0.010
"""The slip of all legs together may carry the robot this far from where it began, m."""
LATENCY_FIRST = (
    "the camera's latency has not been measured, and a star swings too fast for that: measure it first "
    "(`pivotrig calibrate latency --save`)"
)
SIGNIFICANT = 2.0
"""An angle between the frames is corrected when it is more than so many of its standard errors."""

FIGURES: dict[str, tuple[str, float]] = {
    "length": ("length_mm", MM),
    "backlash": ("backlash_deg", math.radians(1.0)),
    "heading_offset": ("heading_offset_deg", math.radians(1.0)),
    "skew": ("skew_deg", math.radians(1.0)),
    "out": ("out_mm", MM),
    "forward_base": ("forward_base_mm", MM),
    "forward_per_sweep": ("forward_per_sweep_mm_rad", MM),
    "lag": ("lag_ms", MS),
}
"""Fields of `GaitModel`, their names outside, and the unit in SI."""


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
    walk = StarWalk(machine, gait, star)
    try:
        run = run_headless(machine, id, walk.request, walk.watch, consent=consent)
    except Refused as error:
        raise Refused(with_advice(str(error), walk.advice)) from error
    return GaitCalibration(walk.model(), run, len(walk.samples))


class StarWalk:
    """Keeps each accepted sighting of the run with the field of its instant."""

    rests_on: tuple[str, ...] = (
        "camera",
        "robot",
        "coils",
        "estimator.actuation_delay_ms",
        "vision.heading_offset_deg",
    )

    def __init__(self, machine: Machine, gait: Gait, star: Star) -> None:
        self.samples: list[Sample] = []
        self.request = _request(gait, star)
        self._settings = machine.settings
        self._loop = machine.loop
        self._delay = machine.settings.estimator.actuation_delay_ms * MS
        self._room = machine.coils.workspace - star.leg - DRIFT
        self._sweeps = _sweeps(gait, star, machine.settings.robot.length_mm * MM)
        self._newest = -math.inf
        self._has_room = False
        self.advice = "" if machine.settings.latency_is_known else LATENCY_FIRST

    def check(self, pose: Pose) -> None:
        """Raises `Refused` where the legs would not fit."""
        if not max(abs(pose.x), abs(pose.y)) <= self._room:
            raise Refused(
                f"the robot stands at ({pose.x / MM:.0f}, {pose.y / MM:.0f}) mm, which leaves no room for the "
                f"star; put it within ±{max(self._room, 0.0) / MM:.0f} mm of the centre, or walk shorter legs"
            )
        self._has_room = True

    def watch(self, snapshot: Snapshot) -> None:
        """Keep a new sighting; raises `Refused` at the first one when nobody has asked `check` before."""
        sighting = snapshot.observation.measurement if snapshot.observation is not None else None
        if snapshot.run is None or sighting is None or sighting.captured_at <= self._newest:
            return
        if not self._has_room:
            self.check(sighting.pose)
        self._newest = sighting.captured_at
        heading, elevation = self._loop.field_at(sighting.captured_at - self._delay)
        self.samples.append(Sample(sighting.captured_at, sighting.pose, heading, elevation))

    def progress(self, snapshot: Snapshot) -> float:
        """By the sweeps that a robot without slip would need."""
        return 0.0 if snapshot.run is None else min(0.99, snapshot.run.sweeps / self._sweeps)

    def model(self) -> GaitModel:
        """Raises `TooLittle`."""
        return identify(self.samples, switch_time=self._settings.link.ramp_ms * MS)

    def findings(self) -> Findings:
        """The figures, and what of them the rig file has a place for."""
        model = self.model()
        return Findings(figures_json(model), changes(model, self._settings))


def _request(gait: Gait, star: Star) -> RunRequest:
    parameters = {
        "legs": star.legs,
        "leg_mm": star.leg / MM,
        "rate_deg_s": math.degrees(star.rate),
    }
    selection = Selection(Choice("star", parameters), Choice("eight"), gait)
    return RunRequest(selection, passes=ENOUGH_PASSES, label="gait calibration")


def _sweeps(gait: Gait, star: Star, length: float) -> float:
    """How many sweeps the star takes: L sin(w / 2) along a leg for each (paper, section 3), and those that turn."""
    widths = [gait.sweep * (1.0 if number % 2 == 0 else SHORT_SWEEP) for number in range(star.legs)]
    along = sum(2.0 * (1.0 + star.leg / (length * math.sin(0.5 * width))) for width in widths)
    return along + TURN / gait.sweep


def figures_json(model: GaitModel) -> dict[str, dict[str, float]]:
    """Each figure with its standard error, in the lab's units."""
    values = asdict(model)
    errors = values["uncertainty"]
    return {
        name: {"value": round(values[field] / unit, 5), "standard_error": round(errors[field] / unit, 5)}
        for field, (name, unit) in FIGURES.items()
    }


def changes(model: GaitModel, settings: RigFile) -> dict[str, Any]:
    """What the rig file becomes, nested.

    Two angles are parted by what they turn with. The skew is between the coloured body and the line of the
    pivots: it belongs to how the robot is seen, wherever it stands. What the field's heading then is beyond
    the pivots' is between coils and camera (or magnet and body, which no walk tells from it): it belongs to
    the registration, as seen heading less the field's.
    """
    figures = figures_json(model)
    value = {name: round(figure["value"], 3) for name, figure in figures.items()}
    error = {name: figure["standard_error"] for name, figure in figures.items()}
    found: dict[str, Any] = {
        "robot": {"length_mm": value["length_mm"]},
        "estimator": {"backlash_deg": max(0.0, value["backlash_deg"])},
        "gait": {name: value[name] for name in ("out_mm", "forward_base_mm", "forward_per_sweep_mm_rad")},
    }
    found["gait"]["source"] = measured_today(
        f"standard errors: length {error['length_mm']:.3f} mm, out {error['out_mm']:.3f} mm, "
        f"forward {error['forward_base_mm']:.3f} mm, play {error['backlash_deg']:.2f} degrees"
    )
    return {**found, **_turned_frames(value, error, settings)}


def _turned_frames(value: dict[str, float], error: dict[str, float], settings: RigFile) -> dict[str, Any]:
    """The changes of the angles that are more than chance."""
    found: dict[str, Any] = {}
    skew = value["skew_deg"]
    if not abs(skew) > SIGNIFICANT * error["skew_deg"]:
        skew = 0.0
    if skew:
        found["vision"] = {"heading_offset_deg": round(settings.vision.heading_offset_deg + skew, 3)}
    turn = skew - value["heading_offset_deg"]
    if abs(turn) > SIGNIFICANT * math.hypot(error["heading_offset_deg"], error["skew_deg"] if skew else 0.0):
        rotation = math.radians(settings.coils.registration.rotation_deg + turn)
        found["coils"] = {"registration": {"rotation_deg": round(math.degrees(wrap(rotation)), 3)}}
    return found
