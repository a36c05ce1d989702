"""Straight pieces and circular arcs, chained to paths that are known by the length walked along them."""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from control.model import wrap

Point = tuple[float, float]

NEGLIGIBLE = 1e-9
"""A piece shorter than this, m, is left out: rounding of a corner that takes up a whole side."""


class Piece(Protocol):
    @property
    def length(self) -> float: ...

    def at(self, distance: float) -> Point:
        """The point after `distance` (m) along the piece."""
        ...


@dataclass(frozen=True, slots=True)
class Straight:
    """From one point to another, m."""

    start: Point
    end: Point

    @property
    def length(self) -> float:
        return math.dist(self.start, self.end)

    def at(self, distance: float) -> Point:
        return towards(self.start, self.end, distance)


@dataclass(frozen=True, slots=True)
class Arc:
    """Part of a circle. centre, radius: m.  start: angle at which it begins, rad.  turn: rad, signed."""

    centre: Point
    radius: float
    start: float
    turn: float

    @property
    def length(self) -> float:
        return self.radius * abs(self.turn)

    def at(self, distance: float) -> Point:
        angle = self.start + math.copysign(distance / self.radius, self.turn)
        x, y = self.centre
        return x + self.radius * math.cos(angle), y + self.radius * math.sin(angle)


class Chain:
    """Pieces one after the other; where each begins is where the one before ends."""

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self.pieces = [piece for piece in pieces if piece.length > NEGLIGIBLE]
        ends = itertools.accumulate(piece.length for piece in self.pieces)
        self._starts = [0.0, *ends]
        self.length = self._starts.pop()

    def at(self, distance: float) -> Point:
        """The point after `distance` (m, 0 to the whole length) along the chain."""
        index = max(0, bisect.bisect_right(self._starts, distance) - 1)
        return self.pieces[index].at(distance - self._starts[index])


def rounded(corners: Sequence[Point], radius: float, *, closed: bool) -> Chain:
    """The polyline through the corners (m) with each corner replaced by an arc of `radius` (m) at most.

    A corner gets a smaller radius where the arc would use up more than half of one of its sides.
    A closed chain starts in the middle of its first side.
    """
    if closed:
        middle = _middle(corners[0], corners[1])
        corners = [middle, *corners[1:], corners[0], middle]
    pieces: list[Piece] = []
    here = corners[0]
    for number in range(1, len(corners) - 1):
        reach = _reach(corners, number)
        arc = _fillet(corners[number - 1], corners[number], corners[number + 1], radius, reach)
        pieces += [Straight(here, arc.at(0.0)), arc] if arc else [Straight(here, corners[number])]
        here = arc.at(arc.length) if arc else corners[number]
    pieces.append(Straight(here, corners[-1]))
    return Chain(pieces)


def _middle(one: Point, other: Point) -> Point:
    return 0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])


def _reach(corners: Sequence[Point], number: int) -> float:
    """How much of the sides beside a corner its arc may use, m: all of a first or last one, half of others."""
    before, after = (math.dist(corners[number], corners[number + side]) for side in (-1, 1))
    return min(
        before if number == 1 else 0.5 * before,
        after if number == len(corners) - 2 else 0.5 * after,
    )


def _fillet(before: Point, corner: Point, after: Point, radius: float, reach: float) -> Arc | None:
    """The arc that joins the two sides of a corner tangentially; None where the sides are in line."""
    inbound = math.atan2(corner[1] - before[1], corner[0] - before[0])
    turn = wrap(math.atan2(after[1] - corner[1], after[0] - corner[0]) - inbound)
    tangent = abs(math.tan(0.5 * turn))
    radius = min(radius, reach / tangent) if tangent > NEGLIGIBLE else 0.0
    if radius <= NEGLIGIBLE or abs(turn) >= math.pi - NEGLIGIBLE:
        return None
    start = towards(corner, before, radius * tangent)
    side = math.copysign(0.5 * math.pi, turn)
    centre = start[0] + radius * math.cos(inbound + side), start[1] + radius * math.sin(inbound + side)
    return Arc(centre, radius, inbound - side, turn)


def towards(start: Point, end: Point, distance: float) -> Point:
    """The point `distance` (m) from the start on the way to the end."""
    share = distance / math.dist(start, end)
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])
