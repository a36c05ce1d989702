"""One run on the rig while it lasts: its walker, its reference clock and its figures."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from control.controllers import Law
from control.field import Field
from control.gait import Gait
from control.gait_model import GaitModel
from control.metrics import Metrics, MetricsTally
from control.model import Pivot, Pose, distance
from control.runs import RunRequest, Selection
from control.snapshot import RunProgress
from control.trajectories import Trajectory
from control.trajectories.reference import Reference
from control.walker import Moment, Stride, Walker

Case = Callable[[Law], Law]
"""What a rig puts a controller into: itself, or on a simulated rig a fault point."""


def _bare(controller: Law) -> Law:
    return controller


class Walk:
    """The reference clock stands still while the rig is held and while the field comes up."""

    def __init__(self, id: str, request: RunRequest, length: float, pivot: Pivot, pose: Pose) -> None:
        """length: distance between the pivots, m.  pivot: what the robot stands on."""
        selection = request.selection
        self.id = id
        self.request = request
        self.trajectory = selection.build_trajectory()
        self.walker = Walker(selection.build_controller(), selection.gait, length, pivot, pose.heading)
        self.workspace: float | None = None
        self.gait_model: GaitModel | None = None
        self._case: Case = _bare
        self.elapsed = self._began = 0.0
        self.tally = MetricsTally(length)
        self._length = length
        self._pose = pose
        self._reference = self._reference_on(self.trajectory, selection.gait)

    @property
    def gait(self) -> Gait:
        return self.walker.gait

    @property
    def reference(self) -> tuple[float, float]:
        """The desired point now, m."""
        return self._reference.point

    @property
    def passes_done(self) -> float:
        return self._reference.passes_done

    @property
    def is_over(self) -> bool:
        cap = self.request.duration
        if self.walker.is_finished or (cap is not None and self.elapsed >= cap):
            return True
        return self._reference.is_over

    @property
    def duration(self) -> float:
        """How long the run will have taken, s."""
        whole = self._began + self._reference.duration
        return whole if self.request.duration is None else min(whole, self.request.duration)

    def put_controllers_into(self, case: Case) -> None:
        """Every controller of this walk answers through `case`."""
        self._case = case
        self.walker.controller = case(self.walker.controller)

    def change(self, selection: Selection) -> None:
        """Go on with another choice; a new path starts at its beginning, and so does another controller."""
        if selection.trajectory != self.request.selection.trajectory:
            self.trajectory = selection.build_trajectory()
            self._reference = self._reference_on(self.trajectory, selection.gait)
            self._began = self.elapsed
        else:
            self._reference.change(selection.gait)
        controller = self.walker.controller
        if selection.controller != self.request.selection.controller:
            controller = self._case(selection.build_controller())
        self.walker.change(controller, selection.gait)
        self.request = replace(self.request, selection=selection)

    def step(
        self, now: float, elapsed: float, pose: Pose, field: Field, lead: Callable[[float], float]
    ) -> Stride:
        """One tick of `elapsed` seconds. lead: of the field before the body, by direction, rad."""
        if not field.is_ready:
            return Stride(self.walker.sweep.pivot, 0.0, field.heading)
        self.elapsed += elapsed
        self._pose = pose
        self._reference.advance_to(self.elapsed - self._began, pose)
        reference = self._finite_reference()
        if not self._reference.is_approaching:
            self.tally.add(pose, distance(pose.x, pose.y, *reference))
        moment = Moment(
            now=now,
            pose=pose,
            reference=reference,
            reference_time=self._reference.time,
            trajectory=self._reference.trajectory,
            field_settled=field.is_settled,
            lead=lead,
            workspace=self.workspace,
            slip=self.gait_model or GaitModel(self._length, switch_time=field.ramp),
        )
        return self.walker.step(moment)

    def _finite_reference(self) -> tuple[float, float]:
        """The desired point now, m; raises ValueError where the path gives none."""
        x, y = self.reference
        if not (math.isfinite(x) and math.isfinite(y)):
            name = self.request.selection.trajectory.name
            raise ValueError(f"the path {name!r} leads to ({x}, {y}) m")
        return x, y

    def _reference_on(self, trajectory: Trajectory, gait: Gait) -> Reference:
        start = (self._pose.x, self._pose.y) if gait.approach else None
        return Reference(trajectory, gait, self.request.passes, start)

    def metrics(self) -> Metrics:
        return self.tally.metrics(self.walker.sweep.counts, self.elapsed)

    def progress(self, paused: bool) -> RunProgress:
        counts = self.walker.sweep.counts
        return RunProgress(
            id=self.id,
            elapsed=self.elapsed,
            duration=self.duration,
            passes=self.request.passes,
            passes_done=self.passes_done,
            paused=paused,
            mean_error=self.tally.mean_error,
            steps=counts.steps,
            sweeps=counts.sweeps,
            reversals=counts.reversals,
        )
