"""One run in plain Python: the rig's own walk, tick by tick, without camera, line and currents."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from control.gait_model import GaitModel
from control.metrics import Metrics
from control.model import Pivot, Pose
from control.runs import RunRequest
from control.simulation.plants import build_plant
from control.studies.batch.bench import RIG, BatchRig, Bench
from control.studies.batch.outcome import RunFailed
from control.trajectories.trajectory import Path
from control.walk import Walk
from control.walker import ControllerFault

if TYPE_CHECKING:
    from control.studies.plan import PlannedRun


@dataclass(frozen=True, slots=True)
class Step:
    """One tick. time: since the walk began, s.  reference: the desired point, m.  field_heading: rad."""

    time: float
    pose: Pose
    reference: tuple[float, float]
    pivot: Pivot
    field_heading: float


Watch = Callable[[Step], None]


def plain_walk(run: PlannedRun, watch: Watch | None = None, rig: BatchRig = RIG) -> Metrics:
    """The figures of one run; raises `RunFailed` where a rig would have ended it, and what a bad choice raises."""
    start = start_of(run)
    bench = Bench(build_plant(run.plant, rig.length, start, run.seed), run.selection.gait, rig)
    bench.advance(rig.rest)
    walk = _walk(run, bench, rig)
    try:
        _carry_out(walk, bench, rig, watch)
    except ControllerFault as fault:
        raise RunFailed(str(fault)) from fault
    return walk.metrics()


def start_of(run: PlannedRun) -> Pose:
    """Where the robot begins: as planned, else at the path's first point and along the path."""
    return run.start if run.start is not None else beginning(run.selection.build_trajectory())


def beginning(path: Path) -> Pose:
    """The path's first point (m), and the heading along it there (rad)."""
    x, y = path.point(0.0)
    ahead = path.point(1e-3 * path.duration)
    return Pose(x, y, math.atan2(ahead[1] - y, ahead[0] - x))


def _walk(run: PlannedRun, bench: Bench, rig: BatchRig) -> Walk:
    request = RunRequest(run.selection, run.passes, run.duration)
    walk = Walk("", request, rig.length, bench.field.pivot, bench.pose)
    walk.workspace = rig.workspace
    walk.gait_model = GaitModel(rig.length, switch_time=rig.ramp)
    return walk


def _carry_out(walk: Walk, bench: Bench, rig: BatchRig, watch: Watch | None) -> None:
    tick, period = 0, 1.0 / rig.rate
    while True:
        now = rig.rest + tick * period
        stride = walk.step(now, period, bench.pose, bench.field, bench.lead)
        bench.obey(stride)
        if watch is not None:
            watch(Step(walk.elapsed, bench.pose, walk.reference, stride.pivot, bench.field.heading))
        if walk.is_over:
            return
        tick += 1
        bench.advance(rig.rest + tick * period)
        check_inside_edge(bench.pose.x, bench.pose.y, walk.elapsed, rig.edge)


def check_inside_edge(x: float, y: float, elapsed: float, edge: float) -> None:
    """A rig holds a robot that would leave the plate; raises `RunFailed`."""
    if not (abs(x) <= edge and abs(y) <= edge):
        raise RunFailed(
            f"the robot left the workspace after {elapsed:.1f} s, at ({1e3 * x:.1f}, {1e3 * y:.1f}) mm; "
            f"±{1e3 * edge:g} mm are allowed"
        )
