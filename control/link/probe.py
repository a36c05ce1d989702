"""Who answers on a port: greet it, listen, and go; the board is left at zero, as every greeting leaves it.

Opening the port of an UNO resets it: its bootloader takes up to 2 s, says nothing, and may answer a hello with
garbage. So the hello is repeated, and only a banner that answers one counts.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from enum import StrEnum

from control.link import messages, reasons, wire
from control.link.line import SerialLine
from control.link.opening import PORT_ERRORS, PortError, Trouble, open_serial

RESEND = 0.3
"""Time to wait for an answer to a hello, s: well above a round trip."""

PATIENCE = 3.0
"""How long a board may take to answer, s: 2 s of an old bootloader, and three hellos."""

BAUD = 500_000
"""The firmware's speed."""

_PAUSE = 5e-3
_MOST_BYTES = 4096


class PortState(StrEnum):
    """What is known of a port."""

    UNKNOWN = "unknown"
    """Not asked."""
    OURS = "ours"
    OTHER_VERSION = "other version"
    FOREIGN = "foreign"
    """Another firmware, another baud rate, or nothing that answers."""
    BUSY = "busy"
    FORBIDDEN = "forbidden"
    MISSING = "missing"
    FAILED = "failed"


_IN_WORDS = {
    Trouble.BUSY: PortState.BUSY,
    Trouble.FORBIDDEN: PortState.FORBIDDEN,
    Trouble.MISSING: PortState.MISSING,
    Trouble.FAILED: PortState.FAILED,
}


@dataclass(frozen=True, slots=True)
class Identity:
    """Who a board says it is. configuration_hash: 0 without one.  round_trip: hello to banner, s."""

    firmware: str
    protocol: int
    boot_id: int
    reset_cause: str
    configuration_hash: int
    round_trip: float


@dataclass(frozen=True, slots=True)
class Findings:
    """What became of asking. message: a sentence for people, with what to do."""

    state: PortState
    message: str
    identity: Identity | None = None


class Inquiry:
    """The conversation: `now` and bytes in, bytes and findings out; no port, no clock."""

    def __init__(self) -> None:
        self.identity: Identity | None = None
        self._decoder = wire.Decoder()
        self._sequence = 0
        self._asked_at = self._due_at = -math.inf
        self._heard = 0

    def due(self, now: float) -> bytes:
        """The hello that is to be sent now, if any."""
        if self.identity is not None or now < self._due_at:
            return b""
        self._asked_at, self._due_at = now, now + RESEND
        self._sequence += 1
        return wire.encode(messages.Hello(), self._sequence, 0)

    def receive(self, data: bytes, now: float) -> None:
        self._heard += len(data)
        for packet in self._decoder.feed(data):
            if isinstance(packet.message, messages.Banner):
                self._hear_banner(packet, packet.message, now)

    def _hear_banner(self, packet: wire.Packet, banner: messages.Banner, now: float) -> None:
        """A banner without a number is the boot's: what was asked before it is lost."""
        if packet.sequence == self._sequence:
            self.identity = _identity(packet, banner, now - self._asked_at)
        elif packet.sequence == 0:
            self._due_at = now

    @property
    def findings(self) -> Findings:
        identity = self.identity
        if identity is None:
            return Findings(PortState.FOREIGN, self._strange())
        if identity.protocol != wire.PROTOCOL_VERSION:
            message = reasons.other_version(identity.firmware, identity.protocol)
            return Findings(PortState.OTHER_VERSION, message, identity)
        return Findings(
            PortState.OURS, f"a board with firmware {identity.firmware}, ready to be used", identity
        )

    def _strange(self) -> str:
        heard = (
            f"{self._heard} bytes came, but no message of ours" if self._heard else "nothing answers there"
        )
        return (
            f"{heard}: another firmware or device, or another baud rate; "
            "an UNO gets our firmware by `pivotrig firmware flash`"
        )


def _identity(packet: wire.Packet, banner: messages.Banner, round_trip: float) -> Identity:
    return Identity(
        firmware=".".join(str(number) for number in banner.firmware),
        protocol=packet.version,
        boot_id=packet.boot_id,
        reset_cause=reset_cause_in_words(banner.reset_cause),
        configuration_hash=banner.configuration_hash,
        round_trip=round_trip,
    )


def reset_cause_in_words(code: int) -> str:
    known = {cause.value: cause.name.lower().replace("_", " ") for cause in messages.ResetCause}
    return known.get(code, f"unknown ({code})")


def probe(port: str, baud: int = BAUD, patience: float = PATIENCE) -> Findings:
    """Opens the port, asks for at most `patience` (s), and closes it. Resets the board that is there."""
    try:
        line = open_serial(port, baud)
    except PortError as error:
        return Findings(_IN_WORDS[error.trouble], str(error))
    try:
        return _ask(line, patience)
    except PORT_ERRORS as error:
        return Findings(PortState.FAILED, f"{port} failed while it was asked: {error}")
    finally:
        line.close()


def _ask(line: SerialLine, patience: float) -> Findings:
    inquiry = Inquiry()
    until = time.monotonic() + patience
    while inquiry.identity is None and time.monotonic() < until:
        hello = inquiry.due(time.monotonic())
        if hello:
            line.write(hello)
        waiting = min(line.in_waiting, _MOST_BYTES)
        if waiting:
            inquiry.receive(line.read(waiting), time.monotonic())
        elif inquiry.identity is None:
            time.sleep(_PAUSE)
    return inquiry.findings
