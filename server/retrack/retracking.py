"""One recording looked at again from its first tick to its last."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from control.controllers import Law, controllers
from control.model import Pose
from control.registry import UnknownName
from control.runs import Selection
from control.safety import Refused
from server.api.choices import checked
from server.api.problems import Rejected
from server.api.schemas import ChoiceBody
from server.custom_trajectories import CustomTrajectories
from server.recording.reading.recording import Recording, Unreadable
from server.recording.topics import SELECTION
from server.replay.again import restore_path
from server.retrack.asked import Answer, Asked
from server.retrack.changes import Changes, RetrackError, changed_rig, rig_then
from server.retrack.comparison import Comparison, Seen
from server.retrack.pictures import RecordedPictures
from server.retrack.recorded_tick import RecordedTick, recorded_ticks
from server.retrack.second_look import SecondLook
from server.retrack.series import Thinned
from server.retrack.walked_then import request_then, selection_of

Watch = Callable[[float], None]
"""Told how far it is, 0 to 1."""
WATCH_EVERY = 60
"""Ticks from one word on the progress to the next: a second of the run."""
NO_PICTURES = (
    "this run was recorded without pictures, so there is nothing to look at again; set frames_Hz under [recording] "
    "in the rig file for the next run"
)


def retrack(path: Path, changes: Changes, watch: Watch | None = None) -> dict[str, Any]:
    """Comparison and series as JSON; raises `RetrackError` in words."""
    retracked = Retrack(changes)
    for _ in retracked.ticks(path, watch):
        continue
    return retracked.to_json()


class Retrack:
    """One second look at a run, and what has come of it so far."""

    def __init__(self, changes: Changes) -> None:
        self._changes = changes
        self._comparison, self._thinned = Comparison(), Thinned()

    def ticks(self, path: Path, watch: Watch | None = None) -> Iterator[Seen]:
        """Every tick since the first picture; raises `RetrackError` in words."""
        try:
            with Recording.open(path) as recording:
                for seen in _Pass(recording, self._changes).ticks(watch):
                    self._comparison.add(seen)
                    self._thinned.add(seen)
                    yield seen
        except (Unreadable, OSError) as error:
            raise RetrackError(str(error)) from error
        if watch is not None:
            watch(1.0)

    def to_json(self) -> dict[str, Any]:
        """changes, comparison, series."""
        which = "then" if self._changes.rig is None else "now"
        return {
            "changes": {**self._changes.to_json(), "rig": which},
            "comparison": self._comparison.to_json(),
            "series": self._thinned.columns(),
        }


class _Pass:
    def __init__(self, recording: Recording, changes: Changes) -> None:
        self._recording = recording
        self._estimate = changes.estimate
        settings, then = recording.settings, rig_then(recording.settings)
        self._look = SecondLook(changed_rig(then, changes))
        self._asked: Asked | None = None
        if changes.controller is not None:
            law = law_of(changes.controller.name, changes.controller.parameters)
            restore(settings)
            self._asked = Asked(then, request_then(settings), law)
        self._pictures = RecordedPictures(recording)
        self._selections = _selections(recording) if self._asked is not None else iter(())
        self._next_selection = next(self._selections, None)

    def ticks(self, watch: Watch | None) -> Iterator[Seen]:
        duration = self._recording.duration
        for count, tick in enumerate(recorded_ticks(self._recording)):
            seen = self._tick(tick)
            if self._look.is_looking:
                yield seen
            if watch is not None and count % WATCH_EVERY == 0 and duration > 0.0:
                watch(min(max(tick.since_start / duration, 0.0), 1.0))
        if not self._pictures.taken:
            raise RetrackError(NO_PICTURES)

    def _tick(self, tick: RecordedTick) -> Seen:
        frame, look = self._pictures.at(tick), self._look
        look.tick(tick, frame)
        looked = frame is not None
        answer = self._ask(tick, look.pose)
        return Seen(tick, look.pose, look.tracking, looked, looked and look.sighted, answer)

    def _ask(self, tick: RecordedTick, pose: Pose | None) -> Answer | None:
        if self._asked is None:
            return None
        while self._next_selection is not None and self._next_selection[0] < tick.number:
            self._asked.change(self._next_selection[1])
            self._next_selection = next(self._selections, None)
        return self._asked.tick(tick, self._look, tick.pose if self._estimate == "recorded" else pose)


def law_of(name: str, parameters: Mapping[str, Any]) -> Law:
    """The controller that is asked; raises `RetrackError`."""
    try:
        choice = checked(controllers, ChoiceBody(name=name, parameters=dict(parameters)), ("controller",))
        return controllers.build(choice.name, choice.parameters)
    except (Rejected, UnknownName) as error:
        raise RetrackError(f"the controller cannot be asked: {error}") from error


def restore(settings: Mapping[str, Any]) -> None:
    """The path that somebody had saved and the run walked is there again; raises `RetrackError`."""
    try:
        restore_path(settings, CustomTrajectories())
    except Refused as error:
        raise RetrackError(str(error)) from error


def _selections(recording: Recording) -> Iterator[tuple[int, Selection]]:
    """What the run was changed to, and the tick after which; the first one is what it began with."""
    entries = recording.messages([SELECTION.name])
    next(entries, None)
    for entry in entries:
        if isinstance(entry.data, dict):
            yield int(entry.data.get("tick", 0)), selection_of(entry.data)
