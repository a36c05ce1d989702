"""What a recording holds and where; noted from the summary of a whole file, or while walking over a torn one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar

from server.recording import mcap_format as mcap
from server.recording.mcap_format import Channel, ChunkPlace, Cursor, Opcode, Place, Schema
from server.recording.reading.byte_source import ByteSource, Damaged

NAMES_LIMIT = 1000
"""Schemas, channels, attachments or metadata records that are believed; a recording has about 20 of each."""
RECORD_LIMIT = 32 << 20
"""Bytes of a record that is read whole and is no chunk: settings, overview."""

Named = TypeVar("Named", Schema, Channel)


@dataclass(slots=True)
class Contents:
    """header: the place of the file's first record.  end: where the data that were found end, bytes.

    whole: the file has its summary, and it is sound.  chunks: in the order of the file.
    """

    header: Place
    end: int
    whole: bool = False
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    chunks: list[ChunkPlace] = field(default_factory=list)
    attachments: list[Place] = field(default_factory=list)
    metadata: list[Place] = field(default_factory=list)
    _sets: dict[frozenset[int], frozenset[int]] = field(default_factory=dict)

    def add_name(self, opcode: int, content: Cursor) -> None:
        """A schema or a channel; other records say nothing here."""
        if opcode == Opcode.SCHEMA:
            _keep(self.schemas, mcap.schema(content))
        elif opcode == Opcode.CHANNEL:
            _keep(self.channels, mcap.channel(content))

    def add_chunk(self, place: ChunkPlace) -> None:
        self.chunks.append(place)
        if place.channels is not None:
            self.last_chunk_holds(place.channels)

    def last_chunk_holds(self, channels: frozenset[int]) -> None:
        """The same set for all chunks that hold the same channels; there are thousands of them."""
        same = self._sets.setdefault(channels, channels)
        self.chunks[-1] = self.chunks[-1]._replace(channels=same)

    def add_attachment(self, place: Place) -> None:
        _append(self.attachments, place)

    def add_metadata(self, place: Place) -> None:
        _append(self.metadata, place)


def _keep(known: dict[int, Named], new: Named) -> None:
    if len(known) >= NAMES_LIMIT and new.id not in known:
        raise Damaged(f"more than {NAMES_LIMIT} schemas or channels")
    known.setdefault(new.id, new)


def _append(places: list[Place], new: Place) -> None:
    if len(places) >= NAMES_LIMIT:
        raise Damaged(f"more than {NAMES_LIMIT} attachments or metadata records")
    places.append(new)


def record_at(
    source: ByteSource, place: Place | ChunkPlace, opcode: int, limit: int = RECORD_LIMIT
) -> Cursor:
    """The content of the record at that place, which has to be of that kind and length; raises `Damaged`."""
    if place.length - mcap.HEAD.size > limit:
        raise Damaged(f"a record of {place.length} bytes; at most {limit} are read")
    found, content = mcap.record(source.read(place.offset, place.length), 0)
    if found != opcode or content.end != place.length:
        raise Damaged(f"a record of kind {found} where one of kind {opcode} should be, or of another length")
    return content
