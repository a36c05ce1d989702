"""The simulated board: the firmware twin, its UART, three H-bridges and the coils behind them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from control.link.messages import BoardCode, ResetCause, Triple
from control.simulation import protocol_sim
from control.simulation.coil_drive import PWM_STEPS
from control.simulation.regulator import FULL_COUNT
from control.simulation.twin import FirmwareTwin
from control.snapshot import ZERO, Vector

UART_BYTES = 50
"""Bytes a millisecond each way at 500 kbaud, 10 bits a byte."""

RECEIVE_BUFFER = 4096
"""Bytes that the operating system keeps for a port, each way."""

_COUNTS_PER_AMPERE = 0.14 / 5.0 * 1024.0
_TICK = 1e-3


@dataclass(frozen=True, slots=True)
class Winding:
    """One coil pair as its bridge sees it: ohm, H."""

    resistance: float
    inductance: float

    def __post_init__(self) -> None:
        for name in ("resistance", "inductance"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise ValueError(f"a coil's {name} is {value!r}; it must be a positive number in SI units")


class TwinBoard:
    """A board in this process; with a name it answers on the port `sim://NAME` until it is closed.

    Time moves only in `advance`.  `write` and `read` are the host's end of the serial line and may be called
    from another thread than `advance`.
    """

    def __init__(
        self, name: str, coils: tuple[Winding, Winding, Winding], supply: float, boot_id: int = 1
    ) -> None:
        self.name = name
        self.plugged = True
        self.currents: Vector = ZERO
        self.milliseconds = 0
        self._decay = tuple(math.exp(-_TICK * coil.resistance / coil.inductance) for coil in coils)
        self._gain = tuple(
            (1.0 - decay) / coil.resistance / steps
            for decay, coil, steps in zip(self._decay, coils, PWM_STEPS, strict=True)
        )
        self._inbox = bytearray()
        self._outbox = bytearray()
        self.supply = supply
        self.twin = FirmwareTwin(boot_id)
        if name:
            protocol_sim.register(name, self)

    # ---- the world's side

    def advance(self, milliseconds: int) -> list[Vector]:
        """Runs on; the coil currents (A) at the end of each millisecond."""
        return [self._millisecond() for _ in range(milliseconds)]

    def _millisecond(self) -> Vector:
        twin = self.twin
        if self._inbox:
            self._receive()
        i1, i2, i3 = self.currents
        counts = _counts(i1), _counts(i2), _counts(i3)
        d1, d2, d3 = twin.tick(counts, self._supply_mV)
        if twin.is_sending:
            self._transmit()
        self.milliseconds += 1
        a1, a2, a3 = self._decay
        b1, b2, b3 = self._gain
        supply = self._supply
        self.currents = (
            a1 * i1 + b1 * d1 * supply,
            a2 * i2 + b2 * d2 * supply,
            a3 * i3 + b3 * d3 * supply,
        )
        return self.currents

    def _receive(self) -> None:
        chunk = bytes(self._inbox[:UART_BYTES])
        del self._inbox[:UART_BYTES]
        self.twin.receive(chunk)

    def _transmit(self) -> None:
        sent = self.twin.transmit(UART_BYTES)
        if self.plugged and len(self._outbox) < RECEIVE_BUFFER:
            self._outbox += sent

    @property
    def supply(self) -> float:
        """The bridges' supply, V; 0 is a supply that is switched off."""
        return self._supply

    @supply.setter
    def supply(self, volts: float) -> None:
        if not (math.isfinite(volts) and 0.0 <= volts <= 65.0):
            raise ValueError(f"supply is {volts!r} V; allowed is 0 to 65 V")
        self._supply = volts
        self._supply_mV = round(volts * 1e3)

    @property
    def state(self) -> BoardCode:
        return self.twin.state

    @property
    def duty(self) -> Triple:
        """Signed PWM steps, of 800, 800 and 100."""
        return self.twin.duty

    @property
    def drive_is_zero(self) -> bool:
        return self.twin.duty == (0, 0, 0)

    def reset(self, cause: ResetCause = ResetCause.EXTERNAL) -> None:
        """The board boots anew, with the next boot id; what the port holds of its words is kept."""
        self.twin = FirmwareTwin(self.twin.boot_id % 0xFFFF + 1, cause)
        self._inbox.clear()

    def close(self) -> None:
        if self.name:
            protocol_sim.unregister(self.name, self)

    # ---- the host's side

    def unplug(self) -> None:
        """The cable is out: the port is gone, the board runs on by itself."""
        self.plugged = False
        self._inbox.clear()
        self._outbox.clear()

    def plug(self) -> None:
        self.plugged = True

    @property
    def room(self) -> int:
        """Bytes that the port takes at once."""
        return RECEIVE_BUFFER - len(self._inbox)

    @property
    def waiting(self) -> int:
        """Bytes that the port has for the host."""
        return len(self._outbox)

    def write(self, data: bytes) -> None:
        self._inbox += data

    def read(self, most: int) -> bytes:
        taken = bytes(self._outbox[:most])
        del self._outbox[:most]
        return taken


def _counts(current: float) -> int:
    """What the ADC makes of the driver's unsigned current sense: 0.14 V/A, 10 bits of 5 V."""
    counts = int(abs(current) * _COUNTS_PER_AMPERE)
    return counts if counts < FULL_COUNT else FULL_COUNT
