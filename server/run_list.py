"""The runs of this session, newest first, and what is to be told of them."""

from __future__ import annotations

import secrets
import threading
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
    """Written by the rig's thread and by the event loop, read by everybody."""

    def __init__(self) -> None:
        self._one_at_a_time = threading.Lock()
        self._runs: deque[Run] = deque(maxlen=RUNS_KEPT)
        self._news: deque[News] = deque(maxlen=NEWS_KEPT)

    def __iter__(self) -> Iterator[Run]:
        with self._one_at_a_time:
            return iter(tuple(self._runs))

    def __bool__(self) -> bool:
        return bool(self._runs)

    def __getitem__(self, index: int) -> Run:
        return self._runs[index]

    def of(self, id: str) -> Run:
        """The run of that id; raises StopIteration for one that was never started."""
        return next(run for run in self if run.id == id)

    def start(self, run: Run) -> None:
        with self._one_at_a_time:
            self._runs.appendleft(run)
        self._news.append(("started", run))

    def change_newest(self, selection: Selection) -> None:
        with self._one_at_a_time:
            run = self._runs[0]
            run = self._runs[0] = replace(run, request=replace(run.request, selection=selection))
        self._news.append(("changed", run))

    def end(self, ended: Ended) -> None:
        self._finish(ended.id, state=ended.state, reason=ended.reason, metrics=ended.metrics)

    def abort(self, id: str, reason: str) -> None:
        """End a run of which nothing more will be heard."""
        self._finish(id, state=RunState.ABORTED, reason=reason)

    def _finish(self, id: str, **outcome: object) -> None:
        with self._one_at_a_time:
            for index, run in enumerate(self._runs):
                if run.id == id:
                    run = self._runs[index] = replace(run, **outcome)  # type: ignore[arg-type]
                    self._news.append((run.state.value, run))
                    return

    def forget(self, id: str) -> bool:
        """Take a run that has ended off the list; whether it was on it."""
        with self._one_at_a_time:
            ended = [run for run in self._runs if run.id == id and run.state is not RunState.RUNNING]
            for run in ended:
                self._runs.remove(run)
        return bool(ended)

    def take_news(self) -> list[News]:
        """What happened since the last call, oldest first."""
        return [self._news.popleft() for _ in range(len(self._news))]


def new_id() -> str:
    """Sorts by time, reads well, and is another one in every program that starts a run in the same second."""
    return f"{datetime.now(UTC):%Y%m%d-%H%M%S}-{secrets.token_hex(4)}"
