"""The messages of one tick put together again: they carry the same time and stand one after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from server.recording.mcap_format import Message
from server.recording.reading.timeline import ALWAYS, Timeline
from server.recording.topics import CALIBRATION, CAMERA, EVENTS, SELECTION

BESIDE_TICKS = frozenset(topic.name for topic in (CAMERA, CALIBRATION, EVENTS, SELECTION))
"""Topics whose messages come otherwise than with each tick."""
SELDOM = frozenset({"/link"})
"""Topics of ticks that are not written at each one; the newest message holds until the next."""

Tick = dict[str, dict[str, Any]]
"""The messages of one tick by their topic."""
Decode = Callable[[Message], dict[str, Any] | bytes | None]


class TickReader:
    """topics: by channel id; those beside the ticks are left out.  Times are log times, ns."""

    def __init__(self, timeline: Timeline, topics: Mapping[int, str], decode: Decode) -> None:
        self._timeline = timeline
        self._topics = {id: topic for id, topic in topics.items() if topic not in BESIDE_TICKS}
        self._often = {id for id, topic in self._topics.items() if topic not in SELDOM}
        self._decode = decode

    def between(self, start: int = 0, end: int = ALWAYS) -> Iterator[Tick]:
        """In the order of time."""
        seldom = self._seldom_before(start)
        group: list[Message] = []
        for message in self._timeline.between(self._topics, start, end):
            if group and message.log_time != group[0].log_time:
                yield self._tick(group, seldom)
                group = []
            group.append(message)
        if group:
            yield self._tick(group, seldom)

    def at(self, until: int) -> Tick | None:
        """The newest one not after that time."""
        newest = self._timeline.newest(self._often, until)
        if not newest:
            return None
        return self._tick(newest, self._seldom_before(newest[0].log_time + 1))

    def _tick(self, messages: Iterable[Message], seldom: Tick) -> Tick:
        """Notes in `seldom` what holds for the ticks that follow."""
        fresh: Tick = {}
        for message in messages:
            data = self._decode(message)
            if isinstance(data, dict):
                fresh[self._topics[message.channel_id]] = data
        seldom.update({topic: fresh[topic] for topic in SELDOM & fresh.keys()})
        return {**seldom, **fresh}

    def _seldom_before(self, time: int) -> Tick:
        """What was written last before that time of the topics that are not written at each tick."""
        found: Tick = {}
        for id in self._topics.keys() - self._often:
            for message in self._timeline.newest({id}, time - 1):
                data = self._decode(message)
                if isinstance(data, dict):
                    found[self._topics[id]] = data
        return found
