"""Finding out what a file holds: by its summary where it is whole, by walking over its records where it is torn."""

from __future__ import annotations

import contextlib
import zlib
from collections.abc import Iterator

from server.recording import mcap_format as mcap
from server.recording.mcap_format import ChunkPlace, Cursor, Opcode, Place
from server.recording.reading.byte_source import ByteSource, Damaged
from server.recording.reading.contents import Contents, record_at

TAIL = mcap.HEAD.size + mcap.FOOTER.size + len(mcap.MAGIC)
"""Footer and magic at the end of a whole file, bytes."""
SUMMARY_LIMIT = 256 << 20
"""Bytes of summary that are read; an hour of recording has 4 MB of it."""
RECORDS_LIMIT = 20_000_000
"""Records that are walked over in a torn file: three days of recording."""
PEEK = 512
"""Bytes of a record that are looked at while walking: a chunk's times, or the name of what is stored."""
LONG_TWICE = 2 * mcap.LONG.size
"""Bytes of the two times that an attachment has before its name."""


def look_through(source: ByteSource) -> Contents:
    """Raises `Damaged` when there is not even a beginning; anything else that is wrong ends what is found."""
    header = _beginning(source)
    try:
        return _from_summary(source, header)
    except Damaged:
        return _by_walking(source, header)


def has_end(source: ByteSource) -> bool:
    """Whether the file ends as one that was finished; what is in it is not looked at."""
    try:
        _footer(source)
    except Damaged:
        return False
    return True


def _beginning(source: ByteSource) -> Place:
    at = len(mcap.MAGIC)
    if source.read(0, at) != mcap.MAGIC:
        raise Damaged("it does not begin like an MCAP file")
    opcode, length = mcap.HEAD.unpack(source.read(at, mcap.HEAD.size))
    header = Place(at, length + mcap.HEAD.size)
    if opcode != Opcode.HEADER:
        raise Damaged(f"its first record is of kind {opcode} instead of {Opcode.HEADER}")
    record_at(source, header, Opcode.HEADER)
    return header


def _footer(source: ByteSource) -> bytes:
    """The tail of the file, checked."""
    tail = source.read(source.size - TAIL, TAIL)
    opcode, length = mcap.HEAD.unpack_from(tail)
    if not (opcode == Opcode.FOOTER and length == mcap.FOOTER.size and tail.endswith(mcap.MAGIC)):
        raise Damaged("it has no end")
    return tail


def _from_summary(source: ByteSource, header: Place) -> Contents:
    summary_at, summary = _summary(source)
    contents = Contents(header, summary_at, whole=True)
    for opcode, content in mcap.records(summary):
        if opcode == Opcode.CHUNK_INDEX:
            contents.add_chunk(mcap.chunk_index(content))
        elif opcode == Opcode.ATTACHMENT_INDEX:
            contents.add_attachment(mcap.attachment_index(content))
        elif opcode == Opcode.METADATA_INDEX:
            contents.add_metadata(mcap.metadata_index(content))
        else:
            contents.add_name(opcode, content)
    return contents


def _summary(source: ByteSource) -> tuple[int, bytes]:
    """Where the summary begins, and its bytes, checked."""
    tail, tail_at = _footer(source), source.size - TAIL
    start, _, check_sum = mcap.FOOTER.unpack_from(tail, mcap.HEAD.size)
    if not (0 < start <= tail_at and tail_at - start <= SUMMARY_LIMIT):
        raise Damaged(f"a summary at {start} of a file of {source.size} bytes")
    summary = source.read(start, tail_at - start)
    covered = tail[: TAIL - len(mcap.MAGIC) - mcap.INTEGER.size]
    if check_sum not in (0, zlib.crc32(covered, zlib.crc32(summary))):
        raise Damaged("a summary with a wrong checksum")
    return start, summary


def _by_walking(source: ByteSource, header: Place) -> Contents:
    contents = Contents(header, header.offset + header.length)
    with contextlib.suppress(Damaged):  # this is where it is torn; what is before stays
        _note_all(source, contents)
    return contents


def _note_all(source: ByteSource, contents: Contents) -> None:
    held: set[int] = set()
    for opcode, place, content in _walk(source, contents.end):
        if opcode == Opcode.MESSAGE_INDEX:
            held.add(content.short())
        else:
            if held and contents.chunks:
                contents.last_chunk_holds(
                    frozenset(held)
                )  # all the indexes that follow a chunk have been seen
            held.clear()
            if opcode == Opcode.DATA_END:
                return
            _note(source, contents, opcode, place, content)
        contents.end = place.offset + place.length


def _walk(source: ByteSource, at: int) -> Iterator[tuple[int, Place, Cursor]]:
    """Kind, place and the first bytes of the content of the records from there on, as far as they are whole."""
    for _ in range(RECORDS_LIMIT):
        left = source.size - at
        if left < mcap.HEAD.size:
            return
        peek = source.read(at, min(PEEK, left))
        opcode, length = mcap.HEAD.unpack_from(peek)
        if length > left - mcap.HEAD.size:
            return
        place = Place(at, mcap.HEAD.size + length)
        yield opcode, place, Cursor(peek, mcap.HEAD.size, min(len(peek), place.length))
        at += place.length


def _note(source: ByteSource, contents: Contents, opcode: int, place: Place, content: Cursor) -> None:
    if opcode == Opcode.CHUNK:
        start, end, *_ = content.values(mcap.CHUNK_HEAD)
        contents.add_chunk(ChunkPlace(place.offset, place.length, start, end))
    elif opcode == Opcode.ATTACHMENT:
        content.take(LONG_TWICE)
        contents.add_attachment(place._replace(name=content.text()))
    elif opcode == Opcode.METADATA:
        contents.add_metadata(place._replace(name=content.text()))
    elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
        contents.add_name(opcode, record_at(source, place, opcode))
