"""The conversation with one board: greeting, configuration, numbered commands, its reports.

Bytes and `now` in, bytes and values out; no port, no clock, no thread.  A board that has booted anew, or has
fallen silent, is greeted again, which leaves its coils at zero: only an arm edge drives it after that.
"""

from __future__ import annotations

from enum import StrEnum

from control.link import conversion, messages, reasons, wire
from control.link.conversion import Configuration, DriveCommand, LinkError, Telemetry
from control.link.quality import BoardCounts, BrokenShare, Echoes, broken_by_kind

RESEND = 0.3
"""Time to wait for an answer to a hello or a configuration, s: well above a round trip."""

UNANSWERED = 10
"""Questions in a row without an answer before the reason says what may be wrong: 3 s, in which every bootloader of
an UNO has handed over (2 s)."""

SILENCE = 0.5
"""Without telemetry for so long (it comes every 10 ms) the board is greeted again, s."""

BEHIND = wire.SEQUENCE_WINDOW // 2
"""Unacknowledged messages before the numbering starts anew; at twice as many the board obeys none."""

LATE = 0.3
"""A command that the board has not heard after so long, s, means that a stop would be as late: nothing more is sent
until the next arm edge. Twice a command's life, as two of three reports are lost on a bad line."""

_AHEAD = wire.SEQUENCE_MODULUS // 2
"""A report is newer than another when its number is ahead by less than this; else it was repeated or delayed."""


class LinkState(StrEnum):
    CLOSED = "closed"
    GREETING = "greeting"
    CONFIGURING = "configuring"
    READY = "ready"


