"""Writes an MCAP file (https://mcap.dev/spec) chunk by chunk, such that whatever ends it, what was written is readable.

The records' bytes are those of the public library, but for messages, of which there are hundreds a second. Its
`Writer` closes a chunk by size and keeps to itself where the last whole one ended; a recording closes them by time,
and has to go back there when a disk fails in the middle of one.
"""

from __future__ import annotations

import contextlib
import os
import struct
import zlib
from collections.abc import Iterable
from dataclasses import dataclass, field

import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    MessageIndex,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

from server.recording.writing.disk import DiskFile

MAGIC = bytes((137, 77, 67, 65, 80, 48, 13, 10))
MESSAGE = struct.Struct("<BQHIQQ")
"""Opcode, length of what follows, channel, sequence, log time, publish time."""
HEAD = 9
"""Bytes of a record before its content: opcode and length."""
FOOTER = struct.Struct("<BQQQ")
"""What of the footer its own checksum covers: opcode, length, start of the summary and of its offsets."""
LEVEL = 1
"""Of zstd: a chunk of pictures and ticks in 2 ms; level 3 takes twice that for 2 % less."""

Index = dict[int, list[tuple[int, int]]]
"""By channel: log time (UTC, ns) of each message, and where it stands in its chunk, bytes."""


@dataclass(slots=True)
class OpenChunk:
    """Messages that are not in the file yet. start, end: log times of the first and the last one, UTC ns."""

    parts: list[bytes] = field(default_factory=list)
    size: int = 0
    start: int = 0
    end: int = 0
    messages: int = 0
    index: Index = field(default_factory=dict)

    def put(self, record: bytes) -> None:
        """A schema or a channel."""
        self.parts.append(record)
        self.size += len(record)

    def add(self, channel: int, sequence: int, times: tuple[int, int], data: bytes) -> None:
        """times: log and publish time, UTC ns."""
        log_time, publish_time = times
        self.index.setdefault(channel, []).append((log_time, self.size))
        length = len(data) + MESSAGE.size - HEAD
        self.put(MESSAGE.pack(Opcode.MESSAGE, length, channel, sequence, log_time, publish_time))
        self.put(data)
        self.start = min(self.start, log_time) if self.messages else log_time
        self.end = max(self.end, log_time)
        self.messages += 1


@dataclass(slots=True)
class Summary:
    """What the end of the file tells of the rest."""

    schemas: list[Schema] = field(default_factory=list)
    channels: list[Channel] = field(default_factory=list)
    chunks: list[bytes] = field(default_factory=list)
    """Their indexes, packed: a day has 350 000 of them."""
    start: int = 0
    end: int = 0
    attachments: list[AttachmentIndex] = field(default_factory=list)
    metadata: list[MetadataIndex] = field(default_factory=list)
    counts: dict[int, int] = field(default_factory=dict)

    def add(self, index: ChunkIndex) -> None:
        """One more chunk."""
        if self.chunks:
            self.start = min(self.start, index.message_start_time)
        else:
            self.start = index.message_start_time
        self.end = max(self.end, index.message_end_time)
        self.chunks.append(bytes_of(index))

    def statistics(self) -> Statistics:
        return Statistics(
            attachment_count=len(self.attachments),
            channel_count=len(self.channels),
            channel_message_counts={id: count for id, count in self.counts.items() if count},
            chunk_count=len(self.chunks),
            message_count=sum(self.counts.values()),
            message_end_time=self.end,
            message_start_time=self.start,
            metadata_count=len(self.metadata),
            schema_count=len(self.schemas),
        )

    def groups(self) -> Iterable[tuple[Opcode, Iterable[bytes]]]:
        """The records of each kind, packed."""
        yield Opcode.SCHEMA, map(bytes_of, self.schemas)
        yield Opcode.CHANNEL, map(bytes_of, self.channels)
        yield Opcode.STATISTICS, [bytes_of(self.statistics())]
        yield Opcode.CHUNK_INDEX, self.chunks
        yield Opcode.ATTACHMENT_INDEX, map(bytes_of, self.attachments)
        yield Opcode.METADATA_INDEX, map(bytes_of, self.metadata)


