"""The simulated world: board -> coil currents -> field at the robot -> the robot's motion, in steps of 1 ms.

Single-threaded and without a clock of its own: whoever looks at it (the simulated camera) moves it on.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

from control.coils import CoilSet
from control.model import Body, Pose
from control.simulation.plants import Plant
from control.simulation.wiring import STRAIGHT, Wiring
from control.snapshot import ZERO, Vector

STEP = 1e-3
"""The board's tick and the world's step, s."""

LONGEST_ADVANCE = 1000
"""The board is asked for no more milliseconds at once than this, so that no request grows without bound."""


Listener = Callable[[Sequence[Vector]], None]
"""Takes the currents (A) of the pairs x, y, z at the end of each millisecond that has just gone by."""


class Board(Protocol):
    """The drive electronics with the coils' inductance and resistance: the twin, or another over a port."""

    def advance(self, milliseconds: int) -> Sequence[Vector]:
        """Run on; the three coil currents (A) at the end of each millisecond."""
        ...

    def set_condition(self, name: str, value: int, coil: int | None = None) -> None:
        """One of `control.simulation.conditions`."""
        ...

    def reset(self) -> None:
        """Boot anew."""
        ...

    def close(self) -> None: ...


class World:
    """All that is not the host: owns the board and the robot, knows where the coils truly stand.

    start_time: the world's time at the beginning, s.  wiring: which pair hangs on which bridge.
    """

    def __init__(
        self,
        board: Board,
        plant: Plant,
        coils: CoilSet,
        start_time: float = 0.0,
        wiring: Wiring = STRAIGHT,
    ):
        if not math.isfinite(start_time):
            raise ValueError(f"the world must start at a finite time in s, got {start_time}")
        self.board = board
        self.plant = plant
        self.coils = coils
        self.wiring = wiring
        self._start = start_time
        self._milliseconds = 0
        self._currents = ZERO
        self._visitors: list[Callable[[], None]] = []
        self._listeners: list[Listener] = []

    @property
    def now(self) -> float:
        """The world's time, s: whole milliseconds after its start."""
        return self._start + self._milliseconds / 1000

    @property
    def currents(self) -> Vector:
        """The true currents of the pairs x, y, z, A."""
        return self._currents

    @property
    def field(self) -> Vector:
        """The true field at the robot, T."""
        return self.coils.local_field(*self.plant.position, self._currents)

    def body(self) -> Body:
        """The true robot, for the camera to draw and for tests to compare with."""
        return Body(self.plant.pose, self.plant.pivot, self.plant.body_tilt)

    def nudge(self, pose: Pose) -> None:
        """Put the robot somewhere by hand."""
        self.plant.place(pose)

    def attend(self, visitor: Callable[[], None]) -> None:
        """Have `visitor` called before each step of the world, on the thread that moves it."""
        self._visitors.append(visitor)

    def listen(self, listener: Listener) -> Callable[[], None]:
        """Have `listener` told of the true currents, as they come, on the thread that moves the world.

        Returns what ends that.
        """
        self._listeners = [*self._listeners, listener]
        return lambda: self._forget(listener)

    def _forget(self, listener: Listener) -> None:
        self._listeners = [each for each in self._listeners if each is not listener]

    def advance_to(self, time: float) -> None:
        """Run on in whole milliseconds up to `time` (s); a time that has passed already changes nothing."""
        if not math.isfinite(time):
            raise ValueError(f"the world can only advance to a finite time in s, got {time}")
        for visit in self._visitors:
            visit()
        # A millionth of a step: 0.029 s / 1 ms must be 29 steps, though it rounds to 28.999...
        due = math.floor((time - self._start) / STEP + 1e-6)
        while self._milliseconds < due:
            self._advance(min(due - self._milliseconds, LONGEST_ADVANCE))

    def close(self) -> None:
        self.board.close()

    def _advance(self, milliseconds: int) -> None:
        currents = self.wiring.through_pairs(self.board.advance(milliseconds))
        if len(currents) != milliseconds:
            raise ValueError(
                f"the board was asked for the currents of {milliseconds} ms and gave {len(currents)}; "
                "world and board no longer agree on the time"
            )
        local_field, plant = self.coils.local_field, self.plant
        north = -1.0 if self.coils.registration.magnet_reversed else 1.0
        for sample in currents:
            x, y = plant.position
            bx, by, bz = local_field(x, y, sample)
            plant.step((north * bx, north * by, north * bz), STEP)
        self._currents = currents[-1]
        self._milliseconds += milliseconds
        for tell in self._listeners:
            tell(currents)
