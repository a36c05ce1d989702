"""Beam search over moves in time slots.

A node is a robot at the end of a slot. Nodes of the same slot are compared by the cost so far, which is fair
because they have spent the same time; moves of every duration lead from a slot to later ones. Two nodes in the
same place, heading and pivot differ only in cost, so only the cheaper one is kept: that makes the timing of a
given sequence of sweeps an exact dynamic program on the slots.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from control.controllers.planner.future import Ahead, Horizon, features
from control.controllers.planner.moves import BLOCK, LONGEST, Complex, Float, Move, Moves
from control.controllers.planner.slip import SwitchSlip

FORBIDDEN = 1e9
"""Cost of what cannot be, m^2 s: more than any real one."""
POSSIBLE = 0.5 * FORBIDDEN
SAME_STATE = 2e6
"""States that round to the same half micrometre, 1/m, are one."""


@dataclass(frozen=True, slots=True)
class Root:
    """The robot now. place: its centre, m.  facing: e^(i heading).  pivot: the one in use, +1 or -1.

    turned: since that pivot was taken, rad.  edge: largest |x| and |y| that it may reach, m.
    """

    place: complex
    facing: complex
    pivot: float
    turned: float
    edge: float


@dataclass(frozen=True, slots=True)
class Plan:
    """first: the move to make now.  cost: of the whole plan, m^2 s."""

    first: Move
    cost: float


class Search:
    """One search per plan; its tables are made once per gait."""

    def __init__(self, moves: Moves, slots: int, width: int) -> None:
        """slots: the horizon.  width: nodes kept per slot."""
        self.slots = slots - slots % BLOCK
        self._moves = moves
        self._width = width
        self._horizon = Horizon(moves, self.slots)
        count = len(moves.all)
        self._move = np.repeat(np.arange(count), width)
        self._parent = np.tile(np.arange(width), count)
        rows = self.slots + LONGEST + 1
        self._place, self._slid, self._facing = np.zeros((3, rows, width), complex)
        self._turned, self._cost = np.zeros((2, rows, width))
        self._pivot = np.ones((rows, width))
        self._first = np.zeros((rows, width), np.int64)
        self._bids = np.zeros((rows, count, width))

    def best(self, root: Root, ahead: Ahead, slip: SwitchSlip) -> Plan | None:
        """The cheapest plan over the horizon; None when every plan leads over the edge."""
        costs = self._horizon.costs(ahead)
        self._bids.fill(FORBIDDEN)
        self._start(root, slip)
        self._expand(slice(0, 1), costs)
        for slot in range(BLOCK, self.slots, BLOCK):
            rows = slice(slot, slot + BLOCK)
            self._settle(rows, slip, root.edge)
            self._expand(rows, costs)
        return self._cheapest()

    def _start(self, root: Root, slip: SwitchSlip) -> None:
        self._place[0] = root.place
        self._facing[0] = root.facing
        self._pivot[0] = root.pivot
        self._turned[0] = root.turned
        self._slid[0] = root.place + slip.at(self._facing[0], self._pivot[0], self._turned[0])
        self._cost[0] = FORBIDDEN
        self._cost[0, 0] = 0.0

    def _settle(self, rows: slice, slip: SwitchSlip, edge: float) -> None:
        """Choose the nodes of these slots among the bids for them, and place them."""
        bids = self._bids[rows].reshape(BLOCK, -1)
        chosen = np.argpartition(bids, self._width - 1, axis=1)[:, : self._width]
        cost = np.take_along_axis(bids, chosen, axis=1)
        move = self._move[chosen]
        slots = np.arange(rows.start, rows.stop)[:, None] - self._moves.durations[move]
        source = slots.clip(min=0) * self._width + self._parent[chosen]
        switches = self._moves.switches[move]
        facing, pivot = self._facing.ravel()[source], self._pivot.ravel()[source]
        place = np.where(switches, self._slid.ravel()[source], self._place.ravel()[source])
        turned = np.where(switches, 0.0, self._turned.ravel()[source]) + self._moves.turns[move]
        self._place[rows] = place = place + pivot * facing * self._moves.ends[move]
        self._facing[rows] = facing = facing * self._moves.spins[move]
        self._pivot[rows] = pivot = np.where(switches, -pivot, pivot)
        self._turned[rows] = turned
        self._slid[rows] = place + slip.at(facing, pivot, turned)
        self._first[rows] = np.where(slots == 0, move, self._first.ravel()[source])
        cost[np.maximum(np.abs(place.real), np.abs(place.imag)) > edge] = FORBIDDEN
        _forbid_doubles(cost, place + self._moves.settings.length * (3.7 * facing + 17.1 * pivot))
        self._cost[rows] = cost

    def _expand(self, rows: slice, costs: Float) -> None:
        """Bid for later slots with every move from the nodes of these."""
        nodes = features(self._place[rows], self._slid[rows], self._facing[rows], self._pivot[rows])
        total = nodes @ costs[rows] + self._cost[rows][..., None]
        moves = np.arange(len(self._moves.all))
        for offset in range(rows.stop - rows.start):
            self._bids[rows.start + offset + self._moves.durations, moves] = total[offset].T

    def _cheapest(self) -> Plan | None:
        final = self._bids[self.slots :].reshape(LONGEST + 1, -1)
        row, bid = divmod(int(np.argmin(final)), final.shape[1])
        cost = float(final[row, bid])
        if cost > POSSIBLE:
            return None
        last = int(self._move[bid])
        source = self.slots + row - int(self._moves.durations[last])
        first = last if source == 0 else int(self._first[source, self._parent[bid]])
        return Plan(self._moves.all[first], cost)


def _forbid_doubles(cost: Float, state: Complex) -> None:
    """Forbid, in each row, all but the cheapest of the nodes that are in the same state."""
    mark = np.round((state.real + 0.7366 * state.imag) * SAME_STATE)
    order = np.lexsort((cost, mark), axis=1)
    in_order = np.take_along_axis(mark, order, axis=1)
    is_double = np.zeros(cost.shape, bool)
    np.put_along_axis(is_double, order[:, 1:], in_order[:, 1:] == in_order[:, :-1], axis=1)
    cost[is_double] = FORBIDDEN