class Session:
    """state, and reason: a sentence for people on why it is not READY, empty when it is.

    incident: how a board in conversation stopped being the one that it was, kept until the next arm edge; a new
    handshake takes only two frames, and whoever was driving must not take the board for the one before.  A lost
    port is none: it stays lost for many ticks.
    boot_id: of the board in conversation.  received: whole messages.  resends: questions asked again.
    """

    def __init__(self, configuration: Configuration) -> None:
        self.configuration = configuration
        self.state = LinkState.CLOSED
        self.reason = "not opened"
        self.incident = ""
        self.firmware = ""
        self.boot_id = 0
        self.received = 0
        self.resends = 0
        self.echoes = Echoes()
        self.telemetry: Telemetry | None = None
        self._configure = conversion.configure_message(configuration)
        self._hash = wire.configuration_hash(self._configure)
        self._decoder = wire.Decoder()
        self._sequence = 0
        self._question: int | None = None
        self._unanswered = 0
        self._has_heard_noise = False
        self._asked_at = -1e9
        self._heard_at = -1e9
        self._reported: int | None = None
        self._forget_quality()

    # ---- the state's table

    def open(self) -> None:
        self._greet("greeting the board")

    def lose(self, reason: str) -> None:
        """The port is gone."""
        self.state = LinkState.CLOSED
        self.reason = reason
        self._forget()

    def _break_off(self, incident: str) -> None:
        self.incident = f"{incident}: arm again"
        self._greet(self.incident)

    def _greet(self, reason: str) -> None:
        self.state = LinkState.GREETING
        self.reason = reason
        self._forget()

    def _forget(self) -> None:
        self._decoder.restart()
        self.telemetry = None
        self.echoes.begin()
        self._reported = None
        self._has_heard_noise = False
        self._await_answer_to_none()

    def _await_answer_to_none(self) -> None:
        """The next question is asked at once; whatever is still on its way answers an earlier one."""
        self._asked_at = -1e9
        self._unanswered = 0
        self._question = None

    def _forget_quality(self) -> None:
        """A bootloader's garbage says nothing about the line."""
        self._incoming, self._outgoing = BrokenShare(), BrokenShare()
        self._board_counts = BoardCounts()

    def _meet(self, packet: wire.Packet, banner: messages.Banner) -> None:
        self.boot_id = packet.boot_id
        self.firmware = _version(banner)
        self.state = LinkState.CONFIGURING
        self.reason = self.incident or "configuring the board"
        self._await_answer_to_none()

    def _be_ready(self, now: float) -> None:
        self.state = LinkState.READY
        self.reason = ""
        self._heard_at = now
        self._forget_quality()

    # ---- bytes in

    @property
    def broken_frames(self) -> int:
        """Received frames that were dropped since the session began."""
        return self._decoder.dropped

    @property
    def broken_by_kind(self) -> dict[str, int]:
        return broken_by_kind(self._decoder)

    def bad_share(self, now: float) -> float:
        """0..1 of the last second's frames that arrived broken, in the worse direction, since it is ready."""
        return max(self._incoming.share(now), self._outgoing.share(now))

    def receive(self, data: bytes, now: float) -> Telemetry | None:
        """Takes in what came; the newest report of a ready board, or None."""
        newest = None
        for packet in self._decode(data, now):
            if isinstance(packet.message, messages.Banner):
                self._hear_banner(packet, packet.message, now)
            elif isinstance(packet.message, messages.Telemetry):
                newest = self._hear_report(packet, packet.message, now) or newest
        if self.state is not LinkState.READY:
            return None
        self.telemetry = newest or self.telemetry
        self._check_attention(now)
        return newest if self.state is LinkState.READY else None

    def _decode(self, data: bytes, now: float) -> list[wire.Packet]:
        dropped = self._decoder.dropped
        packets = self._decoder.feed(data)
        self.received += len(packets)
        self._has_heard_noise = self._has_heard_noise or bool(data)
        self._incoming.add(now, len(packets), self._decoder.dropped - dropped)
        return packets

    def _hear_banner(self, packet: wire.Packet, banner: messages.Banner, now: float) -> None:
        answers = packet.sequence == self._question
        if packet.version != wire.PROTOCOL_VERSION:
            self._refuse_version(packet.version, banner)
        elif self.state is LinkState.GREETING:
            self._hear_greeted(packet, banner, answers)
        elif packet.boot_id != self.boot_id:
            self._break_off(reasons.was_reset(self.boot_id, packet.boot_id))
        elif self.state is LinkState.CONFIGURING and answers:
            self._hear_configured(banner, now)

    def _hear_greeted(self, packet: wire.Packet, banner: messages.Banner, answers: bool) -> None:
        """The banner of a boot has no number: what was asked before it is lost, and is asked again at once."""
        if answers:
            self._meet(packet, banner)
        elif packet.sequence == 0:
            self._asked_at = -1e9

    def _hear_configured(self, banner: messages.Banner, now: float) -> None:
        if banner.configuration_hash == self._hash:
            self._be_ready(now)
            return
        self.reason = reasons.other_configuration(banner.configuration_hash, self._hash)

    def _refuse_version(self, version: int, banner: messages.Banner) -> None:
        if self.state is not LinkState.GREETING:
            self._greet("")
        self._unanswered = 0
        self.firmware = _version(banner)
        self.reason = reasons.other_version(self.firmware, version)

    def _hear_report(self, packet: wire.Packet, report: messages.Telemetry, now: float) -> Telemetry | None:
        if self.state is LinkState.CONFIGURING and packet.boot_id == self.boot_id:
            self.reason = reasons.refused_configuration(report.last_refusal) or self.reason
        if self.state is not LinkState.READY:
            return None
        if packet.boot_id != self.boot_id:
            self._break_off(reasons.was_reset(self.boot_id, packet.boot_id))
            return None
        if report.configuration_hash != self._hash:
            self._break_off("the board lost its configuration")
            return None
        if not self._is_newer(packet.sequence):
            return None
        self._heard_at = now
        self._outgoing.add(now, *self._board_counts.step(report))
        self.echoes.heard(report.last_sequence, now)
        return conversion.telemetry_from(packet, report, now)

    def _is_newer(self, sequence: int) -> bool:
        """A report that the line repeats or delays must not pass for news."""
        last = self._reported
        if last is not None and not 1 <= wire.sequence_distance(sequence, last) < _AHEAD:
            return False
        self._reported = sequence
        return True

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
            if self._unanswered >= UNANSWERED:
                self._greet(self.reason)  # a board that was reset unheard obeys nothing before it is greeted
                return self._ask(messages.Hello(), now)
            return self._ask(self._configure, now)
        return b""

    def _ask(self, question: messages.Hello | messages.Configure, now: float) -> bytes:
        if self._question is not None:
            self.resends += 1
            self._count_unanswered()
        self._asked_at = now
        frame = self._numbered(question)
        self._question = self._sequence
        return frame

    def _count_unanswered(self) -> None:
        self._unanswered += 1
        if self.state is LinkState.GREETING and self._unanswered == UNANSWERED:
            self.reason = reasons.no_answer(self._has_heard_noise)

    def drive(self, command: DriveCommand, now: float) -> bytes:
        if self.state is not LinkState.READY:
            raise LinkError(f"the board is not ready: {self.reason}")
        if command.start_heading is None:
            self._refuse_if_late(now)
        frame = self._numbered(conversion.drive_message(command, self.configuration))
        if command.start_heading is not None:
            self.incident = ""
            self.echoes.begin()
        self.echoes.sent(self._sequence, now)
        return frame

    def _refuse_if_late(self, now: float) -> None:
        late = self.echoes.unheard(now)
        if not late <= LATE:
            raise LinkError(reasons.hears_late(late, LATE))

    def stop(self) -> bytes:
        return self._numbered(messages.Stop())

    def _numbered(self, message: messages.Message) -> bytes:
        """The next number is taken only when the message has been encoded."""
        sequence = (self._sequence + 1) % wire.SEQUENCE_MODULUS or 1
        frame = wire.encode(message, sequence, self.boot_id)
        self._sequence = sequence
        return frame


def _version(banner: messages.Banner) -> str:
    return ".".join(str(number) for number in banner.firmware)
