"""The records of an MCAP file as far as a reader of recordings needs them: bytes in, values or `Damaged` out.

No file, no clock. The format is that of https://mcap.dev/spec: a record is an opcode (1 byte), a length
(8 bytes) and its content; numbers are little-endian; strings, maps and arrays carry their length in bytes.
The public `mcap` library reads what it is promised; this one reads what a killed process leaves behind.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import zstandard

from server.recording.reading.byte_source import Damaged

MAGIC = bytes((137, 77, 67, 65, 80, 48, 13, 10))
HEAD = struct.Struct("<BQ")
"""Opcode and length of a record."""
FOOTER = struct.Struct("<QQI")
CHUNK_HEAD = struct.Struct("<QQQI")
CHUNK_INDEX_HEAD = struct.Struct("<QQQQ")
MESSAGE_HEAD = struct.Struct("<BQHIQQ")
"""Of the record and of the message: opcode, length, channel, sequence, log time, publish time."""
OFFSET_OF_CHANNEL = struct.Struct("<HQ")
INTEGER = struct.Struct("<I")
LONG = struct.Struct("<Q")
SHORT = struct.Struct("<H")

CHUNK_LIMIT = 64 << 20
"""Uncompressed bytes of a chunk that are believed: a quarter of a second of the largest pictures is 30 MB."""
SHRINKS_AT_MOST = 1000
"""Times that compression makes a chunk smaller; ticks of a robot that stands still come to about 30."""
CHUNK_SMALL = 1 << 20
"""A claim up to this many bytes is believed whatever the compression says."""


class Opcode:
    """Plain numbers, since they are compared millions of times."""

    HEADER: Final = 0x01
    FOOTER: Final = 0x02
    SCHEMA: Final = 0x03
    CHANNEL: Final = 0x04
    MESSAGE: Final = 0x05
    CHUNK: Final = 0x06
    MESSAGE_INDEX: Final = 0x07
    CHUNK_INDEX: Final = 0x08
    ATTACHMENT: Final = 0x09
    ATTACHMENT_INDEX: Final = 0x0A
    METADATA: Final = 0x0C
    METADATA_INDEX: Final = 0x0D
    DATA_END: Final = 0x0F


@dataclass(frozen=True, slots=True)
class Schema:
    id: int
    name: str
    encoding: str
    data: bytes = field(repr=False)


@dataclass(frozen=True, slots=True)
class Channel:
    id: int
    schema_id: int
    topic: str
    encoding: str
    metadata: dict[str, str] = field(default_factory=dict)


class Place(NamedTuple):
    """Where a record stands in the file: from its opcode on, head included, bytes. name: of what is stored there."""

    offset: int
    length: int
    name: str = ""


class ChunkPlace(NamedTuple):
    """A chunk of the file. start, end: log times of its messages, ns.  channels: what it holds, None if unknown."""

    offset: int
    length: int
    start: int
    end: int
    channels: frozenset[int] | None = None


class Message(NamedTuple):
    """data: as it was written, encoded as its channel says.  Times: UTC, ns.

    at: where the record stands in its chunk, bytes.  A tuple, since an hour has millions.
    """

    channel_id: int
    sequence: int
    log_time: int
    publish_time: int
    data: bytes
    at: int


@dataclass(frozen=True, slots=True)
class Attachment:
    log_time: int
    create_time: int
    name: str
    media_type: str
    data: bytes = field(repr=False)


class Cursor:
    """Takes one value after the other from bytes; what is not there raises `Damaged`."""

    def __init__(self, data: bytes, at: int = 0, end: int | None = None) -> None:
        self.data = data
        self.at = at
        self.end = len(data) if end is None else end

    def take(self, length: int) -> bytes:
        start = self._step(length)
        return self.data[start : self.at]

    def _step(self, length: int) -> int:
        start = self.at
        if not 0 <= length <= self.end - start:
            raise Damaged(f"a length of {length} where {self.end - start} bytes are left")
        self.at = start + length
        return start

    def values(self, layout: struct.Struct) -> tuple[int, ...]:
        return layout.unpack_from(self.data, self._step(layout.size))

    def short(self) -> int:
        return self.values(SHORT)[0]

    def integer(self) -> int:
        return self.values(INTEGER)[0]

    def long(self) -> int:
        return self.values(LONG)[0]

    def text(self) -> str:
        raw = self.take(self.integer())
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError as error:
            raise Damaged(f"a text that is not UTF-8: {error.reason}") from None

    def strings(self) -> dict[str, str]:
        inside = Cursor(self.take(self.integer()))
        found: dict[str, str] = {}
        while inside.at < inside.end:
            key = inside.text()
            found[key] = inside.text()
        return found


def records(data: bytes) -> Iterator[tuple[int, Cursor]]:
    """Opcode and content of each record in `data`, which must be filled by whole records."""
    at, size = 0, len(data)
    while at < size:
        opcode, content = record(data, at)
        yield opcode, content
        at = content.end


def record(data: bytes, at: int) -> tuple[int, Cursor]:
    """Opcode and content of the record that begins there."""
    left = len(data) - at - HEAD.size
    if left < 0:
        raise Damaged(f"{len(data) - at} bytes are no record")
    opcode, length = HEAD.unpack_from(data, at)
    if length > left:
        raise Damaged(f"a record of {length} bytes where {left} are left")
    start = at + HEAD.size
    return opcode, Cursor(data, start, start + length)


def in_chunk(data: bytes) -> tuple[list[Message], list[tuple[int, Cursor]]]:
    """The messages of an unpacked chunk, in its order, and the records beside them."""
    messages: list[Message] = []
    others: list[tuple[int, Cursor]] = []
    at, size, head = 0, len(data), MESSAGE_HEAD.size
    unpack = MESSAGE_HEAD.unpack_from
    while at < size:
        if data[at] == Opcode.MESSAGE and at + head <= size:
            _, length, channel_id, sequence, log_time, publish_time = unpack(data, at)
            end = at + HEAD.size + length
            if not at + head <= end <= size:
                raise Damaged(f"a message of {length} bytes where {size - at - HEAD.size} are left")
            messages.append(Message(channel_id, sequence, log_time, publish_time, data[at + head : end], at))
            at = end
        else:
            others.append(record(data, at))
            at = others[-1][1].end
    return messages, others


def schema(content: Cursor) -> Schema:
    id = content.short()
    name, encoding = content.text(), content.text()
    return Schema(id, name, encoding, content.take(content.integer()))


def channel(content: Cursor) -> Channel:
    id, schema_id = content.short(), content.short()
    topic, encoding = content.text(), content.text()
    return Channel(id, schema_id, topic, encoding, content.strings())


def chunk_index(content: Cursor) -> ChunkPlace:
    start, end, offset, length = content.values(CHUNK_INDEX_HEAD)
    places = content.take(content.integer())
    if len(places) % OFFSET_OF_CHANNEL.size:
        raise Damaged(f"an index of {len(places)} bytes, which is no whole number of entries")
    held = frozenset([id for id, _ in OFFSET_OF_CHANNEL.iter_unpack(places)])
    return ChunkPlace(offset, length, start, end, held or None)


def attachment_index(content: Cursor) -> Place:
    offset, length = content.long(), content.long()
    content.take(3 * LONG.size)  # its times and its size, which the attachment itself says as well
    return Place(offset, length, content.text())


def metadata_index(content: Cursor) -> Place:
    offset, length = content.long(), content.long()
    return Place(offset, length, content.text())


def metadata(content: Cursor) -> tuple[str, dict[str, str]]:
    return content.text(), content.strings()


def attachment(content: Cursor) -> Attachment:
    """Raises `Damaged` where its checksum says that it is not as it was written."""
    begin = content.at
    log_time, create_time = content.long(), content.long()
    name, media_type = content.text(), content.text()
    data = content.take(content.long())
    _check_sum(content.data[begin : content.at], content.integer(), f"attachment {name!r}")
    return Attachment(log_time, create_time, name, media_type, data)


def chunk(content: Cursor) -> bytes:
    """The records inside a chunk, decompressed and checked; never more memory than `CHUNK_LIMIT`."""
    _, _, size, check_sum = content.values(CHUNK_HEAD)
    compression = content.text()
    packed = content.take(content.long())
    if not size <= min(CHUNK_LIMIT, max(CHUNK_SMALL, SHRINKS_AT_MOST * len(packed))):
        raise Damaged(f"a chunk of {len(packed)} bytes that claims to hold {size}")
    data = _unpacked(compression, packed, size)
    if len(data) != size:
        raise Damaged(f"a chunk of {len(data)} bytes that claims {size}")
    _check_sum(data, check_sum, "a chunk")
    return data


def _unpacked(compression: str, packed: bytes, size: int) -> bytes:
    if compression == "":
        return packed
    if compression != "zstd":
        raise Damaged(f"a compression {compression!r}; recordings are written with zstd")
    try:
        # The decompressor takes at once what the frame itself claims, whatever limit it is given.
        claimed = zstandard.get_frame_parameters(packed).content_size
        if claimed not in (size, zstandard.CONTENTSIZE_UNKNOWN):
            raise Damaged(f"compressed data of {claimed} bytes in a chunk that claims {size}")
        return zstandard.ZstdDecompressor().decompress(packed, max_output_size=max(size, 1))
    except zstandard.ZstdError as error:
        raise Damaged(f"compressed data that cannot be read: {error}") from None


def _check_sum(data: bytes, expected: int, of: str) -> None:
    """0 is written for a checksum that was not made."""
    found = zlib.crc32(data)
    if expected not in (0, found):
        raise Damaged(f"{of} has the checksum {found:08x} instead of {expected:08x}")
