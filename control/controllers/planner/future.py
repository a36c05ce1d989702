"""What the path asks for in the slots to come, and the cost of every move against it, prepared for the search.

The cost of a move is the squared distance at the end of each of its slots, summed. With P + u E_i against the
reference R_i that is

    n |P|^2 - 2 Re[P sum conj(R_i)] + 2 Re[conj(u) (P sum conj(E_i) - sum conj(E_i) R_i)] + sum |E_i|^2 + |R_i|^2,

linear in a handful of features of the node (P, u), so one small matrix per slot gives the costs of all moves of all
nodes. The heading's cost, w sum |u e^(i turned_i) - h_i|^2 for wanted headings h_i, is of the same kind. Slots
beyond the horizon do not count.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from control.controllers.planner.moves import LONGEST, Complex, Float, Moves

FEATURES = 15
"""Five of the place for moves on the same pivot, five for moves on the other, the facing's four, and one."""


@dataclass(frozen=True, slots=True)
class Ahead:
    """points: the desired points at the end of each slot, (slots + LONGEST - 1,) complex, m.

    headings: the wanted headings as e^(i theta), or None where the heading is free.  weight: of the heading, m^2.
    """

    points: Complex
    headings: Complex | None = None
    weight: float = 0.0


class Horizon:
    """What does not depend on the path. First index: the slot in which a move begins, then the move."""

    def __init__(self, moves: Moves, slots: int) -> None:
        self.moves = moves
        self.slots = slots
        starts = np.arange(slots)[:, None]
        self.counts: Float = (starts + np.arange(1, LONGEST + 1) <= slots).astype(float)
        self.within = moves.within.T.copy()
        self.arcs: Complex = moves.arcs.conj().T.copy()
        self.spins: Complex = (np.exp(-1j * moves.turned) * moves.within).astype(complex).T.copy()
        self.relations = np.where(moves.switches, 0.0, 1.0), np.where(moves.switches, 1.0, 0.0)
        self._template = self._without_path()

    def _without_path(self) -> Float:
        slot = self.moves.settings.slot
        lengths = slot * (self.counts @ self.within)
        arcs = 2.0 * slot * (self.counts @ self.arcs)
        table = np.zeros((self.slots, FEATURES, len(self.moves.all)))
        for first, mask in zip((0, 5), self.relations, strict=True):
            table[:, first] = lengths * mask
            table[:, first + 3] = arcs.real * mask
            table[:, first + 4] = -arcs.imag * mask
        table[:, 14] = slot * (self.counts @ np.square(np.abs(self.arcs))) + self.moves.price
        return table

    def costs(self, ahead: Ahead) -> Float:
        """(slots, FEATURES, moves): times a node's features, the cost of each move, m^2 s."""
        slot, table = self.moves.settings.slot, self._template.copy()
        points = _windows(ahead.points, self.slots) * self.counts
        sums = -2.0 * slot * (points @ self.within)
        for first, mask in zip((0, 5), self.relations, strict=True):
            table[:, first + 1] = sums.real * mask
            table[:, first + 2] = sums.imag * mask
        cross = 2.0 * slot * (points @ self.arcs)
        table[:, 10], table[:, 11] = -cross.real, cross.imag
        table[:, 14] += slot * (np.square(np.abs(points)) @ self.within)
        if ahead.headings is not None:
            self._add_heading(table, ahead.headings, 2.0 * slot * ahead.weight)
        return table

    def _add_heading(self, table: Float, headings: Complex, weight: float) -> None:
        wanted = weight * ((_windows(headings, self.slots) * self.counts) @ self.spins)
        table[:, 12], table[:, 13] = -wanted.real, -wanted.imag
        table[:, 14] += weight * (self.counts @ self.within)


def features(place: Complex, slid: Complex, facing: Complex, pivot: Float) -> Float:
    """(..., FEATURES) of nodes. slid: where the centre comes to when the robot switches pivots, m."""
    back = (pivot * facing).conj()
    values = np.empty((*place.shape, FEATURES))
    for first, at in ((0, place), (5, slid)):
        turned = back * at
        values[..., first + 1], values[..., first + 2] = at.real, at.imag
        values[..., first + 3], values[..., first + 4] = turned.real, turned.imag
        values[..., first] = np.square(at.real) + np.square(at.imag)
    values[..., 10], values[..., 11] = back.real, back.imag
    values[..., 12], values[..., 13] = facing.real, facing.imag
    values[..., 14] = 1.0
    return values


def _windows(values: Complex, slots: int) -> Complex:
    """(slots, LONGEST): in row j the values of the slots that follow slot j."""
    return np.lib.stride_tricks.sliding_window_view(values, LONGEST)[:slots]
