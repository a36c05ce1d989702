"""The simulated board: the firmware twin, its UART, three H-bridges and the coils behind them."""

from __future__ import annotations

from control.link.messages import BoardCode, ResetCause, Triple
from control.simulation import protocol_sim
from control.simulation.bridges import Bridges, Winding
from control.simulation.twin import FirmwareTwin
from control.snapshot import Vector

UART_BYTES = 50
"""Bytes a millisecond each way at 500 kbaud, 10 bits a byte."""

RECEIVE_BUFFER = 4096
"""Bytes that the operating system keeps for a port, each way."""


class TwinBoard:
    """A board in this process; with a name it answers on the port `sim://NAME` until it is closed.

    Time moves only in `advance`.  `write` and `read` are the host's end of the serial line and may be called
    from another thread than `advance`.
    """

    firmware = "twin"

    def __init__(
        self, name: str, coils: tuple[Winding, Winding, Winding], supply: float, boot_id: int = 1
    ) -> None:
        self.name = name
        self.plugged = True
        self.milliseconds = 0
        self.bridges = Bridges(coils, supply)
        self._inbox = bytearray()
        self._outbox = bytearray()
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
        duty = twin.tick(self.bridges.counts, self.bridges.supply_count)
        if twin.is_sending:
            self._transmit()
        self.milliseconds += 1
        return self.bridges.step(duty)

    def _receive(self) -> None:
        chunk = bytes(self._inbox[:UART_BYTES])
        del self._inbox[:UART_BYTES]
        self.twin.receive(chunk)

    def _transmit(self) -> None:
        sent = self.twin.transmit(UART_BYTES)
        if self.plugged and len(self._outbox) < RECEIVE_BUFFER:
            self._outbox += sent

    @property
    def currents(self) -> Vector:
        """The true coil currents, A."""
        return self.bridges.currents

    @property
    def supply(self) -> float:
        """The bridges' supply, V; 0 is a supply that is switched off."""
        return self.bridges.supply

    @supply.setter
    def supply(self, volts: float) -> None:
        self.bridges.supply = volts

    def set_condition(self, name: str, value: int, coil: int | None = None) -> None:
        """One of `control.simulation.conditions`, in force until it is set otherwise."""
        self.bridges.set_condition(name, value, coil)
        self.twin.driver_fault = self.bridges.has_driver_fault

    @property
    def boot_id(self) -> int:
        return self.twin.boot_id

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
        self.twin.driver_fault = self.bridges.has_driver_fault
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
