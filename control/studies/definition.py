"""A study's definition: one strict model in the lab's units, the same from a TOML file and from JSON."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from itertools import chain
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, StringConstraints, ValidationError, field_validator, model_validator

from control.edge import Duration, Edge, Passes
from control.gait_settings import GaitSettings
from control.studies.axes import Axis, AxisName, Scalar, whole_as_int
from control.studies.errors import StudyError
from control.studies.sections import (
    ChoiceSection,
    LatinSection,
    RigSection,
    SetupSection,
    StartSection,
    StopSection,
    TuneSettings,
)
from control.wrong_values import in_words

if TYPE_CHECKING:
    from control.studies.plan import Plan

MOST_SETS = 10_000
MOST_RUNS = 1_000_000
"""A batch of a million runs takes hours and its table a gigabyte; more is a typing error."""
MOST_AXES = 12

DESIGNS = ("axes", "sets", "latin", "tune")
"""Parts that only some designs have a use for."""

Order = Literal["blocked", "random", "listed"]
StudyName = Annotated[str, StringConstraints(min_length=1, max_length=80, pattern=r"^[^\x00-\x1f\x7f]+$")]
Values = Annotated[dict[AxisName, Scalar], Field(min_length=1)]


class StudyDefinition(Edge):
    """What to vary, how often, in which order and on what. `[plant]`, `[setup]` and the starts' scatter are a
    batch's only, `[rig]` is a rig's only; a definition may hold both, and run on either."""

    name: StudyName
    on: Literal["batch", "rig"] = "batch"
    design: Literal["grid", "list", "latin", "tune"] = "grid"
    repeats: Annotated[int, Field(ge=1, le=100_000)] = 1
    order: Order = "blocked"
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 1
    passes: Passes = 1.0
    duration_s: Duration | None = None
    controller: ChoiceSection = ChoiceSection(name="geometric")
    trajectory: ChoiceSection = ChoiceSection(name="eight")
    gait: GaitSettings = GaitSettings()
    plant: ChoiceSection = ChoiceSection(name="slip")
    setup: SetupSection = SetupSection()
    start: StartSection = StartSection()
    axes: Annotated[tuple[Axis, ...], Field(max_length=MOST_AXES)] = ()
    sets: Annotated[tuple[Values, ...], Field(max_length=MOST_SETS)] = ()
    latin: LatinSection = LatinSection()
    tune: TuneSettings = TuneSettings()
    stop: StopSection = StopSection()
    rig: RigSection = RigSection()

    @field_validator("sets", mode="before")
    @classmethod
    def _flat(cls, sets: Any) -> Any:
        """`gait.tilt_deg = 20` in a TOML table means `"gait.tilt_deg" = 20`."""
        if not isinstance(sets, list | tuple):
            return sets
        return tuple(_flattened(one) if isinstance(one, Mapping) else one for one in sets)

    @field_validator("sets", mode="after")
    @classmethod
    def _readable(cls, sets: tuple[dict[str, Scalar], ...]) -> tuple[dict[str, Scalar], ...]:
        return tuple({axis: whole_as_int(value) for axis, value in one.items()} for one in sets)

    @model_validator(mode="after")
    def _fits_together(self) -> StudyDefinition:
        from control.studies.consistency import check

        check(self)
        return self

    @property
    def axis_names(self) -> tuple[str, ...]:
        """What is varied, in the order of the definition."""
        if self.design == "list":
            return tuple(dict.fromkeys(axis for one in self.sets for axis in one))
        return tuple(axis.of for axis in self.axes)

    def walks_along(self, trajectory: str) -> bool:
        """Whether some of its runs may take the trajectory of that name."""
        varied = (axis.values or () for axis in self.axes if axis.of == "trajectory")
        listed = (one.get("trajectory") for one in self.sets)
        return trajectory in (self.trajectory.name, *chain.from_iterable(varied), *listed)

    @classmethod
    def from_toml(cls, text: str) -> StudyDefinition:
        """Raises `StudyError`."""
        try:
            raw = tomllib.loads(text)
        except (ValueError, RecursionError) as error:
            raise StudyError(f"this is no TOML: {error}") from None
        return cls.from_json(raw)

    @classmethod
    def from_json(cls, raw: Mapping[str, Any]) -> StudyDefinition:
        """Raises `StudyError`, with a line for each wrong value."""
        try:
            return cls.model_validate_json(json.dumps(raw))
        except ValidationError as error:
            words = in_words(error).replace("Value error, ", "")
            raise StudyError(f"this is no study that can be carried out:\n{words}") from None
        except (TypeError, ValueError, RecursionError) as error:
            raise StudyError(f"this is no study: {error}") from None

    def to_json(self) -> dict[str, Any]:
        """Whole, defaults included, so that it means the same when they change; without what its design has no
        use for."""
        whole = self.model_dump(mode="json", by_alias=True, exclude_none=True)
        idle = [name for name in DESIGNS if getattr(self, name) == type(self).model_fields[name].default]
        return {name: value for name, value in whole.items() if name not in idle or name == self.design}

    def to_toml(self) -> str:
        """As `to_json`."""
        import tomlkit

        return tomlkit.dumps(self.to_json())

    def plan(self) -> Plan:
        """The runs that this definition asks for; `control.studies.checking` says whether each of them can be."""
        from control.studies.plan import plan_of

        return plan_of(self)


def _flattened(table: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in table.items():
        if isinstance(value, Mapping):
            flat.update(_flattened(value, f"{above}{name}."))
        else:
            flat[f"{above}{name}"] = value
    return flat
