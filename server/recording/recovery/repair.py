"""A whole file from a torn one: its sound chunks as they are, a new index, and the figures counted again."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import groupby
from typing import Any

import msgspec
from mcap.records import Channel, Chunk, Schema

from server.catalogue.records import INTERRUPTED
from server.metrics_json import metrics_json
from server.recording import mcap_format as mcap
from server.recording.mcap_format import ChunkPlace, Cursor, Message, Opcode, Place
from server.recording.names import JSON, OUTCOME, OVERVIEW, RECOVERED
from server.recording.reading.byte_source import ByteSource, Damaged
from server.recording.reading.contents import Contents, record_at
from server.recording.reading.listing import REASON
from server.recording.reading.recording import NANO, Recording
from server.recording.reading.tick_reading import BESIDE_TICKS, Tick
from server.recording.recovery.recount import Recount, number
from server.recording.topics import CAMERA
from server.recording.writing.disk import DiskFile
from server.recording.writing.mcap_writer import Index, McapWriter
from server.settings import MM, Robot

DEFAULT_LENGTH = Robot().length_mm
"""Between the pivots, mm, where a recording does not say."""


class Repair:
    """Copies one torn recording into a new file; what writes raises OSError where the disk does.

    recount: figures of the run as far as it is copied.  frames: pictures copied.  left_out: chunks that were not sound.
    """

    def __init__(
        self, source: ByteSource, contents: Contents, file: DiskFile, ended: Mapping[str, Any] | None = None
    ) -> None:
        """contents: of `source`.  ended: how the run ended, where that is known from elsewhere."""
        self._ended = ended
        self._source = source
        self._contents = contents
        self._recording = Recording(source, contents)
        self._writer = _writer_for(source, contents, file)
        self._cameras = [id for id, topic in self._recording.topics.items() if topic == CAMERA.name]
        self.recount = Recount(_length_of(self._recording.settings))
        self.frames = self.left_out = 0

    @property
    def size(self) -> int:
        """Of the new file so far, bytes."""
        return self._writer.size

    @property
    def outcome(self) -> dict[str, Any]:
        """As the run itself wrote it, where it came so far; else what is known of it."""
        return self._recording.outcome or {**self._interrupted(), **(self._ended or {})}

    def copy(self, between: Callable[[], None]) -> None:
        """All of it, and an end. between: called after each chunk."""
        self._copy_head()
        for place in self._contents.chunks:
            self._copy_chunk(place)
            between()
        self._finish()

    def _copy_head(self) -> None:
        for values in self._sound(self._contents.metadata, Opcode.METADATA, mcap.metadata):
            self._writer.describe(*values)
        for each in self._sound(self._contents.attachments, Opcode.ATTACHMENT, mcap.attachment):
            if each.name not in (OUTCOME, OVERVIEW):
                self._writer.attach(each.name, each.media_type, each.data, each.log_time)

    def _sound(self, places: Iterable[Place], opcode: int, parse: Callable[[Cursor], Any]) -> Iterator[Any]:
        """The records at these places, without those that are damaged."""
        for place in places:
            try:
                yield parse(record_at(self._source, place, opcode))
            except Damaged:
                self.left_out += 1

    def _copy_chunk(self, place: ChunkPlace) -> None:
        """A chunk's bytes stay as they are; its message index is made anew, since that may be what is torn."""
        try:
            content = record_at(self._source, place, Opcode.CHUNK, mcap.CHUNK_LIMIT)
            messages, _ = mcap.in_chunk(mcap.chunk(content))
        except Damaged:
            self.left_out += 1
            return
        known = [message for message in messages if message.channel_id in self._recording.topics]
        self._writer.append(_chunk_record(content), content.data, _index_of(messages))
        self.frames += sum(message.channel_id in self._cameras for message in known)
        self._count(known)

    def _count(self, messages: Iterable[Message]) -> None:
        """The ticks of a chunk; a tick is never divided between two."""
        of_ticks = (each for each in messages if self._recording.topics[each.channel_id] not in BESIDE_TICKS)
        for log_time, group in groupby(of_ticks, lambda message: message.log_time):
            self.recount.add((log_time - self._recording.start_ns) / NANO, self._tick(group))

    def _tick(self, messages: Iterable[Message]) -> Tick:
        found = ((self._recording.topics[each.channel_id], self._recording.decode(each)) for each in messages)
        return {topic: data for topic, data in found if isinstance(data, dict)}

    def _finish(self) -> None:
        end = self._writer.summary.end
        self._writer.attach(OVERVIEW, JSON, msgspec.json.encode(self.recount.overview.as_json()), end)
        self._writer.attach(OUTCOME, JSON, msgspec.json.encode(self.outcome), end)
        left_out, lost = str(self.left_out), str(self._source.size - self._contents.end)
        self._writer.describe(RECOVERED, {"records_left_out": left_out, "bytes_left_out": lost})
        self._writer.finish()

    def _interrupted(self) -> dict[str, Any]:
        metrics = self.recount.metrics()
        return {
            "state": INTERRUPTED,
            "reason": REASON,
            "metrics": None if metrics is None else metrics_json(metrics),
            "ended_at": self._recording.ended_at.isoformat(),
            "ticks": self.recount.ticks,
            "frames": self.frames,
            "frames_left_out": 0,
            "failure": "",
        }


def _writer_for(source: ByteSource, contents: Contents, file: DiskFile) -> McapWriter:
    """One that knows the schemas and channels which stand in the chunks that will be copied."""
    head = record_at(source, contents.header, Opcode.HEADER)
    _profile, library = head.text(), head.text()
    writer = McapWriter(file, library)
    writer.summary.schemas += [
        Schema(id=each.id, data=each.data, encoding=each.encoding, name=each.name)
        for each in contents.schemas.values()
    ]
    writer.summary.channels += [
        Channel(each.id, each.topic, each.encoding, each.metadata, each.schema_id)
        for each in contents.channels.values()
    ]
    return writer


def _chunk_record(content: Cursor) -> Chunk:
    """For the index; its data are only measured."""
    head = Cursor(content.data, mcap.HEAD.size)
    start, end, size, check_sum = head.values(mcap.CHUNK_HEAD)
    compression = head.text()
    return Chunk(
        compression=compression,
        data=head.take(head.long()),
        message_end_time=end,
        message_start_time=start,
        uncompressed_crc=check_sum,
        uncompressed_size=size,
    )


def _index_of(messages: Iterable[Message]) -> Index:
    index: Index = {}
    for message in messages:
        index.setdefault(message.channel_id, []).append((message.log_time, message.at))
    return index


def _length_of(settings: dict[str, Any]) -> float:
    """Between the pivots, m."""
    rig = settings.get("rig")
    robot = rig.get("robot") if isinstance(rig, dict) else None
    length = number(robot, "length_mm") if isinstance(robot, dict) else None
    return (length if length is not None and length > 0.0 else DEFAULT_LENGTH) * MM
