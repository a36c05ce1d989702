"""What crosses the edge, in the lab's units: the one place where they become SI and SI becomes them.

Every model is strict: unknown fields, NaN, infinity and numbers in quotes are refused.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, JsonValue, StringConstraints

from control.edge import Duration, Edge, Name, Passes
from control.gait_settings import GaitSettings, TimeLawName
from control.trajectories.fields import SLOWEST_MM_S
from control.trajectories.waypoints import Smoothing

PathName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]{0,59}$")]
Label = Annotated[str, StringConstraints(max_length=200)]
Tag = Annotated[str, StringConstraints(min_length=1, max_length=40)]
Tags = Annotated[list[Tag], Field(max_length=20)]
PointMM = Annotated[list[Annotated[float, Field(ge=-500.0, le=500.0)]], Field(min_length=2, max_length=2)]


class ChoiceBody(Edge):
    """A controller or trajectory by name; parameters that are left out keep their defaults."""

    name: Name
    parameters: dict[str, JsonValue] = Field(default_factory=dict)


class ChoiceChange(Edge):
    """Another choice, or other parameters of the one in use; what is left out stays as it is."""

    name: Name | None = None
    parameters: dict[str, JsonValue] = Field(default_factory=dict)


class SelectionBody(Edge):
    """A whole selection."""

    controller: ChoiceBody
    trajectory: ChoiceBody
    gait: GaitSettings


class GaitChange(Edge):
    """Some fields of the gait, checked together with the rest as `GaitSettings`."""

    sweep_deg: float | None = None
    tilt_deg: float | None = None
    field_mT: float | None = None
    max_rate_deg_s: float | None = None
    path_step_s: float | None = None
    time_law: TimeLawName | None = None
    speed_mm_s: float | None = None
    acceleration_mm_s2: float | None = None
    wait_mm: float | None = None
    approach: bool | None = None


class SelectionChange(Edge):
    """Some parts of a selection; the others stay as they are."""

    controller: ChoiceChange = ChoiceChange()
    trajectory: ChoiceChange = ChoiceChange()
    gait: GaitChange = GaitChange()


class RunBody(SelectionChange):
    """A run to start; what is left out comes from the selection."""

    passes: Passes = 1.0
    duration_s: Duration | None = None
    unattended: bool = False
    label: Label = ""
    tags: Tags = Field(default=[])


class PreviewBody(ChoiceBody):
    """A trajectory to look at."""


class CustomPathBody(Edge):
    """A path to save: straight pieces or a smooth curve through points."""

    name: PathName
    points_mm: Annotated[list[PointMM], Field(min_length=2, max_length=2_000)]
    closed: bool = True
    kind: Smoothing = "polyline"
    speed_mm_s: Annotated[float, Field(ge=SLOWEST_MM_S, le=50.0)] = 3.0


class RenameBody(Edge):
    """Another name for a saved path."""

    name: PathName


class PointsTextBody(Edge):
    """The text of a file of points."""

    text: Annotated[str, Field(max_length=900_000)]