class McapWriter:
    """One file; everything raises OSError where the disk does, and then the file is as it was before the call.

    size: of what is whole in the file, bytes.
    """

    def __init__(self, file: DiskFile, library: str) -> None:
        self._file = file
        self._compressor = zstandard.ZstdCompressor(level=LEVEL)
        self._chunk = OpenChunk()
        self._sequences: dict[int, int] = {}
        self._crc = 0
        self._is_torn = False
        self.summary = Summary()
        self.size = 0
        self._write(MAGIC + bytes_of(Header("", library)))

    @property
    def waiting(self) -> int:
        """Bytes of messages in the open chunk."""
        return self._chunk.size if self._chunk.messages else 0

    def register(self, topic: str, schema_name: str, schema: bytes) -> int:
        """A channel of JSON messages and its schema; returns the channel's id."""
        id = len(self.summary.channels) + 1
        self.summary.schemas.append(Schema(id=id, name=schema_name, encoding="jsonschema", data=schema))
        self.summary.channels.append(
            Channel(id=id, topic=topic, message_encoding="json", schema_id=id, metadata={})
        )
        self._chunk.put(bytes_of(self.summary.schemas[-1]))
        self._chunk.put(bytes_of(self.summary.channels[-1]))
        self._sequences[id] = 0
        return id

    def add(self, channel: int, log_time: int, publish_time: int, data: bytes) -> None:
        """A message into the open chunk. Times: UTC ns."""
        sequence = self._sequences[channel] = self._sequences[channel] + 1
        self._chunk.add(channel, sequence, (log_time, publish_time), data)

    def flush(self) -> None:
        """The open chunk into the file; messages of a chunk that the disk did not take are lost."""
        chunk = self._chunk
        if not chunk.messages:
            return
        self._chunk = OpenChunk()
        record = self._compressed(chunk)
        self.append(record, bytes_of(record), chunk.index)

    def append(self, record: Chunk, packed: bytes, index: Index) -> None:
        """A chunk, packed as it stands in a file. index: the messages in it by channel."""
        indexes, offsets = _indexes(index, self.size + len(packed))
        at = self.size
        self._write(packed + indexes)
        self.summary.add(_chunk_index(record, at, len(packed), offsets, len(indexes)))
        for channel, entries in index.items():
            self.summary.counts[channel] = self.summary.counts.get(channel, 0) + len(entries)

    def attach(self, name: str, media_type: str, data: bytes, time: int) -> None:
        """time: UTC ns."""
        record = Attachment(create_time=time, log_time=time, name=name, media_type=media_type, data=data)
        at, packed = self.size, bytes_of(record)
        self._write(packed)
        self.summary.attachments.append(
            AttachmentIndex(
                offset=at,
                length=len(packed),
                log_time=time,
                create_time=time,
                data_size=len(data),
                name=name,
                media_type=media_type,
            )
        )

    def describe(self, name: str, values: dict[str, str]) -> None:
        """A metadata record."""
        at, packed = self.size, bytes_of(Metadata(name=name, metadata=values))
        self._write(packed)
        self.summary.metadata.append(MetadataIndex(offset=at, length=len(packed), name=name))

    def finish(self) -> None:
        """Flush, and write the summary: the file is whole. It stays open."""
        self.flush()
        end = bytes_of(DataEnd(self._crc))
        start = self.size + len(end)
        summary, offset_start = _packed_summary(self.summary, start)
        crc = zlib.crc32(FOOTER.pack(Opcode.FOOTER, 20, start, offset_start), zlib.crc32(summary))
        footer = Footer(summary_start=start, summary_offset_start=offset_start, summary_crc=crc)
        self._write(end + summary + bytes_of(footer) + MAGIC)

    def _compressed(self, chunk: OpenChunk) -> Chunk:
        data = b"".join(chunk.parts)
        return Chunk(
            compression="zstd",
            data=self._compressor.compress(data),
            message_end_time=chunk.end,
            message_start_time=chunk.start,
            uncompressed_crc=zlib.crc32(data),
            uncompressed_size=len(data),
        )

    def _write(self, data: bytes) -> None:
        """All of it, or the file is cut to what it was and the error raised."""
        try:
            if self._is_torn:
                self._cut()
            self._file.write(data)
        except OSError:
            self._is_torn = True
            with contextlib.suppress(OSError):  # else before anything else is written
                self._cut()
            raise
        self.size += len(data)
        self._crc = zlib.crc32(data, self._crc)

    def _cut(self) -> None:
        """Back to what is whole."""
        os.ftruncate(self._file.fileno(), self.size)
        os.lseek(self._file.fileno(), self.size, os.SEEK_SET)
        self._is_torn = False


def bytes_of(record: McapRecord) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    return builder.end()


def _indexes(index: Index, at: int) -> tuple[bytes, dict[int, int]]:
    """The message indexes that follow a chunk at `at`, and where that of each channel stands."""
    parts: list[bytes] = []
    offsets: dict[int, int] = {}
    for channel, entries in index.items():
        offsets[channel] = at
        parts.append(_message_index(channel, entries))
        at += len(parts[-1])
    return b"".join(parts), offsets


def _message_index(channel: int, entries: list[tuple[int, int]]) -> bytes:
    return bytes_of(MessageIndex(channel_id=channel, records=entries))


def _chunk_index(chunk: Chunk, at: int, length: int, offsets: dict[int, int], indexes: int) -> ChunkIndex:
    return ChunkIndex(
        chunk_length=length,
        chunk_start_offset=at,
        compression=chunk.compression,
        compressed_size=len(chunk.data),
        message_end_time=chunk.message_end_time,
        message_index_length=indexes,
        message_index_offsets=offsets,
        message_start_time=chunk.message_start_time,
        uncompressed_size=chunk.uncompressed_size,
    )


def _packed_summary(summary: Summary, start: int) -> tuple[bytes, int]:
    """The summary that stands at `start`, and where its own table of contents begins."""
    parts: list[bytes] = []
    offsets: list[bytes] = []
    at = start
    for opcode, group in summary.groups():
        packed = b"".join(group)
        if packed:
            parts.append(packed)
            offsets.append(bytes_of(SummaryOffset(opcode, at, len(packed))))
            at += len(packed)
    return b"".join(parts + offsets), at
