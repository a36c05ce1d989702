"""What the emulated board's lock-step port knows beyond the twin's: cycles, and what the firmware did in order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from control.link.messages import Triple
from control.simulation.lockstep import RemoteBoard


@dataclass(frozen=True, slots=True)
class Stretch:
    """Processor cycles of something that happens again and again."""

    count: int
    worst: int
    mean: float
    worst_share: float
    """Of the millisecond's cycles."""


@dataclass(frozen=True, slots=True)
class Cycles:
    """tick: the millisecond's work.  interrupt: the same with all that saves and restores registers, and with the
    interrupts that come meanwhile.  period: cycles of a millisecond.
    receiver_depth, overruns: bytes that waited in the UART at once, and that it lost.
    """

    tick: Stretch
    interrupt: Stretch
    period: int
    receiver_depth: int
    overruns: int


@dataclass(frozen=True, slots=True)
class Consumed:
    """Bytes that the firmware's decoder took."""

    data: bytes


@dataclass(frozen=True, slots=True)
class Sent:
    """Bytes that the firmware gave to its UART."""

    data: bytes


@dataclass(frozen=True, slots=True)
class Tick:
    """A millisecond begins. counts, supply_count: of the ADC."""

    counts: Triple
    supply_count: int
    driver_fault: bool


@dataclass(frozen=True, slots=True)
class Duty:
    """A millisecond has ended: signed PWM steps as the pins stand."""

    steps: Triple


@dataclass(frozen=True, slots=True)
class Reset:
    """The board booted anew."""


Event = Consumed | Sent | Tick | Duty | Reset


class EmulatorPort(RemoteBoard):
    """The emulated board as the world's board, and under the microscope."""

    def cycles(self) -> Cycles:
        """Since the last time that somebody asked."""
        told: dict[str, Any] = self.told("cycles")
        tick, interrupt = Stretch(**told.pop("tick")), Stretch(**told.pop("interrupt"))
        return Cycles(tick, interrupt, **told)

    def released(self) -> tuple[bool, bool, bool]:
        """Whether the board lets go of each coil's EN/DIAG line."""
        x, y, z = map(bool, self.told("enable"))
        return x, y, z

    def trace(self) -> None:
        """Begins to write down what the firmware does."""
        self.ask("trace on")

    def traced(self) -> list[Event]:
        """What it did since the last time; ConnectionError when that was more than the board keeps."""
        return [_event(line) for line in self.ask("trace take")]


def _event(line: str) -> Event:
    match line.split():
        case ["rx", data]:
            return Consumed(bytes.fromhex(data))
        case ["tx", data]:
            return Sent(bytes.fromhex(data))
        case ["tick", a, b, c, supply, fault]:
            return Tick((int(a), int(b), int(c)), int(supply), fault != "0")
        case ["duty", a, b, c]:
            return Duty((int(a), int(b), int(c)))
        case ["reset"]:
            return Reset()
        case _:
            raise ConnectionError(f"the emulated board's trace says {line!r}")
