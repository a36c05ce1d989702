"""The Python twin and the C++ core side by side: whatever one is told the other is told, and they must not differ."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from core_library import CoreBoard

from control.link import messages, wire
from control.link.conversion import configure_message
from control.link.messages import ARM, Drive, Message
from control.simulation.bridges import Bridges, Winding
from control.simulation.twin import FirmwareTwin
from tests.paper_board import CONFIGURATION

CONFIGURE = configure_message(CONFIGURATION)
ONE = 13107  # 0.8 mA/uT in Q14: 8 A for 10 mT
CALM = Drive(
    flags=0,
    pivot=1,
    rate=0,
    heading_goal=0,
    start_heading=0,
    tilt=4551,
    field=10000,
    allocation=(ONE, 0, 0, 0, ONE, 0, 0, 0, ONE),
    time_to_live=150,
)
ARMING = replace(CALM, flags=ARM)
NOMINAL = 446
"""What the ADC reads of 24 V."""


class Twins:
    """Both boards; `heard` is every byte that they sent, `reports` the telemetry in it."""

    def __init__(self, boot_id: int = 7, cause: messages.ResetCause = messages.ResetCause.POWER_ON) -> None:
        self.boot_id = boot_id
        self.twin = FirmwareTwin(boot_id, cause)
        self.core = CoreBoard(boot_id, cause)
        self.sequence = 0
        self.heard = b""
        coils = zip(CONFIGURATION.resistances, CONFIGURATION.inductances, strict=True)
        x, y, z = (Winding(*constants) for constants in coils)
        self.bridges = Bridges((x, y, z), 24.0)

    def __enter__(self) -> Twins:
        return self

    def __exit__(self, *_: object) -> None:
        self.core.close()

    def receive(self, data: bytes) -> None:
        self.twin.receive(data)
        self.core.receive(data)
        assert self.core.state == self.twin.state
        self.drain()

    def drain(self, most: int = 4096) -> None:
        said, said_by_core = self.twin.transmit(most), self.core.transmit(most)
        assert said_by_core == said, f"{self.words(said_by_core)} instead of {self.words(said)}"
        self.heard += said

    @staticmethod
    def words(data: bytes) -> list[wire.Packet]:
        return wire.Decoder().feed(data)

    @property
    def reports(self) -> list[messages.Telemetry]:
        return [p.message for p in self.words(self.heard) if isinstance(p.message, messages.Telemetry)]

    def say(self, message: Message, **header: Any) -> None:
        """One message with the next number, boot id and version unless told otherwise."""
        self.sequence = header.get("sequence", (self.sequence + 1) % 65536)
        boot_id = header.get("boot_id", self.boot_id)
        self.receive(
            wire.encode(message, self.sequence, boot_id, header.get("version", wire.PROTOCOL_VERSION))
        )

    def tick(self, counts: messages.Triple, supply_count: int = NOMINAL, *, most: int = 4096) -> None:
        """One millisecond with these readings."""
        duty = self.twin.tick(counts, supply_count)
        assert self.core.tick(counts, supply_count) == duty
        assert self.core.state == self.twin.state
        self.drain(most)

    def run(self, milliseconds: int) -> None:
        """On with the currents that the coils really have."""
        for _ in range(milliseconds):
            self.tick(self.bridges.counts, self.bridges.supply_count)
            self.bridges.step(self.twin.duty)

    def set_driver_fault(self, is_there: bool) -> None:
        self.twin.driver_fault = self.core.driver_fault = is_there
