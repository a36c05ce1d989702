"""A coil that carries a steady current while a person looks at an instrument."""

from __future__ import annotations

import math
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from statistics import fmean
from typing import Self

import typer

from control.axes import AXES, Axis
from control.calibration.bench import Bench
from control.calibration.windings import SenseGains, without_cut_off
from control.link.conversion import Telemetry
from control.safety import Refused
from server.commands.outcome import console

SHOWN_CHANGE = 0.1
"""A sensed current that changes by so much is shown again, A: three counts of the ADC, more than its noise."""
AVERAGED = 12
"""Reports that the sensed current is the mean of: a fifth of a second."""
PATIENCE = 300.0
"""A coil is held for so long at most, s: whoever has walked away leaves no current behind."""


@dataclass(frozen=True, slots=True)
class Held:
    """A coil that is to carry a current (A)."""

    coil: Axis
    current: float

    @property
    def index(self) -> int:
        return AXES.index(self.coil)


class HeldCoil:
    """`with HeldCoil(...) as held:` the coil carries its current while a person looks at an instrument.

    A thread of its own renews the command meanwhile, for `patience` (s) at most; however the block ends, the coil
    is at zero after it.
    """

    def __init__(self, bench: Bench, held: Held, patience: float = PATIENCE) -> None:
        self._bench = bench
        self._held = held
        self._patience = patience
        self._give_up = math.inf
        self._newest: deque[float] = deque(maxlen=AVERAGED)
        self._over = threading.Event()
        self._settled = threading.Event()
        self._shown = math.inf
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._hold, name="held coil")

    def __enter__(self) -> Self:
        try:
            self._thread.start()
            self._settled.wait()
            self._require_held()
        except BaseException:
            self._end()
            raise
        return self

    @property
    def sensed(self) -> float:
        """What the board's sense has shown lately, A."""
        return fmean(tuple(self._newest) or (0.0,))

    @property
    def is_held(self) -> bool:
        """Whether the coil still carries its current."""
        return self._error is None

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._end()
        if kind is None or (kind is typer.Abort and not self.is_held):
            self._require_held()

    def _end(self) -> None:
        self._over.set()
        if self._thread.ident is not None:
            self._thread.join()

    def _require_held(self) -> None:
        if self._error is not None:
            raise self._error

    def _hold(self) -> None:
        try:
            self._give_up = self._bench.camera.now() + self._patience
            self._bench.hold_coil_while(self._held.index, self._held.current, self._is_wanted, self._watch)
            if not self._over.is_set():
                raise Refused(f"no reading came within {self._patience:g} s")
        except Exception as error:  # noqa: BLE001 (raised again on the command's own thread)
            self._error = error
            console.print(f"the coils are at zero: {error}", style="red", markup=False, highlight=False)
        finally:
            self._settled.set()

    def _is_wanted(self) -> bool:
        return not self._over.is_set() and self._bench.camera.now() <= self._give_up

    def _watch(self, report: Telemetry) -> None:
        self._newest.append(report.measured_currents[self._held.index])
        if len(self._newest) < AVERAGED:
            return
        if not abs(self.sensed - self._shown) <= SHOWN_CHANGE:
            self._shown = self.sensed
            console.print(
                f"{self._held.coil} coils: {self._held.current:+.2f} A, sensed {self.sensed:+.2f} A",
                highlight=False,
            )
        self._settled.set()


Instrument = Callable[[Held, HeldCoil], float]
"""What an instrument shows while a coil is held."""


def held_each_way(
    bench: Bench, most: Held, instrument: Instrument, gains: SenseGains
) -> list[tuple[float, float]]:
    """Sensed current (A) and the instrument's value for each of four currents."""
    found = []
    for wanted in each_way(most.current):
        held = Held(most.coil, wanted)
        with HeldCoil(bench, held) as coil:
            value = instrument(held, coil)
            found.append((without_cut_off(coil.sensed, gains), value))
    return found


def each_way(current: float) -> tuple[float, ...]:
    return 0.5 * current, -0.5 * current, -current, current
