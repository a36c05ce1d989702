"""What crosses the edge, in the lab's units: the one place where they become SI and SI becomes them.

Every model is strict: unknown fields, NaN, infinity and numbers in quotes are refused.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, cast

from pydantic import BaseModel, ConfigDict, Field, JsonValue, StringConstraints

from control.gait import Gait, TimeLaw
from control.trajectories.fields import SLOWEST_MM_S
from control.trajectories.waypoints import Smoothing

MM = 1e-3
MT = 1e-3

Name = Annotated[str, StringConstraints(min_length=1, max_length=80)]
PathName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]{0,59}$")]
Label = Annotated[str, StringConstraints(max_length=200)]
Tag = Annotated[str, StringConstraints(min_length=1, max_length=40)]
Tags = Annotated[list[Tag], Field(max_length=20)]
PointMM = Annotated[list[Annotated[float, Field(ge=-500.0, le=500.0)]], Field(min_length=2, max_length=2)]
Passes = Annotated[
    float,
    Field(
        gt=0.0,
        le=1000.0,
        title="Passes",
        description="How often to walk the path.",
        json_schema_extra={"unit": "1"},
    ),
]
Duration = Annotated[
    float,
    Field(
        gt=0.0,
        le=86400.0,
        title="Duration",
        description="End after this time.",
        json_schema_extra={"unit": "s"},
    ),
]


TimeLawName = Literal["path_step", "constant_speed", "trapezoidal", "wait"]


class Edge(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


def angle(default: float, **limits: Any) -> Any:
    return Field(default=default, json_schema_extra={"unit": "°"}, **limits)


class GaitSettings(Edge):
    """How the robot walks."""

    sweep_deg: float = angle(
        30.0, ge=1.0, le=350.0, title="Sweep", description="Turn about one pivot before it may change."
    )
    tilt_deg: float = angle(
        25.0, ge=5.0, le=45.0, title="Tilt", description="Elevation of the field that presses the pivot down."
    )
    field_mT: float = Field(
        default=10.0, gt=0.0, lt=15.0, title="Field", description="Strength of the field at the robot.",
        json_schema_extra={"unit": "mT"},
    )  # fmt: skip
    max_rate_deg_s: float = Field(
        default=114.6, gt=0.0, lt=360.0, title="Fastest swing", description="Upper limit of the swing rate.",
        json_schema_extra={"unit": "°/s"},
    )  # fmt: skip
    path_step_s: float = Field(
        default=0.1, gt=0.0, lt=1.0, title="Path step",
        description="Path time that passes every 0.1 s: 0.1 is the path's own speed, 0.2 twice that.",
        json_schema_extra={"unit": "s"},
    )  # fmt: skip
    time_law: TimeLawName = Field(
        default="path_step", title="Time law",
        description=(
            "How the reference moves: by the path step; at constant speed; from rest to rest; "
            "or no farther than the robot follows."
        ),
    )  # fmt: skip
    speed_mm_s: float = Field(
        default=3.0, ge=SLOWEST_MM_S, le=50.0, title="Path speed",
        description="Of the reference, by every time law but the path step.",
        json_schema_extra={"unit": "mm/s"},
    )  # fmt: skip
    acceleration_mm_s2: float = Field(
        default=2.0, ge=0.001, le=1000.0, title="Acceleration", description="Of the trapezoidal time law.",
        json_schema_extra={"unit": "mm/s²"},
    )  # fmt: skip
    wait_mm: float = Field(
        default=5.0, ge=0.5, le=50.0, title="Wait",
        description="How far ahead of the robot the reference goes before it waits, by the time law wait.",
        json_schema_extra={"unit": "mm"},
    )  # fmt: skip
    approach: bool = Field(
        default=False, title="Approach",
        description="Walk straight to the start of the path first; errors count from there.",
    )  # fmt: skip

    def to_si(self) -> Gait:
        return Gait(
            sweep=math.radians(self.sweep_deg),
            tilt=math.radians(self.tilt_deg),
            field=self.field_mT * MT,
            max_rate=math.radians(self.max_rate_deg_s),
            path_step=self.path_step_s,
            time_law=TimeLaw(self.time_law),
            speed=self.speed_mm_s * MM,
            acceleration=self.acceleration_mm_s2 * MM,
            wait_distance=self.wait_mm * MM,
            approach=self.approach,
        )

    @classmethod
    def from_si(cls, gait: Gait) -> GaitSettings:
        """Rounded to six digits, so that 30 degrees come back as 30."""
        return cls(
            sweep_deg=rounded(math.degrees(gait.sweep)),
            tilt_deg=rounded(math.degrees(gait.tilt)),
            field_mT=rounded(gait.field / MT),
            max_rate_deg_s=rounded(math.degrees(gait.max_rate)),
            path_step_s=rounded(gait.path_step),
            time_law=cast(TimeLawName, gait.time_law.value),
            speed_mm_s=rounded(gait.speed / MM),
            acceleration_mm_s2=rounded(gait.acceleration / MM),
            wait_mm=rounded(gait.wait_distance / MM),
            approach=gait.approach,
        )


def rounded(value: float) -> float:
    return float(f"{value:.6g}")


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
    tags: Tags = []


class PreviewBody(ChoiceBody):
    """A trajectory to look at."""


class CustomPathBody(Edge):
    """A path to save: straight pieces or a smooth curve through points."""

    name: PathName
    points_mm: Annotated[list[PointMM], Field(min_length=2, max_length=2_000)]
    closed: bool = True
    kind: Smoothing = "polyline"
    speed_mm_s: Annotated[float, Field(ge=SLOWEST_MM_S, le=50.0)] = 3.0
