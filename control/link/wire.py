"""Messages to and from the board as framed bytes: values in, bytes out and back, with no port and no clock.

A frame is 0x00, the COBS encoding of (payload, CRC-16), 0x00.  The payload is a header (type u8, version u8,
sequence u16, boot id u16) and a body; all integers are little-endian; the CRC has polynomial 0x1021 and
starts at 0xFFFF.  The layouts of Hello and Banner never change, so two versions can tell each other apart.
"""

from __future__ import annotations

import struct
from binascii import crc_hqx
from collections.abc import Iterator
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

from cobs import cobs

from control.link.messages import Banner, Configure, Drive, Hello, Message, Stop, Telemetry

PROTOCOL_VERSION = 1
SEQUENCE_MODULUS = 1 << 16
SEQUENCE_WINDOW = 1000
"""How far a sequence number may run ahead of the last accepted one: about 16 s of lost messages at 60 Hz."""

LONGEST_FRAME = 64
"""Bytes between two delimiters, at most: the configuration's 57, and what the board's decoder has room for."""


class WireError(ValueError):
    """A value does not fit its field on the wire."""


@dataclass(frozen=True, slots=True)
class Packet:
    """A message and its header."""

    version: int
    sequence: int
    boot_id: int
    message: Message


class Layout:
    """How the body of one message type lies in bytes: (field name, struct format) in order."""

    def __init__(self, code: int, message: type[Message], fields: tuple[tuple[str, str], ...]) -> None:
        self.code = code
        self.message: Any = message
        self.fields = fields
        self.format = struct.Struct("<" + "".join(kind for _, kind in fields))
        self._readers = [(attrgetter(name), kind, len(kind) > 1) for name, kind in fields]
        self._places: list[int | slice] = []
        start = 0
        for _, kind in fields:
            width = int(kind[:-1] or 1)
            self._places.append(start if width == 1 else slice(start, start + width))
            start += width

    def pack(self, message: Message) -> bytes:
        flat: list[int] = []
        for read, _, is_vector in self._readers:
            if is_vector:
                flat += read(message)
            else:
                flat.append(read(message))
        try:
            return self.format.pack(*flat)
        except struct.error as error:
            wrong = ", ".join(self._misfits(message))
            raise WireError(f"{wrong} in {message!r} does not fit the wire: {error}") from error

    def unpack(self, body: bytes) -> Message:
        values = self.format.unpack(body)
        return self.message(*[values[place] for place in self._places])

    def _misfits(self, message: Message) -> Iterator[str]:
        for read, kind, is_vector in self._readers:
            value = read(message)
            try:
                struct.pack("<" + kind, *(value if is_vector else (value,)))
            except struct.error:
                yield repr(value)


LAYOUTS = (
    Layout(1, Hello, ()),
    Layout(2, Banner, (("firmware", "3B"), ("reset_cause", "B"), ("configuration_hash", "H"))),
    Layout(
        3,
        Configure,
        (
            *(("current_limits", "3H"), ("dead_man", "H"), ("ramp", "H"), ("field_slew", "H")),
            *(("resistances", "3H"), ("inductances", "3H"), ("supply", "H")),
            *(("max_field", "H"), ("max_rate", "I"), ("max_tilt", "H")),
            *(("sense_gains", "6H"), ("supply_scale", "H")),
        ),
    ),
    Layout(
        4,
        Drive,
        (
            *(("flags", "B"), ("pivot", "b"), ("rate", "i"), ("heading_goal", "I"), ("start_heading", "I")),
            *(("tilt", "H"), ("field", "H"), ("allocation", "9h"), ("time_to_live", "H")),
        ),
    ),
    Layout(5, Stop, ()),
    Layout(
        6,
        Telemetry,
        (
            *(("time", "I"), ("heading", "I"), ("elevation", "h")),
            *(("commanded", "3h"), ("measured", "3h"), ("duty", "3h"), ("supply", "H")),
            *(("state", "B"), ("flags", "H"), ("last_sequence", "H")),
            *(("good", "H"), ("bad", "H"), ("refused", "H"), ("stale", "H")),
            *(("last_refusal", "B"), ("configuration_hash", "H")),
        ),
    ),
)
_BY_MESSAGE = {layout.message: layout for layout in LAYOUTS}
_BY_CODE = {layout.code: layout for layout in LAYOUTS}
HEADER = struct.Struct("<BBHH")
_CRC = struct.Struct("<H")
_SHORTEST = HEADER.size + _CRC.size


