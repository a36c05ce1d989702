"""The conversation with one board: greeting, configuration, numbered commands, its reports.

Bytes and `now` in, bytes and values out; no port, no clock, no thread.  A board that has booted anew, or has
fallen silent, is greeted again, which leaves its coils at zero: only an arm edge drives it after that.
"""

from __future__ import annotations

from enum import StrEnum

from control.link import conversion, messages, wire
from control.link.conversion import Configuration, DriveCommand, LinkError, Telemetry

RESEND = 0.3
"""Time to wait for an answer to a hello or a configuration, s: well above a round trip."""

SILENCE = 0.5
"""Without telemetry for so long (it comes every 10 ms) the board is greeted again, s."""

BEHIND = wire.SEQUENCE_WINDOW // 2
"""Unacknowledged messages before the numbering starts anew; at twice as many the board obeys none."""


class LinkState(StrEnum):
    CLOSED = "closed"
    GREETING = "greeting"
    CONFIGURING = "configuring"
    READY = "ready"


class Session:
    """state, and reason: a sentence for people on why it is not READY, empty when it is.

    incident: why the conversation broke last, kept until the next arm edge; a new handshake takes only two
    frames, and whoever was driving must not take the board for the one that it was.
    boot_id: of the board in conversation.  round_trip: from the last measured drive to its echo, s.
    """

    def __init__(self, configuration: Configuration) -> None:
        self.configuration = configuration
        self.state = LinkState.CLOSED
        self.reason = "not opened"
        self.incident = ""
        self.firmware = ""
        self.boot_id = 0
        self.round_trip: float | None = None
        self.bad_frames = 0
        self.telemetry: Telemetry | None = None
        self._configure = conversion.configure_message(configuration)
        self._hash = wire.configuration_hash(self._configure)
        self._decoder = wire.Decoder()
        self._sequence = 0
        self._question: int | None = None
        self._asked_at = -1e9
        self._heard_at = -1e9
        self._probe: tuple[int, float] | None = None

    # ---- the state's table

    def open(self) -> None:
        self._greet("greeting the board")

    def lose(self, reason: str) -> None:
        """The port is gone."""
        if self.state is LinkState.READY:
            self.incident = reason
        self.state = LinkState.CLOSED
        self.reason = reason
        self._forget()

    def _break_off(self, incident: str) -> None:
        self.incident = f"{incident}: arm again"
        self._greet(self.incident)

    def _greet(self, reason: str) -> None:
        self.state = LinkState.GREETING
        self.reason = reason
        self._asked_at = -1e9
        self._forget()

    def _forget(self) -> None:
        self.bad_frames += self._decoder.dropped
        self._decoder = wire.Decoder()
        self.telemetry = None
        self._probe = None
        self._question = None  # whatever is still on its way answers an earlier question

    def _meet(self, packet: wire.Packet, banner: messages.Banner) -> None:
        self.boot_id = packet.boot_id
        self.firmware = ".".join(str(number) for number in banner.firmware)
        self.state = LinkState.CONFIGURING
        self.reason = self.incident or "configuring the board"
        self._asked_at = -1e9

    def _be_ready(self, now: float) -> None:
        self.state = LinkState.READY
        self.reason = ""
        self._heard_at = now

    # ---- bytes in

    @property
    def broken_frames(self) -> int:
        """Received frames that were dropped since the session began."""
        return self.bad_frames + self._decoder.dropped

    def receive(self, data: bytes, now: float) -> Telemetry | None:
        """Takes in what came; the newest report of a ready board, or None."""
        newest = None
        for packet in self._decoder.feed(data):
            if isinstance(packet.message, messages.Banner):
                self._hear_banner(packet, packet.message, now)
            elif isinstance(packet.message, messages.Telemetry):
                newest = self._hear_report(packet, packet.message, now) or newest
        if self.state is not LinkState.READY:
            return None
        self.telemetry = newest or self.telemetry
        self._check_attention(now)
        return newest if self.state is LinkState.READY else None

    def _hear_banner(self, packet: wire.Packet, banner: messages.Banner, now: float) -> None:
        answers = packet.sequence == self._question
        if packet.version != wire.PROTOCOL_VERSION:
            self._refuse_version(packet.version)
        elif self.state is LinkState.GREETING:
            if answers:
                self._meet(packet, banner)
        elif packet.boot_id != self.boot_id:
            self._break_off(f"the board was reset (boot id {self.boot_id} -> {packet.boot_id})")
        elif self.state is LinkState.CONFIGURING and answers and banner.configuration_hash == self._hash:
            self._be_ready(now)

    def _refuse_version(self, version: int) -> None:
        if self.state is not LinkState.GREETING:
            self._greet("")
        self.reason = (
            f"the board speaks protocol version {version}, this program speaks {wire.PROTOCOL_VERSION}: "
            "flash the firmware that belongs to this program"
        )

    def _hear_report(self, packet: wire.Packet, report: messages.Telemetry, now: float) -> Telemetry | None:
        if self.state is LinkState.CONFIGURING and packet.boot_id == self.boot_id:
            self._explain_configuring(report)
        if self.state is not LinkState.READY:
            return None
        if packet.boot_id != self.boot_id:
            self._break_off(f"the board was reset (boot id {self.boot_id} -> {packet.boot_id})")
            return None
        if report.configuration_hash != self._hash:
            self._break_off("the board lost its configuration")
            return None
        self._heard_at = now
        self._time_echo(report.last_sequence, now)
        return conversion.telemetry_from(packet, report, now)

    def _explain_configuring(self, report: messages.Telemetry) -> None:
        if report.last_refusal == messages.Refusal.CONFIGURATION:
            self.reason = "the board refuses the configuration: a limit or coil constant is outside its range"
        elif report.last_refusal == messages.Refusal.STATE:
            self.reason = "the board refuses the configuration in its present state"

    def _time_echo(self, echoed: int, now: float) -> None:
        if self._probe is None:
            return
        sequence, sent_at = self._probe
        if wire.sequence_distance(echoed, sequence) < wire.SEQUENCE_WINDOW:
            self.round_trip = now - sent_at
            self._probe = None

    def _check_attention(self, now: float) -> None:
        if now - self._heard_at > SILENCE:
            self._break_off(f"no telemetry for {SILENCE} s")
        elif self.telemetry is not None:
            unheard = wire.sequence_distance(self._sequence, self.telemetry.last_sequence)
            if unheard > BEHIND:
                self._break_off(f"the board missed the last {unheard} messages")

    # ---- bytes out

    def due(self, now: float) -> bytes:
        """The question that is to be asked now, if any."""
        if now - self._asked_at < RESEND:
            return b""
        if self.state is LinkState.GREETING:
            return self._ask(messages.Hello(), now)
        if self.state is LinkState.CONFIGURING:
            return self._ask(self._configure, now)
        return b""

    def _ask(self, question: messages.Hello | messages.Configure, now: float) -> bytes:
        self._asked_at = now
        frame = self._numbered(question)
        self._question = self._sequence
        return frame

    def drive(self, command: DriveCommand, now: float) -> bytes:
        if self.state is not LinkState.READY:
            raise LinkError(f"the board is not ready: {self.reason}")
        frame = self._numbered(conversion.drive_message(command, self.configuration))
        if command.start_heading is not None:
            self.incident = ""
        if self._probe is None or now - self._probe[1] > 1.0:
            self._probe = self._sequence, now
        return frame

    def stop(self) -> bytes:
        return self._numbered(messages.Stop())

    def _numbered(self, message: messages.Message) -> bytes:
        """The next number is taken only when the message has been encoded."""
        sequence = (self._sequence + 1) % wire.SEQUENCE_MODULUS or 1
        frame = wire.encode(message, sequence, self.boot_id)
        self._sequence = sequence
        return frame
