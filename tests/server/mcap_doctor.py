"""Looks a file over as `mcap doctor` does, by the public library: everything that it says of itself has to hold."""

from __future__ import annotations

import struct
import zlib
from collections import Counter
from pathlib import Path

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
    Message,
    MessageIndex,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.stream_reader import StreamReader, breakup_chunk

MAGIC = b"\x89MCAP0\r\n"
HEAD = struct.Struct("<BQ")
BEFORE_DATA = 22
"""Bytes of a message before its data: channel, sequence, log time, publish time."""


def placed(path: Path) -> list[tuple[int, int, McapRecord]]:
    """Where each record begins, how long it is with its head, and the record."""
    data = path.read_bytes()
    assert data.startswith(MAGIC)
    assert data.endswith(MAGIC)
    with path.open("rb") as file:
        records = list(StreamReader(file, emit_chunks=True, validate_crcs=True).records)
    found, at = [], len(MAGIC)
    for record in records:
        _, length = HEAD.unpack_from(data, at)
        found.append((at, length + HEAD.size, record))
        at += length + HEAD.size
    assert at == len(data) - len(MAGIC)
    return found


def examine(path: Path) -> Statistics:
    """Asserts that the file is sound; its statistics."""
    records = placed(path)
    assert isinstance(records[0][2], Header)
    assert isinstance(records[-1][2], Footer)
    end = next(index for index, (_, _, record) in enumerate(records) if isinstance(record, DataEnd))
    body, summary = records[:end], records[end + 1 : -1]
    _check_data_crc(path, records[end])
    counts = _check_chunks(body)
    statistics = next(record for _, _, record in summary if isinstance(record, Statistics))
    _check_statistics(statistics, body, counts)
    _check_indexes(body, summary)
    _check_offsets(records[-1][2], summary)
    return statistics


def _check_data_crc(path: Path, end: tuple[int, int, McapRecord]) -> None:
    at, _, record = end
    assert isinstance(record, DataEnd)
    assert record.data_section_crc == zlib.crc32(path.read_bytes()[:at])


def _check_chunks(body: list[tuple[int, int, McapRecord]]) -> Counter[int]:
    """Each message has its channel, each channel its schema, and time never goes back; messages by channel."""
    schemas, channels, counts, newest = set(), {}, Counter(), 0
    for index, (_, _, record) in enumerate(body):
        if not isinstance(record, Chunk):
            continue
        messages = []
        for inner in breakup_chunk(record, validate_crc=True):
            if isinstance(inner, Schema):
                assert inner.id > 0
                assert inner.id not in schemas
                schemas.add(inner.id)
            elif isinstance(inner, Channel):
                assert inner.id not in channels
                assert inner.schema_id in schemas
                channels[inner.id] = inner
            elif isinstance(inner, Message):
                assert inner.channel_id in channels
                counts[inner.channel_id] += 1
                assert inner.sequence == counts[inner.channel_id]
                assert inner.log_time >= newest
                newest = inner.log_time
                messages.append(inner)
        assert (record.message_start_time, record.message_end_time) == (
            min(message.log_time for message in messages),
            max(message.log_time for message in messages),
        )
        _check_message_indexes(record, body[index + 1 :])
    return counts


def _check_message_indexes(chunk: Chunk, following: list[tuple[int, int, McapRecord]]) -> None:
    """The indexes that follow a chunk name each of its messages once, where it is."""
    named = {}
    for _, _, record in following:
        if not isinstance(record, MessageIndex):
            break
        named.update({(record.channel_id, time, offset): None for time, offset in record.records})
    there, at = set(), 0
    for inner in breakup_chunk(chunk):
        if isinstance(inner, Message):
            there.add((inner.channel_id, inner.log_time, at))
            at += HEAD.size + BEFORE_DATA + len(inner.data)
        elif isinstance(inner, Schema):
            at += HEAD.size + 2 + 4 + len(inner.name) + 4 + len(inner.encoding) + 4 + len(inner.data)
        elif isinstance(inner, Channel):
            at += HEAD.size + 2 + 2 + 4 + len(inner.topic) + 4 + len(inner.message_encoding) + 4
    assert set(named) == there


def _check_statistics(
    statistics: Statistics, body: list[tuple[int, int, McapRecord]], counts: Counter[int]
) -> None:
    chunks = _all(body, Chunk)
    assert statistics.channel_message_counts == counts
    assert statistics.message_count == sum(counts.values())
    assert statistics.chunk_count == len(chunks)
    assert statistics.attachment_count == len(_all(body, Attachment))
    assert statistics.metadata_count == len(_all(body, Metadata))
    assert statistics.message_start_time == min((chunk.message_start_time for chunk in chunks), default=0)
    assert statistics.message_end_time == max((chunk.message_end_time for chunk in chunks), default=0)


def _check_indexes(
    body: list[tuple[int, int, McapRecord]], summary: list[tuple[int, int, McapRecord]]
) -> None:
    """Each chunk, attachment and metadata record stands where the summary says."""
    at = {(start, length): record for start, length, record in body}
    for index in _all(summary, ChunkIndex):
        chunk = at[index.chunk_start_offset, index.chunk_length]
        assert isinstance(chunk, Chunk)
        assert index.message_start_time == chunk.message_start_time
        assert index.message_end_time == chunk.message_end_time
        assert index.uncompressed_size == chunk.uncompressed_size
        assert index.compressed_size == len(chunk.data)
        starts = {start: record for (start, _), record in at.items()}
        for channel, offset in index.message_index_offsets.items():
            following = starts[offset]
            assert isinstance(following, MessageIndex)
            assert following.channel_id == channel
    for index in (*_all(summary, AttachmentIndex), *_all(summary, MetadataIndex)):
        there = at[index.offset, index.length]
        assert isinstance(there, Attachment | Metadata)
        assert there.name == index.name
    assert len(_all(summary, ChunkIndex)) == len(_all(body, Chunk))


def _check_offsets(footer: Footer, summary: list[tuple[int, int, McapRecord]]) -> None:
    """The summary's own table of contents."""
    assert footer.summary_start == summary[0][0]
    offsets = [(at, record) for at, _, record in summary if isinstance(record, SummaryOffset)]
    assert footer.summary_offset_start == offsets[0][0]
    opcodes = {
        Opcode.SCHEMA: Schema,
        Opcode.CHANNEL: Channel,
        Opcode.STATISTICS: Statistics,
        Opcode.CHUNK_INDEX: ChunkIndex,
        Opcode.ATTACHMENT_INDEX: AttachmentIndex,
        Opcode.METADATA_INDEX: MetadataIndex,
    }
    for _, offset in offsets:
        end = offset.group_start + offset.group_length
        group = [record for at, _, record in summary if offset.group_start <= at < end]
        assert group == _all(summary, opcodes[Opcode(offset.group_opcode)])


def _all(records: list[tuple[int, int, McapRecord]], kind: type) -> list:
    return [record for _, _, record in records if isinstance(record, kind)]