def encode(message: Message, sequence: int, boot_id: int, version: int = PROTOCOL_VERSION) -> bytes:
    """The frame of one message, delimiters included; WireError when a value does not fit its field."""
    layout = _BY_MESSAGE[type(message)]
    try:
        payload = HEADER.pack(layout.code, version, sequence, boot_id) + layout.pack(message)
    except struct.error as error:
        received = f"version {version!r}, sequence {sequence!r}, boot id {boot_id!r}"
        raise WireError(f"{received}: the header takes a u8 and two u16 ({error})") from error
    return b"\0" + cobs.encode(payload + _CRC.pack(crc_hqx(payload, 0xFFFF))) + b"\0"


def configuration_hash(configure: Configure) -> int:
    """CRC of the configuration as it travels; 0 is kept for a board that has none."""
    return crc_hqx(_BY_MESSAGE[Configure].pack(configure), 0xFFFF) or 1


def sequence_distance(later: int, earlier: int) -> int:
    """How far `later` is ahead of `earlier`, 0..65535."""
    return (later - earlier) % SEQUENCE_MODULUS


class Decoder:
    """Bytes in, packets out, however the stream is cut; what is broken is counted and never raises."""

    def __init__(self) -> None:
        self.bad_cobs = 0
        self.bad_crc = 0
        self.oversize = 0
        self.wrong_length = 0
        self.unknown_type = 0
        self.wrong_version = 0
        self._partial = b""
        self._skipping = False

    @property
    def dropped(self) -> int:
        """Frames that yielded no packet."""
        broken = self.bad_cobs + self.bad_crc + self.oversize + self.wrong_length
        return broken + self.unknown_type + self.wrong_version

    def restart(self) -> None:
        """Forgets the frame that is coming in, for a line that begins anew; the counts go on."""
        self._partial = b""
        self._skipping = False

    def feed(self, data: bytes) -> list[Packet]:
        *complete, rest = (self._partial + data).split(b"\0")
        packets = [packet for frame in complete if (packet := self._finish(frame)) is not None]
        self._keep(rest)
        return packets

    def _keep(self, rest: bytes) -> None:
        if len(rest) > LONGEST_FRAME and not self._skipping:
            self.oversize += 1
            self._skipping = True
        self._partial = b"" if self._skipping else rest

    def _finish(self, frame: bytes) -> Packet | None:
        if self._skipping:
            self._skipping = False
            return None
        if not frame:
            return None
        if len(frame) > LONGEST_FRAME:
            self.oversize += 1
            return None
        return self._open(frame)

    def _open(self, frame: bytes) -> Packet | None:
        try:
            data = cobs.decode(frame)
        except cobs.DecodeError:
            self.bad_cobs += 1
            return None
        if len(data) < _SHORTEST:
            self.wrong_length += 1
            return None
        payload = data[: -_CRC.size]
        if _CRC.unpack(data[-_CRC.size :])[0] != crc_hqx(payload, 0xFFFF):
            self.bad_crc += 1
            return None
        return self._read(payload)

    def _read(self, payload: bytes) -> Packet | None:
        code, version, sequence, boot_id = HEADER.unpack_from(payload)
        layout = _BY_CODE.get(code)
        if layout is None:
            self.unknown_type += 1
            return None
        if version != PROTOCOL_VERSION and layout.message not in (Hello, Banner):
            self.wrong_version += 1
            return None
        if len(payload) != HEADER.size + layout.format.size:
            self.wrong_length += 1
            return None
        return Packet(version, sequence, boot_id, layout.unpack(payload[HEADER.size :]))
