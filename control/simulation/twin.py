"""The firmware's behaviour, once, in the integer arithmetic of an 8-bit microcontroller: bytes in, bytes out.

No clock, no port: `tick` is one millisecond.  The C++ firmware is to match this byte for byte.
"""

from __future__ import annotations

from control.link import messages, wire
from control.link.board_limits import objections
from control.link.messages import BoardCode, Flag, Refusal
from control.simulation.coil_drive import CoilDrive
from control.simulation.motion import FieldMotion, signed

FIRMWARE_VERSION = (0, 1, 0)
TELEMETRY_PERIOD = 10
"""Milliseconds between two reports."""

TRANSMIT_BUFFER = 255
"""Bytes waiting to be sent, at most, in a ring of 256; a message that finds no room is dropped."""

_DRIVING = BoardCode.DRIVING
_U16 = 0xFFFF
_U32 = 0xFFFFFFFF


class FirmwareTwin:
    """One boot of the board; a reset is a new object with a new boot id."""

    def __init__(self, boot_id: int, reset_cause: messages.ResetCause = messages.ResetCause.POWER_ON) -> None:
        self.boot_id = boot_id
        self.state = BoardCode.BOOTED
        self.driver_fault = False
        self._reset_cause = reset_cause
        self._decoder = wire.Decoder()
        self._outgoing = bytearray()
        self._greeted = False
        self._configuration: messages.Configure | None = None
        self._hash = 0
        self._dead_man = 0
        self.motion = FieldMotion()
        self.coils = CoilDrive()
        self._latched = 0
        self._life = 0
        self._milliseconds = 0
        self._until_telemetry = TELEMETRY_PERIOD
        self._last_sequence = self._telemetry_sequence = 0
        self._good = self._refused = self._stale = 0
        self._last_refusal = Refusal.NONE
        self._send_banner(0)

    # ---- bytes

    def receive(self, data: bytes) -> None:
        for packet in self._decoder.feed(data):
            self._obey(packet)

    def transmit(self, most: int) -> bytes:
        """Takes up to `most` bytes from the outgoing buffer."""
        taken = bytes(self._outgoing[:most])
        del self._outgoing[:most]
        return taken

    @property
    def is_sending(self) -> bool:
        return bool(self._outgoing)

    @property
    def duty(self) -> messages.Triple:
        """PWM of the three bridges, signed steps of `PWM_STEPS`."""
        return self.coils.duty

    # ---- messages

    def _obey(self, packet: wire.Packet) -> None:
        message = packet.message
        if isinstance(message, messages.Hello):
            self._greet(packet)
        elif isinstance(message, messages.Stop):
            self._stop(packet.sequence)
        elif isinstance(message, (messages.Drive, messages.Configure)):
            self._obey_in_sequence(packet, message)
        else:
            self._refuse(Refusal.DIRECTION)

    def _greet(self, packet: wire.Packet) -> None:
        """Answers; another version is answered too, so that both sides can say what is wrong."""
        self._send_banner(packet.sequence)
        if packet.version != wire.PROTOCOL_VERSION:
            self._refuse(Refusal.VERSION)
            return
        if self.state == BoardCode.FAULT:
            self._configuration = None
            self._hash = 0
        self._become(BoardCode.READY if self._configuration else BoardCode.BOOTED)
        self._latched = 0
        self._greeted = True
        self._last_sequence = packet.sequence
        self._count_good()

    def _stop(self, sequence: int) -> None:
        if self.state not in (BoardCode.BOOTED, BoardCode.FAULT):
            self._become(BoardCode.STOPPED)
        if self._is_fresh(sequence):
            self._last_sequence = sequence
        self._count_good()

    def _obey_in_sequence(self, packet: wire.Packet, message: messages.Drive | messages.Configure) -> None:
        if packet.boot_id != self.boot_id:
            self._refuse(Refusal.BOOT_ID)
        elif not self._is_fresh(packet.sequence):
            self._stale = (self._stale + 1) & _U16
            self._last_refusal = Refusal.SEQUENCE
        else:
            self._last_sequence = packet.sequence  # a refused number is used up: it cannot be replayed later
            if isinstance(message, messages.Configure):
                self._configure(packet.sequence, message)
            else:
                self._drive(message)

    def _is_fresh(self, sequence: int) -> bool:
        return 1 <= wire.sequence_distance(sequence, self._last_sequence) <= wire.SEQUENCE_WINDOW

    def _count_good(self) -> None:
        self._good = (self._good + 1) & _U16

    def _refuse(self, reason: Refusal) -> None:
        self._refused = (self._refused + 1) & _U16
        self._last_refusal = reason

    def _configure(self, sequence: int, message: messages.Configure) -> None:
        if not self._greeted or self.state in (BoardCode.DRIVING, BoardCode.FAULT):
            self._refuse(Refusal.STATE)
            return
        if any(objections(message)):
            self._refuse(Refusal.CONFIGURATION)
            return
        self._count_good()
        self._take_over(message)
        self._become(BoardCode.READY)
        self._send_banner(sequence)

    def _take_over(self, message: messages.Configure) -> None:
        self._configuration = message
        self._hash = wire.configuration_hash(message)
        self._dead_man = message.dead_man
        self.motion.configure(message.ramp, message.field_slew)
        self.coils.configure(message)

    def _drive(self, message: messages.Drive) -> None:
        refusal = self._objection(message)
        if refusal != Refusal.NONE:
            self._refuse(refusal)
            return
        self._count_good()
        if message.flags & messages.ARM:
            self._become(BoardCode.DRIVING)
            self.motion.start(message)
        else:
            self.motion.follow(message)
        self.coils.allocate(message.allocation)
        self._life = min(message.time_to_live, self._dead_man)

    def _objection(self, message: messages.Drive) -> Refusal:
        """Why this drive may not be obeyed; values out of range are refused, never clipped."""
        limits = self._configuration
        arms = bool(message.flags & messages.ARM)
        if limits is None or self.state == BoardCode.FAULT or (self.state != BoardCode.DRIVING and not arms):
            return Refusal.STATE
        allowed = (
            (message.flags in (0, messages.ARM), Refusal.FLAGS),
            (message.pivot in (1, -1), Refusal.PIVOT),
            (-limits.max_rate <= message.rate <= limits.max_rate, Refusal.RATE),
            (message.tilt <= limits.max_tilt, Refusal.TILT),
            (message.field <= limits.max_field, Refusal.FIELD),
            (message.time_to_live >= 1, Refusal.LIFETIME),
        )
        return next((refusal for holds, refusal in allowed if not holds), Refusal.NONE)

    # ---- one millisecond

    def tick(self, counts: messages.Triple, supply_count: int) -> messages.Triple:
        """One millisecond: ADC readings of the unsigned current senses and of the supply in, PWM steps out."""
        self._milliseconds = (self._milliseconds + 1) & _U32
        self.coils.sense(counts, supply_count)
        if self.state is _DRIVING:
            self._check_life_and_coils()
        if self.state is _DRIVING:
            self.motion.advance()
            self.coils.advance(self.motion)
        else:
            self.coils.coast()
        if self._greeted:
            self._until_telemetry -= 1
            if self._until_telemetry <= 0:
                self._until_telemetry = TELEMETRY_PERIOD
                self._send_telemetry()
        return self.coils.duty

    def _check_life_and_coils(self) -> None:
        self._life -= 1
        over_current = self.coils.is_over_current()
        if over_current or self.driver_fault:
            self._latched |= int(Flag.OVER_CURRENT if over_current else Flag.DRIVER_FAULT)
            self._become(BoardCode.FAULT)
        elif self._life <= 0:
            self._become(BoardCode.EXPIRED)

    def _become(self, state: BoardCode) -> None:
        """Every change of state starts from zero output."""
        self.state = state
        self.motion.rest()
        self.coils.rest()

    # ---- replies

    def _send(self, message: messages.Message, sequence: int) -> None:
        frame = wire.encode(message, sequence, self.boot_id)
        if len(self._outgoing) + len(frame) <= TRANSMIT_BUFFER:
            self._outgoing += frame

    def _send_banner(self, sequence: int) -> None:
        self._send(messages.Banner(FIRMWARE_VERSION, self._reset_cause, self._hash), sequence)

    def _send_telemetry(self) -> None:
        self._telemetry_sequence = (self._telemetry_sequence + 1) & _U16
        motion = self.motion
        message = messages.Telemetry(
            time=self._milliseconds,
            heading=motion.heading,
            elevation=signed(motion.elevation) >> 16,
            commanded=self.coils.commanded,
            measured=self.coils.measured(),
            duty=self.coils.duty_q15(),
            supply=self.coils.supply,
            state=self.state,
            flags=self._flags(),
            last_sequence=self._last_sequence,
            good=self._good,
            bad=self._decoder.dropped & _U16,
            refused=self._refused,
            stale=self._stale,
            last_refusal=self._last_refusal,
            configuration_hash=self._hash,
        )
        self._send(message, self._telemetry_sequence)

    def _flags(self) -> int:
        coils = self.coils
        conditions = (
            (coils.saturated, Flag.SATURATED),
            (coils.supply_low, Flag.SUPPLY_LOW),
            (coils.supply_assumed, Flag.SUPPLY_ASSUMED),
        )
        return self._latched | sum(flag for holds, flag in conditions if holds)
