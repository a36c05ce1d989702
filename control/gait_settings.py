"""The gait in the lab's units, as REST, the command line and studies give it: the one place where it becomes SI."""

from __future__ import annotations

import math
from typing import Any, Literal, cast

from pydantic import Field

from control.edge import Edge
from control.gait import Gait, TimeLaw
from control.trajectories.fields import SLOWEST_MM_S

MM = 1e-3
MT = 1e-3

TimeLawName = Literal["path_step", "constant_speed", "trapezoidal", "wait"]


def angle(default: float, usual: tuple[float, float], **limits: Any) -> Any:
    """usual: what a slider spans, °."""
    extra: dict[str, Any] = {"unit": "°", "live": True, "step": 1, "usual": list(usual)}
    return Field(default=default, json_schema_extra=extra, **limits)


class GaitSettings(Edge):
    """How the robot walks. In the schema, `live`: may change while the robot walks; `step`: a sensible change."""

    sweep_deg: float = angle(
        30.0, (5.0, 90.0), ge=1.0, le=350.0, title="Sweep",
        description="Turn about one pivot before it may change.",
    )  # fmt: skip
    tilt_deg: float = angle(
        25.0, (5.0, 45.0), ge=5.0, le=45.0, title="Tilt",
        description="Elevation of the field that presses the pivot down.",
    )  # fmt: skip
    field_mT: float = Field(
        default=10.0, gt=0.0, lt=15.0, title="Field", description="Strength of the field at the robot.",
        json_schema_extra={"unit": "mT", "live": True, "step": 0.5},
    )  # fmt: skip
    max_rate_deg_s: float = Field(
        default=114.6, gt=0.0, lt=360.0, title="Fastest swing", description="Upper limit of the swing rate.",
        json_schema_extra={"unit": "°/s", "live": True, "step": 5},
    )  # fmt: skip
    path_step_s: float = Field(
        default=0.1, gt=0.0, lt=1.0, title="Path step",
        description="Path time that passes every 0.1 s: 0.1 is the path's own speed, 0.2 twice that.",
        json_schema_extra={"unit": "s", "live": True, "step": 0.05},
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
        json_schema_extra={"unit": "mm/s", "live": True, "step": 0.5},
    )  # fmt: skip
    acceleration_mm_s2: float = Field(
        default=2.0, ge=0.001, le=1000.0, title="Acceleration", description="Of the trapezoidal time law.",
        json_schema_extra={"unit": "mm/s²", "live": True, "step": 0.5},
    )  # fmt: skip
    wait_mm: float = Field(
        default=5.0, ge=0.5, le=50.0, title="Wait",
        description="How far ahead of the robot the reference goes before it waits, by the time law wait.",
        json_schema_extra={"unit": "mm", "live": True, "step": 0.5},
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
