"""The runs of this session, newest first, and what is to be told of them."""

from __future__ import annotations

import secrets
from collections import deque
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime

from control.news import Ended
from control.runs import Run, RunState, Selection

RUNS_KEPT = 1000
NEWS_KEPT = 1000

News = tuple[str, Run]
"""What happened to a run, and the run as it is then."""


class RunList:
    """Written by the rig's thread and by the event loop, one after the other."""

    def __init__(self) -> None:
        self._runs: deque[Run] = deque(maxlen=RUNS_KEPT)
        self._news: deque[News] = deque(maxlen=NEWS_KEPT)

    def __iter__(self) -> Iterator[Run]:
        return iter(self._runs)

    def __bool__(self) -> bool:
        return bool(self._runs)

    def __getitem__(self, index: int) -> Run:
        return self._runs[index]

    def of(self, id: str) -> Run:
        """The run of that id; raises StopIteration for one that was never started."""
        return next(run for run in self._runs if run.id == id)

    def start(self, run: Run) -> None:
        self._runs.appendleft(run)
        self._news.append(("started", run))

    def change_newest(self, selection: Selection) -> None:
        run = self._runs[0]
        self._runs[0] = replace(run, request=replace(run.request, selection=selection))
        self._news.append(("changed", self._runs[0]))

    def end(self, ended: Ended) -> None:
        self._finish(ended.id, state=ended.state, reason=ended.reason, metrics=ended.metrics)

    def abort(self, id: str, reason: str) -> None:
        """End a run of which nothing more will be heard."""
        self._finish(id, state=RunState.ABORTED, reason=reason)

    def _finish(self, id: str, **outcome: object) -> None:
        for index, run in enumerate(self._runs):
            if run.id == id:
                self._runs[index] = replace(run, **outcome)  # type: ignore[arg-type]
                self._news.append((self._runs[index].state.value, self._runs[index]))
                return

    def take_news(self) -> list[News]:
        """What happened since the last call, oldest first."""
        return [self._news.popleft() for _ in range(len(self._news))]


def new_id() -> str:
    """Sorts by time, reads well, never repeats."""
    return f"{datetime.now(UTC):%Y%m%d-%H%M%S}-{secrets.token_hex(2)}"
