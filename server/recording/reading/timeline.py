"""The messages of a recording by their time: all between two instants, or the newest at one."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator
from itertools import accumulate

from server.recording.mcap_format import ChunkPlace, Message
from server.recording.reading.chunk_shelf import ChunkShelf

ALWAYS = 1 << 64
"""Later than every log time, ns."""


class Timeline:
    """Within a channel messages are in the order of time, as the recorder writes them. Times are log times, ns.

    Chunks may overlap in time; the recorder's do not.
    """

    def __init__(self, shelf: ChunkShelf, chunks: list[ChunkPlace]) -> None:
        self._shelf = shelf
        self._chunks = chunks
        self._earliest_from = list(accumulate((chunk.start for chunk in reversed(chunks)), min))[::-1]
        self._latest_until = list(accumulate((chunk.end for chunk in chunks), max))

    @property
    def start(self) -> int | None:
        """Of the earliest message; None without any."""
        return self._earliest_from[0] if self._earliest_from else None

    @property
    def end(self) -> int | None:
        """Of the latest message; None without any."""
        return self._latest_until[-1] if self._latest_until else None

    def between(self, channels: Collection[int], start: int = 0, end: int = ALWAYS) -> Iterator[Message]:
        """Messages of these channels in the order of the file; `end` is not included."""
        first = bisect_left(self._latest_until, start)
        last = bisect_left(self._earliest_from, end)
        for place in self._chunks[first:last]:
            if may_hold(place, channels):
                for message in self._shelf.messages(place):
                    if message.channel_id in channels and start <= message.log_time < end:
                        yield message

    def newest(self, channels: Collection[int], until: int) -> list[Message]:
        """The messages of these channels that share the newest time not after `until`; none before the first."""
        for index in range(bisect_right(self._earliest_from, until) - 1, -1, -1):
            if may_hold(self._chunks[index], channels) and (found := self._newest_in(index, channels, until)):
                return found
        return []

    def _newest_in(self, index: int, channels: Collection[int], until: int) -> list[Message]:
        here = [
            message
            for message in self._shelf.messages(self._chunks[index])
            if message.channel_id in channels and message.log_time <= until
        ]
        newest = max((message.log_time for message in here), default=0)
        return [message for message in here if message.log_time == newest]


def may_hold(place: ChunkPlace, channels: Collection[int]) -> bool:
    return place.channels is None or not place.channels.isdisjoint(channels)
