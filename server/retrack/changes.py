"""What is to be different the second time, and the rig file that comes of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from pydantic import ValidationError

from control.runs import Choice
from server.replay.then import rig_of
from server.section import in_words
from server.settings import RigFile
from server.vision_section import DEFAULT_PROFILE

OF_ANOTHER_RIG = ("vision", "estimator", "robot", "gait", "camera")
"""Sections of a rig file that say how pictures become a pose."""
COLOURS = ("hue_deg", "saturation", "value", "end_mark")
"""Of [vision], those that each profile has of its own."""

Which = Literal["recorded", "again"]
"""Estimates: those of the run, or those that were worked out again."""


class RetrackError(Exception):
    """Why a run cannot be looked at again, in words."""


@dataclass(frozen=True, slots=True)
class Changes:
    """vision, estimator: values of these sections, lab units in the names; the others stay as they were.

    rig: another rig file's values, of which the sections that matter are taken first.
    controller: asked at each tick; None for nobody.  estimate: what it is shown.
    """

    vision: Mapping[str, Any] = field(default_factory=dict)
    estimator: Mapping[str, Any] = field(default_factory=dict)
    rig: Mapping[str, Any] | None = None
    controller: Choice | None = None
    estimate: Which = "recorded"

    def to_json(self) -> dict[str, Any]:
        chosen = self.controller
        asked = None if chosen is None else {"name": chosen.name, "parameters": dict(chosen.parameters)}
        return {
            "vision": dict(self.vision),
            "estimator": dict(self.estimator),
            "rig": self.rig,
            "controller": asked,
            "estimate": self.estimate,
        }

    @classmethod
    def from_json(cls, values: Mapping[str, Any]) -> Changes:
        """What `to_json` made; raises KeyError, TypeError or ValueError for anything else."""
        asked = values["controller"]
        if values["estimate"] not in get_args(Which):
            raise ValueError(f"estimate is {values['estimate']!r}; allowed: {', '.join(get_args(Which))}")
        chosen = None if asked is None else Choice(asked["name"], asked["parameters"])
        return cls(values["vision"], values["estimator"], values["rig"], chosen, values["estimate"])


def rig_then(settings: Mapping[str, Any]) -> RigFile:
    """The rig file of the run whose settings.json this is; raises `RetrackError`."""
    rig = rig_of(settings)
    if rig is None:
        raise RetrackError("the rig file of this run is lost, or of another version of pivotrig")
    return rig


def changed_rig(then: RigFile, changes: Changes) -> RigFile:
    """The rig of the run with the changes; raises `RetrackError` for what no rig file may say."""
    values = then.model_dump(mode="json")
    if changes.rig is not None:
        values |= {name: changes.rig[name] for name in OF_ANOTHER_RIG if name in changes.rig}
    values["vision"] = _changed_vision(values["vision"], changes.vision)
    values["estimator"] = {**values["estimator"], **changes.estimator}
    try:
        rig = RigFile.model_validate(values)
    except ValidationError as error:
        raise RetrackError(f"it cannot be looked at like this:\n{in_words(error)}") from error
    if rig.camera.size_px != then.camera.size_px:
        raise RetrackError(
            f"the pictures have {_size(then)} px, and the camera of the other rig file is set to {_size(rig)} px"
        )
    return rig


def _changed_vision(then: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Colours are those of the profile in use."""
    profile = changes.get("profile", then.get("profile", DEFAULT_PROFILE))
    profiles = {**then.get("profiles", {}), **changes.get("profiles", {})}
    if profile not in profiles:
        return {**then, **changes}
    colours = {name: changes[name] for name in COLOURS if name in changes}
    rest = {name: value for name, value in changes.items() if name not in COLOURS}
    return {**then, **rest, "profiles": {**profiles, profile: {**profiles[profile], **colours}}}


def _size(rig: RigFile) -> str:
    width, height = rig.camera.size_px
    return f"{width} x {height}"
