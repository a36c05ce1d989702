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
from control.trajectories.trajectory import Trajectory

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
        self, controller: Controller, trajectory: Trajectory, gait: Gait, start: Pose, length: float
    ) -> None:
        self.controller = controller
        self.trajectory = trajectory
        self.gait = gait
        self.length = length
        self.pose = start
        self.sweep = Sweep(gait.sweep, PIVOT_A, start.heading)
        self._may_switch = True

    def advance(self, time: float, tick: float) -> None:
        """Hold the reference of `time` for one tick of `tick` seconds."""
        left = tick
        while left > 1e-12:
            rate = self._decide(time)
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

    def _decide(self, time: float) -> float:
        reference_time = time * self.gait.reference_speed
        decision = self.controller.step(
            Situation(
                pose=self.pose,
                pivot=self.sweep.pivot,
                may_switch=self._may_switch,
                turned=self.sweep.turned(self.pose.heading),
                reference=self.trajectory.point(reference_time),
                trajectory=self.trajectory,
                reference_time=reference_time,
                gait=self.gait,
                length=self.length,
            )
        )
        if self._may_switch:
            self.sweep.choose(decision.pivot)
            self._may_switch = False
        rate = max(-self.gait.max_rate, min(self.gait.max_rate, decision.rate))
        self.sweep.turning(rate)
        return rate


def walk(walker: KinematicWalker, duration: float, tick: float = TICK) -> Walk:
    """Let it walk for `duration` seconds; the error of a tick is taken at its end."""
    poses = [walker.pose]
    tally = MetricsTally(walker.length)
    for index in range(round(duration / tick)):
        walker.advance(index * tick, tick)
        desired = walker.trajectory.point((index + 1) * tick * walker.gait.reference_speed)
        tally.add(walker.pose, walker.pose.distance_to(*desired))
        poses.append(walker.pose)
    return Walk(tuple(poses), tally.metrics(walker.sweep.counts, duration))
