"""The planner: walking is a chain of discrete arcs, so it is planned as one.

At each completed sweep the cheapest chain of sweeps over the horizon is searched (`search`) and its first sweep
taken; while that lasts, the rate is corrected so that it ends when the plan says.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from control.controllers.controller import Decision, Situation, controllers
from control.controllers.heading import WantedHeading
from control.controllers.planner.future import Ahead
from control.controllers.planner.moves import LONGEST, Moves, MoveSettings, slot_for
from control.controllers.planner.parameters import PlannerParameters
from control.controllers.planner.search import Root, Search
from control.controllers.planner.slip import Sighting, SlipWatch, SwitchSlip
from control.gait import Gait, advance_of_sweep
from control.gait_model import GaitModel
from control.model import Pivot, Pose, opposite
from control.trajectories.trajectory import Path

MM2 = 1e-6
EARLY_SHARES = (0.25, 0.5, 0.75, 1.0)
"""Where a sweep may end when it may end early, in sweeps."""
SLOWEST = 0.5
"""A sweep that is early goes on at no less than this share of its planned rate."""
WHOLE = (1.0,)
PACE_SAMPLES = 48
"""The path's speed is the mean over so many places of a pass."""
PACE_STEP = 0.05
"""Time over which it is measured there, s."""
ROUNDING = 1e-6
"""A robot at the edge of the workspace may stay there, m."""


@dataclass(frozen=True, slots=True)
class Leg:
    """The sweep under way. turn: rad, signed.  rate: planned, rad/s.  end: s.

    departure: where it began.  left: the pivot that was left for it, None when it stayed the same.
    """

    turn: float
    rate: float
    end: float
    departure: Pose
    left: Pivot | None


@controllers.register
class Planner:
    """Searches chains of sweeps over a receding horizon and walks the first sweep of the best."""

    name = "planner"
    title = "Planner"
    summary = "Plans the next sweeps with the exact arcs and the path's future; the smallest error."
    Parameters = PlannerParameters

    def __init__(self, parameters: PlannerParameters) -> None:
        self._parameters = parameters
        self._wanted = WantedHeading(parameters)
        self._gait: Gait | None = None
        self._path: Path | None = None
        self._leg: Leg | None = None
        self._turned = 0.0
        self._watch = SlipWatch(SwitchSlip())

    def step(self, situation: Situation) -> Decision:
        if situation.trajectory is not self._path:
            self._leg = None  # it ends by the clock of the path before
        if situation.gait != self._gait or situation.trajectory is not self._path:
            self._prepare(situation)
        if situation.may_switch:
            self._arrive(situation.pose)
            return self._plan(situation)
        leg = self._leg or self._take_over(situation)
        return Decision(situation.pivot, self._rate(leg, situation), abs(leg.turn))

    def _prepare(self, situation: Situation) -> None:
        """Tables for a gait or a path that is new: the path's pace says how long a slot is."""
        parameters, gait, model = self._parameters, situation.gait, situation.slip
        known = model or GaitModel(situation.length)
        shares = EARLY_SHARES if parameters.early_end else WHOLE
        settings = MoveSettings(
            length=known.length,
            max_rate=gait.max_rate,
            slot=_slot(situation, shares[(len(shares) - 1) // 2] * gait.sweep, known),
            switch_time=known.switch_time,
            turns=tuple(share * gait.sweep for share in shares),
            switch_cost=parameters.switch_weight * MM2,
            sweep_cost=parameters.sweep_weight * MM2,
            effort=parameters.effort_weight * MM2,
        )
        self._moves = Moves(settings)
        self._search = Search(self._moves, parameters.horizon_slots, parameters.beam_width)
        if self._gait is None:
            self._watch = SlipWatch(SwitchSlip(known.out, known.forward_base, known.forward_per_sweep))
        self._gait, self._path = gait, situation.trajectory

    def _arrive(self, pose: Pose) -> None:
        """A sweep has ended at `pose`: learn from it."""
        leg, self._leg = self._leg, None
        if leg is None:
            return
        turn = pose.heading - leg.departure.heading
        if leg.left is None:
            self._turned += turn
            return
        if self._parameters.learn_slip:
            sighting = Sighting(leg.departure, leg.left, self._turned, pose)
            self._watch.see(sighting, self._moves.settings.length)
        self._turned = turn

    def _plan(self, situation: Situation) -> Decision:
        pose, now = situation.pose, situation.reference_time
        plan = self._search.best(self._root(situation), self._ahead(situation), self._watch.slip)
        if plan is None or not plan.first.turn:
            return Decision(situation.pivot, 0.0)
        move = plan.first
        pivot = opposite(situation.pivot) if move.switches else situation.pivot
        rate = self._moves.rate(move)
        end = now + self._moves.settings.slot * move.duration
        left = situation.pivot if move.switches else None
        self._leg = Leg(move.turn, rate, end, pose, left)
        return Decision(pivot, rate, abs(move.turn))

    def _take_over(self, situation: Situation) -> Leg:
        """Complete a sweep that another controller has begun, the way it goes."""
        gait, pose, turned = situation.gait, situation.pose, situation.turned
        turn = math.copysign(gait.sweep, turned or situation.pivot)
        left = max(0.0, gait.sweep - abs(turned))
        rate = SLOWEST * gait.max_rate
        self._turned = turned
        self._leg = Leg(turn, rate, situation.reference_time + left / rate, pose, None)
        return self._leg

    def _root(self, situation: Situation) -> Root:
        pose = situation.pose
        edge = math.inf if situation.workspace is None else situation.workspace
        return Root(
            place=complex(pose.x, pose.y),
            facing=cmath.exp(1j * pose.heading),
            pivot=float(situation.pivot),
            turned=self._turned,
            edge=max(edge, abs(pose.x), abs(pose.y)) + ROUNDING,
        )

    def _ahead(self, situation: Situation) -> Ahead:
        slot = self._moves.settings.slot
        times = [slot * index for index in range(1, self._search.slots + LONGEST)]
        points = np.array([complex(*situation.desired(time)) for time in times])
        weight = self._parameters.effective_heading_weight
        if not weight:
            return Ahead(points)
        headings = np.exp(1j * np.array([self._wanted.at(situation, time) for time in times]))
        return Ahead(points, headings, weight * situation.length**2)

    @staticmethod
    def _rate(leg: Leg, situation: Situation) -> float:
        """What completes the sweep when the plan says, rad/s."""
        left = abs(leg.turn) - math.copysign(1.0, leg.turn) * situation.turned
        time = leg.end - situation.reference_time
        wanted = left / time if time > 0.0 else math.inf
        fastest = situation.gait.max_rate
        return math.copysign(min(max(wanted, SLOWEST * abs(leg.rate)), fastest), leg.turn)


def _slot(situation: Situation, typical: float, model: GaitModel) -> float:
    """Slot, s. typical: a sweep that is made often, rad."""
    gait = situation.gait
    return slot_for(typical, gait.max_rate, model.switch_time, _sweep_time(situation, typical))


def _sweep_time(situation: Situation, turn: float) -> float:
    """How long a sweep may take that keeps up with the path, s; 0, as little as can be, where it stands still."""
    path = situation.trajectory
    starts = (path.duration * index / PACE_SAMPLES for index in range(PACE_SAMPLES))
    way = sum(math.dist(path.point(start), path.point(start + PACE_STEP)) for start in starts)
    pace = way / (PACE_SAMPLES * PACE_STEP)
    return advance_of_sweep(min(turn, math.pi), situation.length) / pace if pace > 0.0 else 0.0
