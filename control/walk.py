"""One run on the rig while it lasts: its walker, its reference clock and its figures."""

from __future__ import annotations

from control.field_model import FieldModel
from control.gait import Gait
from control.metrics import Metrics, MetricsTally
from control.model import Pivot, Pose
from control.perception import Perception
from control.runs import RunRequest, Selection
from control.snapshot import RunProgress
from control.walker import Moment, Stride, Walker


class Walk:
    """The reference clock stands still while the rig is held and while the field comes up."""

    def __init__(self, id: str, request: RunRequest, length: float, pivot: Pivot, heading: float) -> None:
        """length: distance between the pivots, m.  pivot, heading: what the robot stands on and its heading."""
        selection = request.selection
        self.id = id
        self.request = request
        self.trajectory = selection.build_trajectory()
        self.walker = Walker(selection.build_controller(), selection.gait, length, pivot, heading)
        self.elapsed = 0.0
        self.reference_time = 0.0
        self.tally = MetricsTally(length)

    @property
    def gait(self) -> Gait:
        return self.walker.gait

    @property
    def reference(self) -> tuple[float, float]:
        """The desired point now, m."""
        return self.trajectory.point(self.reference_time)

    @property
    def passes_done(self) -> float:
        return self.reference_time / self.trajectory.duration

    @property
    def is_over(self) -> bool:
        cap = self.request.duration
        return self.passes_done >= self.request.passes or (cap is not None and self.elapsed >= cap)

    @property
    def duration(self) -> float:
        """How long the run will have taken, s."""
        whole = self.request.passes * self.trajectory.duration / self.gait.reference_speed
        return whole if self.request.duration is None else min(whole, self.request.duration)

    def change(self, selection: Selection) -> None:
        """Go on with another choice; a new path starts at its beginning."""
        if selection.trajectory != self.request.selection.trajectory:
            self.trajectory = selection.build_trajectory()
            self.reference_time = 0.0
        self.walker.change(selection.build_controller(), selection.gait)

    def step(
        self, now: float, elapsed: float, pose: Pose, field: FieldModel, perception: Perception
    ) -> Stride:
        """One tick of `elapsed` seconds."""
        if not field.is_ready:
            return Stride(self.walker.sweep.pivot, 0.0, field.heading)
        self.elapsed += elapsed
        self.reference_time += elapsed * self.gait.reference_speed
        reference = self.reference
        self.tally.add(pose, pose.distance_to(*reference))
        moment = Moment(
            now=now,
            pose=pose,
            reference=reference,
            reference_time=self.reference_time,
            trajectory=self.trajectory,
            field_settled=field.is_settled,
            lead=perception.backlash.lead,
        )
        return self.walker.step(moment)

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
