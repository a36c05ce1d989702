"""The sections of a study's definition; the lab's units, in the names."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, JsonValue, field_validator

from control.edge import Edge, Name

MOST_TUNED = 1000
"""Runs that a search learns from: the time of each proposal grows with their cube, to a quarter of a minute here."""

PlaceMM = Annotated[float, Field(ge=-500.0, le=500.0)]


class ChoiceSection(Edge):
    """A controller, trajectory or plant by name; parameters that are left out keep their defaults."""

    name: Name
    parameters: dict[str, JsonValue] = Field(default_factory=dict)

    @field_validator("parameters", mode="after")
    @classmethod
    def _without_none(cls, parameters: dict[str, Any]) -> dict[str, Any]:
        """Nothing given is nothing written: TOML has no word for it."""
        given = {name: value for name, value in parameters.items() if value is not None}
        for name, value in given.items():
            if _holds_none(value):
                raise ValueError(f"{name} holds a null, which a study's file has no word for; leave it out")
        return given


def _holds_none(value: Any) -> bool:
    """Whether there is one anywhere inside."""
    if isinstance(value, dict):
        return any(map(_holds_none, value.values()))
    return any(map(_holds_none, value)) if isinstance(value, list) else value is None


class SetupSection(Edge):
    """The rig that a batch stands for; a rig has its own.

    length: between the robot's pivots.  workspace: the side of the square in which the centre may be.
    ramp: of the field's elevation at a pivot switch.
    """

    length_mm: Annotated[float, Field(gt=0.0, le=100.0, json_schema_extra={"unit": "mm"})] = 10.0
    workspace_mm: Annotated[float, Field(gt=0.0, le=1000.0, json_schema_extra={"unit": "mm"})] = 120.0
    ramp_ms: Annotated[
        float, Field(ge=1.0, le=1000.0, title="Elevation ramp", json_schema_extra={"unit": "ms"})
    ] = 50.0


class StartSection(Edge):
    """Where each run starts; what is left out: at the path's first point, heading along it.

    scatter: standard deviations of a batch's starts about that, drawn for each run. A rig walks back to the
    start itself, as near as `[rig]` asks for.
    """

    x_mm: PlaceMM | None = None
    y_mm: PlaceMM | None = None
    heading_deg: Annotated[float, Field(ge=-360.0, le=360.0)] | None = None
    scatter_mm: Annotated[float, Field(ge=0.0, le=10.0)] = 0.0
    scatter_deg: Annotated[float, Field(ge=0.0, le=180.0)] = 0.0


class LatinSection(Edge):
    """sets: points of the Latin hypercube."""

    sets: Annotated[int, Field(ge=1, le=10_000)] = 50


class StopSection(Edge):
    """When a study ends before its last run. 0: never for that reason.

    failed_in_a_row: runs.  hours: since it was started or resumed.  half_width_percent: a set gets no more
    repeats once half of the 95 % interval of its ME is at most this share of the ME.
    """

    failed_in_a_row: Annotated[int, Field(ge=0, le=1000)] = 3
    hours: Annotated[float, Field(ge=0.0, le=1000.0)] = 0.0
    half_width_percent: Annotated[float, Field(ge=0.0, le=100.0)] = 0.0


class RigSection(Edge):
    """How a campaign treats a rig.

    rest: of the armed robot at its start, before each run.  start_within: how near the start a run may begin.
    attempts: at one run.  cool_to: of the coils' allowed heat, before each run.  wait: for a person, or for a
    cause to go.
    """

    rest_s: Annotated[float, Field(ge=0.0, le=3600.0)] = 1.0
    start_within_mm: Annotated[float, Field(ge=0.2, le=20.0)] = 1.0
    start_within_deg: Annotated[float, Field(ge=1.0, le=180.0)] = 5.0
    attempts: Annotated[int, Field(ge=1, le=20)] = 3
    cool_to_percent: Annotated[float, Field(gt=0.0, le=100.0)] = 60.0
    wait_minutes: Annotated[float, Field(ge=0.0, le=10_000.0)] = 30.0


Minimised = Literal[
    "normalized_mean_error", "mean_error_mm", "rms_error_mm", "max_error_mm", "end_error_mm",
    "steps", "travelled_mm", "sweeps", "reversals",
]  # fmt: skip


class TuneSettings(Edge):
    """How the best set is looked for.

    budget: runs in all.  first: points all over the axes before anything is learned.  at_once: points chosen
    together.  confirm: last runs of the budget, all at the best point.  enough_percent: the search ends once
    less improvement than this is expected; 0: never.
    """

    budget: Annotated[int, Field(ge=4, le=MOST_TUNED)] = 50
    first: Annotated[int, Field(ge=2, le=1000)] = 12
    at_once: Annotated[int, Field(ge=1, le=64)] = 4
    minimise: Minimised = "normalized_mean_error"
    confirm: Annotated[int, Field(ge=0, le=1000)] = 6
    enough_percent: Annotated[float, Field(ge=0.0, le=100.0)] = 0.0
