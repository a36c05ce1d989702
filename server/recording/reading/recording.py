"""A recording, read back: of a whole file, of a torn one, and of one that is still growing.

The file is never trusted: what does not hold together is left out and counted, memory is bounded, and the one
error is `Unreadable`. Of a file that grows, what was there when it was opened is seen.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from itertools import islice
from pathlib import Path
from types import TracebackType
from typing import Any

import msgspec

from server.recording import mcap_format as mcap
from server.recording.foxglove import LEVELS
from server.recording.mcap_format import Message, Opcode
from server.recording.names import METADATA, OUTCOME, OVERVIEW, RECOVERED, SETTINGS
from server.recording.reading.byte_source import ByteSource, Damaged
from server.recording.reading.chunk_shelf import ChunkShelf
from server.recording.reading.contents import Contents, record_at
from server.recording.reading.finding import look_through
from server.recording.reading.tick_reading import Tick, TickReader
from server.recording.reading.timeline import ALWAYS, Timeline
from server.recording.topics import CAMERA, EVENTS

NANO = 1_000_000_000
"""Nanoseconds of a second."""
JSON = "json"
SEVERITIES = {level: severity for severity, level in LEVELS.items()}
FAR = 1e8
"""Seconds that a time within a recording may be asked for; three years."""


class Unreadable(Exception):
    """Nothing of the file can be read; the message says why in words."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One message. time_s: since the run's start, s.  log_time: UTC, ns.  data: bytes where it is no JSON."""

    topic: str
    time_s: float
    log_time: int
    data: dict[str, Any] | bytes = field(repr=False)


@dataclass(frozen=True, slots=True)
class Picture:
    """A camera frame. time_s: of its tick, since the run's start, s.  captured_s: of its capture, likewise."""

    time_s: float
    captured_s: float
    jpeg: bytes = field(repr=False)


class Image(msgspec.Struct):
    """The part of a foxglove.CompressedImage that is a picture; its data are base64 in the file."""

    data: bytes


