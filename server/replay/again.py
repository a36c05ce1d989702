"""The same run once more: what was asked for then, and what of the rig has changed since."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pydantic import ValidationError

from control.gait_settings import MM
from control.runs import RunRequest
from control.safety import Refused
from control.trajectories import trajectories
from control.trajectories.custom import SavedPath
from control.trajectories.waypoints import WaypointsParameters
from server.api.choices import select
from server.api.schemas import SelectionBody
from server.catalogue.records import RunRecord
from server.custom_trajectories import CustomTrajectories
from server.replay.then import exact_gait, saved_path

AGAIN = "again"


@dataclass(frozen=True, slots=True)
class Difference:
    """A value of the rig file. name: dotted.  then, now: as JSON; None for one that is not there."""

    name: str
    then: Any
    now: Any

    @property
    def words(self) -> str:
        return f"{self.name} was {in_words(self.then)} and is {in_words(self.now)} now"


def in_words(value: Any) -> str:
    return "not there" if value is None else json.dumps(value, ensure_ascii=False)


def differences(then: Mapping[str, Any], now: Mapping[str, Any]) -> list[Difference]:
    """Of two rig files as JSON, in the order of the newer one."""
    before, after = dict(flat(then)), dict(flat(now))
    names = dict.fromkeys((*after, *before))
    return [
        Difference(name, before.get(name), after.get(name))
        for name in names
        if before.get(name) != after.get(name)
    ]


def flat(values: Mapping[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    """Every value that is no table, by its dotted name."""
    found: list[tuple[str, Any]] = []
    for name, value in values.items():
        if isinstance(value, Mapping):
            found += flat(value, f"{prefix}{name}.")
        else:
            found.append((prefix + name, value))
    return found


def request_again(record: RunRecord) -> RunRequest:
    """What was asked for; raises `Refused` where that is lost, and `Rejected` where it is no longer possible."""
    try:
        selection = SelectionBody.model_validate_json(json.dumps(record.selection))
    except ValidationError as error:
        raise Refused(
            f"what the run {record.id} was asked to do is lost; choose and start it anew"
        ) from error
    chosen = replace(select(selection), gait=exact_gait(record.settings, selection.gait))
    return RunRequest(
        chosen,
        passes=record.passes,
        duration=record.duration_s,
        unattended=record.unattended,
        label=label_again(record.label),
        tags=record.tags,
    )


def label_again(label: str) -> str:
    """The label with "again" at its end, once."""
    return label if AGAIN in label.split() else f"{label} {AGAIN}".strip()


def restore_path(settings: Mapping[str, Any], paths: CustomTrajectories) -> None:
    """Save the path that the run walked anew, if it was somebody's own and is gone.

    Raises `Refused` where another one has its name now.
    """
    path = saved_path(settings)
    if path is None:
        return
    name, whole = path
    if name not in trajectories:
        points = np.array(whole.points_mm) * MM
        paths.save(name, points, whole.closed, whole.speed_mm_s * MM, whole.kind)
    elif not is_same(name, whole):
        raise Refused(
            f"the run walked a path {name!r}, and there is another one of that name now; it cannot be taken for it"
        )


def is_same(name: str, whole: WaypointsParameters) -> bool:
    entry = trajectories[name]
    return isinstance(entry, type) and issubclass(entry, SavedPath) and entry.whole == whole
