"""The moves that the search may make: sweeps of either pivot and direction at several paces, and waiting.

Time runs in slots and the plane is complex: a robot with its centre at P (m) and heading u = e^(i theta) that turns
by phi about the pivot sigma comes to P + u E with E = i sigma (L/2) (1 - e^(i phi)), the exact arc (paper, eq. 1).
E belongs to the move alone, so a table of it serves every robot; relative to the pivot in use, sigma is +1 for a
move on the same pivot and -1 for one on the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]
Float = NDArray[np.float64]
Int = NDArray[np.int64]
Bool = NDArray[np.bool_]

DURATIONS = (2, 3, 4, 5, 6, 7, 8, 10)
"""Paces: slots that a sweep may take."""
LONGEST = DURATIONS[-1]
BLOCK = DURATIONS[0]
"""No move is shorter, so this many slots can be searched at once."""
SLOTS_OF_A_SWEEP = 8.0
"""A sweep that keeps up with the path takes about this many slots."""
COARSEST = 2.0
"""The slot is at most this many times the one that the fastest sweep needs."""
ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class MoveSettings:
    """length: between the pivots, m.  max_rate: rad/s.  slot: s.  switch_time: the robot stands still at a switch, s.

    turns: sizes of the sweeps that may be made, rad.  switch_cost, sweep_cost: m^2 s each; effort: m^2 s per radian.
    """

    length: float
    max_rate: float
    slot: float
    switch_time: float
    turns: tuple[float, ...]
    switch_cost: float
    sweep_cost: float
    effort: float


@dataclass(frozen=True, slots=True)
class Move:
    """switches: to the other pivot.  turn: rad, signed; 0 is to wait.  duration: slots."""

    switches: bool
    turn: float
    duration: int


class Moves:
    """All moves that one gait allows, and tables over them; first index: the move.

    turned: at the end of each slot since its beginning, rad, (moves, LONGEST); 0 after the move.
    arcs: E there, m.  within: 1 in the slots of the move, else 0.
    ends, spins: E and e^(i turn) at its end.  price: beside the distance, m^2 s.
    """

    def __init__(self, settings: MoveSettings) -> None:
        self.settings = settings
        self.all: tuple[Move, ...] = tuple(_moves(settings))
        self.switches: Bool = np.array([move.switches for move in self.all])
        self.turns: Float = np.array([move.turn for move in self.all])
        self.durations: Int = np.array([move.duration for move in self.all])
        slots = np.arange(1, LONGEST + 1)
        self.within: Float = (slots <= self.durations[:, None]).astype(float)
        self.turned: Float = self.turns[:, None] * self._share(slots) * self.within
        arm = 0.5j * settings.length * np.where(self.switches, -1.0, 1.0)
        self.arcs: Complex = arm[:, None] * (1.0 - np.exp(1j * self.turned))
        self.spins: Complex = np.exp(1j * self.turns)
        self.ends: Complex = arm * (1.0 - self.spins)
        self.price: Float = np.array([_price(move, settings) for move in self.all])

    def _share(self, slots: Int) -> Float:
        """Share of each move's turn that is done at the end of each slot, (moves, LONGEST)."""
        rest = self.settings.switch_time * self.switches[:, None]
        moving = self.durations[:, None] * self.settings.slot - rest
        return np.clip((slots * self.settings.slot - rest) / moving, 0.0, 1.0)

    def rate(self, move: Move) -> float:
        """The rate that makes the move in its time, rad/s."""
        return move.turn / _moving_time(move.switches, move.duration, self.settings)


def rest_before(switches: bool, settings: MoveSettings) -> float:
    """How long the robot stands still before the sweep begins, s."""
    return settings.switch_time if switches else 0.0


def _moving_time(switches: bool, duration: int, settings: MoveSettings) -> float:
    return duration * settings.slot - rest_before(switches, settings)


def _moves(settings: MoveSettings) -> list[Move]:
    moves = [Move(False, 0.0, DURATIONS[0])]
    for switches in (False, True):
        for duration in DURATIONS:
            reach = settings.max_rate * _moving_time(switches, duration, settings) * (1.0 + ROUNDING)
            sizes = [turn for turn in settings.turns if turn <= reach]
            moves += [Move(switches, turn, duration) for size in sizes for turn in (size, -size)]
    return moves


def _price(move: Move, settings: MoveSettings) -> float:
    if not move.turn:
        return 0.0
    switch = settings.switch_cost if move.switches else 0.0
    return switch + settings.sweep_cost + settings.effort * abs(move.turn)


def slot_for(turn: float, max_rate: float, switch_time: float, sweep_time: float) -> float:
    """Slot, s: as fine as the paces allow. turn: of a typical sweep, rad.  sweep_time: what the path leaves it, s.

    The fastest sweep takes the shortest duration, with a switch at most twice that; on a slow path it takes longer.
    """
    fastest = turn / max_rate
    finest = max(fastest / BLOCK, (fastest + switch_time) / (2 * BLOCK))
    return max(finest, min(sweep_time / SLOTS_OF_A_SWEEP, COARSEST * finest))
