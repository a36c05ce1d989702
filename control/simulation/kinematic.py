"""Walks in pure kinematics: no camera, no coils, the body does exactly what the controller says.

This is the paper's simulation (section 5). Sweeps end exactly where they should whatever the tick, because
the crossing is found inside the tick and the rest of the tick belongs to the next decision.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.controllers.controller import Controller, Situation
from control.gait import Gait, Sweep
from control.metrics import Metrics, MetricsTally
from control.model import PIVOT_A, Pose, swing
from control.trajectories.reference import Reference
from control.trajectories.trajectory import Path

TICK = 0.1
"""The paper's control tick, s."""


@dataclass(frozen=True, slots=True)
class Walk:
    """A finished walk: the pose after each tick (the start first) and its figures."""

    poses: tuple[Pose, ...]
    metrics: Metrics


class KinematicWalker:
    """One robot that obeys: `advance` takes it through one tick of the controller."""

    def __init__(
        self, controller: Controller, trajectory: Path, gait: Gait, start: Pose, length: float
    ) -> None:
        self.controller = controller
        self.gait = gait
        self.reference = Reference(trajectory, gait, start=(start.x, start.y) if gait.approach else None)
        self.length = length
        self.workspace: float | None = None
        self.pose = start
        self.sweep = Sweep(gait.sweep, PIVOT_A, start.heading)
        self.is_finished = False
        self._may_switch = True

    def advance(self, time: float, tick: float) -> None:
        """Hold the reference of `time` for one tick of `tick` seconds.

        A sweep that ends inside the tick brings a decision there; one that looks ahead knows the time inside it.
        """
        self.reference.advance_to(time, self.pose)
        left = tick
        while left > 1e-12:
            rate = self._decide(tick - left)
            if rate == 0.0:
                return
            angle = math.copysign(min(abs(rate) * left, self._remaining(rate)), rate)
            completes = abs(angle) >= self._remaining(rate) - 1e-12
            self.pose = swing(self.pose, self.sweep.pivot, angle, self.length)
            left -= abs(angle / rate)
            if completes:
                self.sweep.complete(self.pose.heading)
                self._may_switch = True

    def _remaining(self, rate: float) -> float:
        return self.sweep.remaining(self.pose.heading, rate)

    def _decide(self, inside: float) -> float:
        decision = self.controller.step(
            Situation(
                pose=self.pose,
                pivot=self.sweep.pivot,
                may_switch=self._may_switch,
                turned=self.sweep.turned(self.pose.heading),
                reference=self.reference.point,
                trajectory=self.reference.trajectory,
                reference_time=self.reference.time + inside,
                gait=self.gait,
                length=self.length,
                workspace=self.workspace,
            )
        )
        self.is_finished = decision.finished
        if self._may_switch:
            self.sweep.choose(decision.pivot)
            self._may_switch = decision.rate == 0.0
        self.sweep.angle = self.gait.sweep if decision.sweep is None else decision.sweep
        rate = max(-self.gait.max_rate, min(self.gait.max_rate, decision.rate))
        self.sweep.turning(rate)
        return rate


def walk(walker: KinematicWalker, duration: float, tick: float = TICK) -> Walk:
    """Let it walk for `duration` seconds; the error of a tick on the path is taken at its end."""
    poses = [walker.pose]
    tally = MetricsTally(walker.length)
    for index in range(round(duration / tick)):
        walker.advance(index * tick, tick)
        walker.reference.advance_to((index + 1) * tick, walker.pose)
        if not walker.reference.is_approaching:
            tally.add(walker.pose, walker.pose.distance_to(*walker.reference.point))
        poses.append(walker.pose)
    return Walk(tuple(poses), tally.metrics(walker.sweep.counts, duration))