class Recording:
    """Use as a context, from one thread at a time. Times are seconds since the run's start.

    is_whole: it has its end, so nothing is missing.  size: bytes.  metadata: what the file says of itself.
    topics: by channel id.  start_ns: of the run, UTC, ns.
    unread_messages: those that were asked for and make no sense.
    """

    def __init__(self, source: ByteSource, contents: Contents) -> None:
        self._source = source
        self._contents = contents
        self._shelf = ChunkShelf(source, contents)
        self._timeline = Timeline(self._shelf, contents.chunks)
        self._attachments: dict[str, dict[str, Any] | None] = {}
        if contents.chunks and not contents.whole:
            self._shelf.messages(contents.chunks[0])  # its channels may stand in there
        self.is_whole = contents.whole
        self.size = source.size
        self.topics = {id: channel.topic for id, channel in contents.channels.items()}
        self.unread_messages = 0
        self.metadata = self._metadata()
        self.start_ns = self._begun()

    @classmethod
    def open(cls, path: Path) -> Recording:
        """Raises `Unreadable`; a torn file is opened, with what it has."""
        try:
            source = ByteSource(path)
        except OSError as error:
            raise Unreadable(f"{path} cannot be opened: {error.strerror}") from error
        try:
            return cls(source, look_through(source))
        except (Damaged, OSError) as error:
            source.close()
            raise Unreadable(f"{path} is no recording that can be read: {error}") from error
        except BaseException:
            source.close()
            raise

    def close(self) -> None:
        self._source.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def damaged_chunks(self) -> int:
        """Quarter seconds that were asked for and could not be read."""
        return len(self._shelf.damaged)

    @property
    def chunks_read(self) -> int:
        """Quarter seconds that were unpacked, those that were unpacked again included."""
        return self._shelf.read

    @property
    def is_recovered(self) -> bool:
        """Its end was lost, and made anew."""
        return any(place.name == RECOVERED for place in self._contents.metadata)

    @property
    def started_at(self) -> datetime:
        return _instant(self.start_ns)

    @property
    def ended_at(self) -> datetime:
        """Of the last message."""
        return _instant(max(self._timeline.end or 0, self.start_ns))

    @property
    def duration(self) -> float:
        """From the run's start to the last message, s."""
        end = self._timeline.end
        return 0.0 if end is None else max(end - self.start_ns, 0) / NANO

    @property
    def settings(self) -> dict[str, Any]:
        """The conditions of the run; empty where they are lost."""
        return self.attachment(SETTINGS) or {}

    @property
    def outcome(self) -> dict[str, Any] | None:
        """State, reason, metrics and counts; None before the end."""
        return self.attachment(OUTCOME)

    @property
    def overview(self) -> dict[str, Any] | None:
        """A few points of each series; None before the end."""
        return self.attachment(OVERVIEW)

    def attachment(self, name: str) -> dict[str, Any] | None:
        """The JSON object that was attached under that name; None where there is none that can be read."""
        if name not in self._attachments:
            self._attachments[name] = self._read_attachment(name)
        return self._attachments[name]

    def messages(
        self, topics: Iterable[str] | None = None, start: float | None = None, end: float | None = None
    ) -> Iterator[Entry]:
        """All messages, or those of `topics`, from `start` until before `end`.

        They come in the order of the file, which within a topic is that of time.
        """
        for message in self._timeline.between(self._channels(topics), *self._range(start, end)):
            data = self.decode(message)
            if data is not None:
                yield Entry(
                    self.topics[message.channel_id], self._seconds(message.log_time), message.log_time, data
                )

    def ticks(
        self, start: float | None = None, end: float | None = None, topics: Iterable[str] | None = None
    ) -> Iterator[Tick]:
        """One tick after the other, its messages by topic (only `topics`, which is faster)."""
        return self._tick_reader(topics).between(*self._range(start, end))

    def tick_at(self, time: float) -> Tick | None:
        """The newest tick at that time or before it; None before the first."""
        return self._tick_reader(None).at(self._log_time(time))

    def frame_at(self, time: float) -> Picture | None:
        """The newest camera frame at that time or before it; None before the first."""
        for message in self._timeline.newest(self._channels([CAMERA.name]), self._log_time(time)):
            return self._picture(message)
        return None

    def frames(self, start: float | None = None, end: float | None = None) -> Iterator[Picture]:
        """The camera frames in the order of time."""
        for message in self._timeline.between(self._channels([CAMERA.name]), *self._range(start, end)):
            picture = self._picture(message)
            if picture is not None:
                yield picture

    def events(self, most: int | None = None) -> list[dict[str, Any]]:
        """The lines of the event log, oldest first: time_s since the run's start, severity, code, message."""
        lines = islice(self._timeline.between(self._channels([EVENTS.name])), most)
        return [_line(self._seconds(line.publish_time), self.decode(line)) for line in lines]

    def _channels(self, topics: Iterable[str] | None) -> dict[int, str]:
        wanted = None if topics is None else set(topics)
        return {id: topic for id, topic in self.topics.items() if wanted is None or topic in wanted}

    def _tick_reader(self, topics: Iterable[str] | None) -> TickReader:
        return TickReader(self._timeline, self._channels(topics), self.decode)

    def _range(self, start: float | None, end: float | None) -> tuple[int, int]:
        return 0 if start is None else self._log_time(start), ALWAYS if end is None else self._log_time(end)

    def _log_time(self, time: float) -> int:
        """UTC in ns; a time that is no number is before everything."""
        return self.start_ns + round(time * NANO) if -FAR <= time <= FAR else (ALWAYS if time > FAR else 0)

    def _seconds(self, log_time: int) -> float:
        return (log_time - self.start_ns) / NANO

    def decode(self, message: Message) -> dict[str, Any] | bytes | None:
        """A JSON object, or the bytes of another encoding; None, and counted, for what makes no sense."""
        channel = self._contents.channels[message.channel_id]
        if channel.encoding != JSON:
            return message.data
        try:
            return decoded(message.data)
        except Damaged:
            self.unread_messages += 1
            return None

    def _picture(self, message: Message) -> Picture | None:
        try:
            jpeg = msgspec.json.decode(message.data, type=Image).data
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
            self.unread_messages += 1
            return None
        return Picture(self._seconds(message.log_time), self._seconds(message.publish_time), jpeg)

    def _read_attachment(self, name: str) -> dict[str, Any] | None:
        for place in reversed(self._contents.attachments):
            if place.name == name:
                try:
                    return decoded(mcap.attachment(record_at(self._source, place, Opcode.ATTACHMENT)).data)
                except Damaged:
                    continue
        return None

    def _metadata(self) -> dict[str, str]:
        for place in self._contents.metadata:
            if place.name == METADATA:
                try:
                    return mcap.metadata(record_at(self._source, place, Opcode.METADATA))[1]
                except Damaged:
                    continue
        return {}

    def _begun(self) -> int:
        """The run's start, UTC in ns: as it was written, else the first message's."""
        try:
            began = datetime.fromisoformat(self.metadata.get("started_at", ""))
            written = round(began.timestamp() * 1e6) * 1000
        except (ValueError, OverflowError):
            written = -1
        return written if 0 <= written < ALWAYS else self._timeline.start or 0


def _instant(log_time: int) -> datetime:
    seconds, rest = divmod(log_time, NANO)
    return datetime.fromtimestamp(seconds, UTC) + timedelta(microseconds=rest / 1000)


def _line(time: float, log: dict[str, Any] | bytes | None) -> dict[str, Any]:
    said = log if isinstance(log, dict) else {}
    severity = SEVERITIES.get(said.get("level", 0), "info")
    return {
        "time_s": time,
        "severity": severity,
        "code": str(said.get("name", "")),
        "message": str(said.get("message", "")),
    }


def decoded(data: bytes) -> dict[str, Any]:
    """The JSON object in these bytes; raises `Damaged`."""
    try:
        found = msgspec.json.decode(data)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise Damaged(f"no JSON: {error}") from None
    if not isinstance(found, dict):
        raise Damaged(f"JSON that is a {type(found).__name__}, not an object")
    return found
