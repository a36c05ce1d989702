"""One run in plain Python: the rig's own walk, tick by tick, without camera, line and currents."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from control.gait_model import GaitModel
from control.metrics import Metrics
from control.model import Pivot, Pose
from control.runs import RunRequest
from control.simulation.plants import build_plant
from control.studies.batch.bench import OVERSHOOT, REST, TICK, Bench
from control.studies.batch.outcome import RunFailed
from control.studies.start import along
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


def plain_walk(run: PlannedRun, watch: Watch | None = None) -> Metrics:
    """The figures of one run; raises `RunFailed` where a rig would have ended it, and what a bad choice raises."""
    plant = build_plant(run.plant, run.setup.length, start_of(run), run.seed)
    bench = Bench(plant, run.selection.gait, run.setup.ramp)
    bench.advance(REST)
    walk = _walk(run, bench)
    try:
        _carry_out(walk, bench, run.setup.workspace, watch)
    except ControllerFault as fault:
        raise RunFailed(str(fault)) from fault
    return walk.metrics()


def start_of(run: PlannedRun) -> Pose:
    """Where the robot begins: as planned, else at the path's first point and along the path."""
    if run.start is not None:
        return run.start
    path = run.selection.build_trajectory()
    return Pose(*path.point(0.0), along(path))


def _walk(run: PlannedRun, bench: Bench) -> Walk:
    request = RunRequest(run.selection, run.passes, run.duration)
    walk = Walk("", request, run.setup.length, bench.field.pivot, bench.pose)
    walk.workspace = run.setup.workspace
    walk.gait_model = GaitModel(run.setup.length, switch_time=run.setup.ramp)
    return walk


def _carry_out(walk: Walk, bench: Bench, workspace: float, watch: Watch | None) -> None:
    for tick in itertools.count():
        if tick:
            bench.advance(REST + tick * TICK)
            require_inside(bench.pose.x, bench.pose.y, tick, workspace)
        stride = walk.step(bench.now, TICK, bench.pose, bench.field, bench.lead)
        bench.obey(stride)
        if watch is not None:
            watch(Step(walk.elapsed, bench.pose, walk.reference, stride.pivot, bench.field.heading))
        if walk.is_over:
            return


def require_inside(x: float, y: float, tick: int, workspace: float) -> None:
    """A rig holds a robot that would leave the plate; raises `RunFailed`. x, y, workspace (half its side): m."""
    edge = workspace + OVERSHOOT
    if not (abs(x) <= edge and abs(y) <= edge):
        raise RunFailed(
            f"the robot left the workspace after {tick * TICK:.1f} s, at ({1e3 * x:.1f}, {1e3 * y:.1f}) mm; "
            f"±{1e3 * workspace:g} mm are allowed"
        )
