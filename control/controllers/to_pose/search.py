"""The chain of sweeps that leads nearest to a wanted pose: a beam search over pivots and angles, pure.

Complex numbers as in `control.controllers.planner.moves`: a robot at P (m) that faces u turns by a about the pivot
sigma and comes to P + u E with E = i sigma (L/2) (1 - e^(i a)); leaving a pivot it slips first.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from control.controllers.planner.moves import Complex, Float
from control.controllers.planner.slip import SwitchSlip
from control.controllers.to_pose.way import WayToGo

DEPTH = 5
"""Sweeps looked ahead: one more than a displacement sideways takes."""
WIDTH = 256
"""Chains kept at each depth."""
FIXED_COST = 0.4
"""Of any sweep, as a share of the cost of the widest one: switching takes as long as turning by some 15 degrees."""
SWAY = 1e-3
"""A walk along the edge of the workspace sways over it by about this, m; half of the usual soft margin."""
OVER_THE_EDGE = 1e4
"""Cost of leading further out, in sweeps per metre: ten for each millimetre. Where every chain leads out, as from
beyond the edge, the one that leads back soonest is best; what must not be is the loop's to forbid."""


@dataclass(frozen=True, slots=True)
class Standing:
    """place: the centre, m.  facing: e^(i heading).  pivot: the one in use.  turned: since it was taken, rad.

    In the frame of the wanted pose.
    """

    place: complex
    facing: complex
    pivot: float
    turned: float


@dataclass(frozen=True, slots=True)
class Step:
    """switches: to the other pivot.  angle: rad, signed.  cost: of the whole chain, in sweeps."""

    switches: bool
    angle: float
    cost: float


@dataclass(frozen=True, slots=True)
class Bounds:
    """The square that the centre must keep to, seen from the wanted pose.

    origin: the wanted place, m, workspace frame.  turn: e^(i heading) there.  edge: half side, m.
    """

    origin: complex
    turn: complex
    edge: float

    def excess(self, place: Complex) -> Float:
        """What a chain through these places costs beside its sweeps."""
        there = self.origin + self.turn * place
        outside = np.maximum(np.abs(there.real), np.abs(there.imag)) - self.edge - SWAY
        return OVER_THE_EDGE * np.maximum(outside, 0.0)


@dataclass(frozen=True, slots=True)
class _Chains:
    """Columns: one chain each; `first` is its first move."""

    place: Complex
    facing: Complex
    pivot: Float
    turned: Float
    cost: Float
    first: np.ndarray


class ChainSearch:
    """For one robot: angles: the sizes of sweeps, rad, > 0."""

    def __init__(self, way: WayToGo, angles: tuple[float, ...]) -> None:
        self._way = way
        self._angles: Float = np.array([sign * angle for angle in angles for sign in (1.0, -1.0)])
        self._spins: Complex = np.exp(1j * self._angles)
        self._arcs: Complex = 0.5j * way.length * (1.0 - self._spins)
        self._costs: Float = FIXED_COST + (1.0 - FIXED_COST) * np.abs(self._angles) / way.sweep

    def best(self, standing: Standing, slip: SwitchSlip, bounds: Bounds) -> Step | None:
        """The first sweep of the cheapest chain; None where the robot is there."""
        if self._way.is_there(np.array([standing.place]), np.array([standing.facing]))[0]:
            return None
        chains = self._begun(standing, slip, bounds)
        best, first = math.inf, 0
        for depth in range(DEPTH):
            total = chains.cost + self._way.sweeps(chains.place, chains.facing)
            cheapest = int(np.argmin(total))
            if total[cheapest] < best:
                best, first = float(total[cheapest]), int(chains.first[cheapest])
            if depth + 1 < DEPTH:
                chains = self._continued(_kept(chains, total), slip, bounds)
        switches, move = divmod(first, len(self._angles))
        return Step(bool(switches), float(self._angles[move]), best)

    def _begun(self, standing: Standing, slip: SwitchSlip, bounds: Bounds) -> _Chains:
        """All first sweeps: those on the same pivot, and then those on the other one."""
        root = _Chains(
            np.array([standing.place]),
            np.array([standing.facing]),
            np.array([standing.pivot]),
            np.array([standing.turned]),
            np.zeros(1),
            np.zeros(1, np.int64),
        )
        same, other = self._swung(root, bounds), self._continued(root, slip, bounds)
        count = len(self._angles)
        return _Chains(
            np.concatenate([same.place, other.place]),
            np.concatenate([same.facing, other.facing]),
            np.concatenate([same.pivot, other.pivot]),
            np.concatenate([same.turned, other.turned]),
            np.concatenate([same.cost, other.cost]),
            np.arange(2 * count),
        )

    def _continued(self, chains: _Chains, slip: SwitchSlip, bounds: Bounds) -> _Chains:
        """Every chain with every sweep on its other pivot."""
        slid = chains.place + slip.at(chains.facing, chains.pivot, chains.turned)
        on_other = _Chains(
            slid, chains.facing, -chains.pivot, np.zeros_like(chains.turned), chains.cost, chains.first
        )
        return self._swung(on_other, bounds)

    def _swung(self, chains: _Chains, bounds: Bounds) -> _Chains:
        """Every chain with every sweep on the pivot that it stands on."""
        place = chains.place[:, None] + (chains.facing * chains.pivot)[:, None] * self._arcs
        cost = chains.cost[:, None] + self._costs + bounds.excess(place)
        count = len(self._angles)
        return _Chains(
            place.ravel(),
            (chains.facing[:, None] * self._spins).ravel(),
            np.repeat(chains.pivot, count),
            (chains.turned[:, None] + self._angles).ravel(),
            cost.ravel(),
            np.repeat(chains.first, count),
        )


def _kept(chains: _Chains, total: Float) -> _Chains:
    """The most promising ones."""
    if len(total) <= WIDTH:
        return chains
    kept = np.argpartition(total, WIDTH)[:WIDTH]
    return _Chains(
        chains.place[kept],
        chains.facing[kept],
        chains.pivot[kept],
        chains.turned[kept],
        chains.cost[kept],
        chains.first[kept],
    )
