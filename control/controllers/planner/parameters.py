"""What can be chosen about the planner, in the lab's units."""

from __future__ import annotations

from pydantic import Field

from control.controllers.heading import HeadingParameters


class PlannerParameters(HeadingParameters):
    early_end: bool = Field(
        default=False,
        title="End sweeps early",
        description="Allow a sweep to end at a part of the sweep angle: more accurate, more steps.",
        json_schema_extra={"live": True},
    )
    switch_weight: float = Field(
        default=0.0, ge=0.0, le=100.0, title="Cost of a switch",
        description="Every pivot switch costs as much as this squared distance over one second.",
        json_schema_extra={"unit": "mm²·s", "live": True},
    )  # fmt: skip
    sweep_weight: float = Field(
        default=0.0, ge=0.0, le=100.0, title="Cost of a sweep",
        description="The same for every sweep: fewer sweeps, larger errors.",
        json_schema_extra={"unit": "mm²·s", "live": True},
    )  # fmt: skip
    effort_weight: float = Field(
        default=0.0, ge=0.0, le=100.0, title="Cost of turning", description="The same per radian turned.",
        json_schema_extra={"unit": "mm²·s/rad", "live": True},
    )  # fmt: skip
    horizon_slots: int = Field(
        default=24, ge=4, le=80, title="Horizon",
        description="How far it looks ahead, in slots of half the fastest sweep.",
        json_schema_extra={"unit": "1"},
    )  # fmt: skip
    beam_width: int = Field(
        default=24, ge=2, le=500, title="Beam width", description="Plans kept at each slot.",
        json_schema_extra={"unit": "1"},
    )  # fmt: skip
    learn_slip: bool = Field(
        default=True, title="Learn the slip", description="Correct the expected slip by what is seen."
    )
