"""A hand on the board's wire: what a host sends, without the host's own checks."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from control.link import wire
from control.link.conversion import configure_message, phase, phase_rate
from control.link.messages import ARM, Banner, Drive, Hello, Message, Stop, Telemetry
from control.simulation.board import TwinBoard, Winding
from tests.paper_board import CONFIGURATION

CONFIGURE = configure_message(CONFIGURATION)
ONE = 13107  # 0.8 mA/uT in Q14: 8 A for 10 mT
TILT = round(25.0 / 360.0 * 65536)
CALM = Drive(
    flags=0,
    pivot=1,
    rate=0,
    heading_goal=0,
    start_heading=0,
    tilt=TILT,
    field=10000,
    allocation=(ONE, 0, 0, 0, ONE, 0, 0, 0, ONE),
    time_to_live=200,
)


def windings(warmth: float = 1.0) -> tuple[Winding, Winding, Winding]:
    """The coils of CONFIGURATION, with `warmth` times its resistances."""
    x, y, z = zip(CONFIGURATION.resistances, CONFIGURATION.inductances, strict=True)
    return Winding(x[0] * warmth, x[1]), Winding(y[0] * warmth, y[1]), Winding(z[0] * warmth, z[1])


class Bench:
    """A TwinBoard and the bytes to and from it; `heard` keeps what it said."""

    def __init__(self, boot_id: int = 7, warmth: float = 1.0) -> None:
        self.board = TwinBoard("", windings(warmth), 24.0, boot_id)
        self.sequence = 0
        self.heard: list[wire.Packet] = []
        self._decoder = wire.Decoder()

    def send(self, message: Message, **header: int) -> int:
        """One message with the next number, boot id and version unless told otherwise; returns its number."""
        self.sequence = header.get("sequence", (self.sequence + 1) % 65536)
        boot_id = header.get("boot_id", self.board.twin.boot_id)
        version = header.get("version", wire.PROTOCOL_VERSION)
        self.board.write(wire.encode(message, self.sequence, boot_id, version))
        return self.sequence

    def run(self, milliseconds: int) -> None:
        self.board.advance(milliseconds)
        self.heard += self._decoder.feed(self.board.read(1 << 20))

    def say(self, message: Message, **header: int) -> None:
        """Sends and waits until the last byte has arrived, which takes at most 2 ms."""
        self.send(message, **header)
        self.run(2)

    def ready(self) -> Bench:
        self.say(Hello())
        self.say(CONFIGURE)
        return self

    def driving(self, start: float = 0.0, **changes: Any) -> Bench:
        """Armed, with the field fully up and the currents settled."""
        self.ready()
        self.say(replace(CALM, flags=ARM, start_heading=phase(start), heading_goal=phase(start), **changes))
        for _ in range(40):
            self.say(replace(CALM, heading_goal=phase(start), **changes))
            self.run(10)
        return self

    def turn(self, goal: float, rate: float, **changes: Any) -> None:
        self.say(replace(CALM, heading_goal=phase(goal), rate=phase_rate(rate), **changes))

    def stop(self) -> None:
        self.say(Stop())

    @property
    def telemetry(self) -> Telemetry:
        """The newest report, at most 10 ms old."""
        reports = [p.message for p in self.heard if isinstance(p.message, Telemetry)]
        return reports[-1]

    @property
    def banners(self) -> list[Banner]:
        return [p.message for p in self.heard if isinstance(p.message, Banner)]
