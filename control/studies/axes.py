"""An axis of a study: what is varied, and which values it may take, in the lab's units."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, field_validator, model_validator

from control.edge import Edge
from control.gait_settings import GaitSettings
from control.studies.sections import SetupSection

MOST_VALUES = 1000
"""Values of one axis: more than any figure can show."""
ROUNDING = 1e-9
"""A step that misses the end of its range by rounding alone still counts."""
DIGITS = 12
"""Values of a range are rounded to so many digits, so that 0.1 + 0.1 + 0.1 is 0.3."""

LONGEST_NAME = 200


def _scalar(value: Any) -> Any:
    """One complaint, instead of one for each kind that the value is not."""
    if not isinstance(value, bool | int | float | str):
        raise ValueError("a value is a number, a name or a switch")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("a number has to be finite")
    if isinstance(value, str) and not len(value) <= LONGEST_NAME:
        raise ValueError(f"a name has at most {LONGEST_NAME} characters")
    return value


Scalar = Annotated[bool | int | float | str, BeforeValidator(_scalar)]
"""A number in the lab's unit, a name, or a switch."""

NAMED = ("controller", "trajectory", "plant")
"""What may also be varied by name."""
FIELDS = {"gait": tuple(GaitSettings.model_fields), "setup": tuple(SetupSection.model_fields)}

AXIS = re.compile(r"controller|trajectory|plant|(controller|trajectory|gait|plant|setup)\.[A-Za-z_]\w*")


def known_axis(name: str) -> str:
    """`gait.X` and `setup.X` are known by their fields, the other parameters when the sets are looked at."""
    if not AXIS.fullmatch(name):
        raise ValueError(
            f"nothing is called {name!r}; an axis is of controller, trajectory or plant, or of one parameter: "
            "controller.X, trajectory.X, gait.X, plant.X or setup.X"
        )
    subject, _, field = name.partition(".")
    fields = FIELDS.get(subject, ())
    if fields and field not in fields:
        raise ValueError(f"{subject} has no {field!r}; choose one of: {', '.join(fields)}")
    return name


AxisName = Annotated[str, AfterValidator(known_axis)]


def whole_as_int(value: Any) -> Any:
    """20.0 is 20, so that a study from a form and one from a file read the same."""
    if isinstance(value, float) and math.isfinite(value) and value == int(value) and abs(value) < 1e15:
        return int(value)
    return value


class Axis(Edge):
    """Either `values`, or a range `from` - `to`, in a grid with a `step`."""

    model_config = ConfigDict(populate_by_name=True)

    of: AxisName
    values: Annotated[tuple[Scalar, ...], Field(min_length=1, max_length=MOST_VALUES)] | None = None
    first: float | None = Field(default=None, alias="from")
    last: float | None = Field(default=None, alias="to")
    step: Annotated[float, Field(gt=0.0)] | None = None

    @field_validator("values", mode="after")
    @classmethod
    def _readable(cls, values: tuple[Scalar, ...] | None) -> tuple[Scalar, ...] | None:
        if values is None:
            return None
        plain = tuple(whole_as_int(value) for value in values)
        seen: set[tuple[bool, Scalar]] = set()
        for value in plain:
            key = (isinstance(value, bool), value)
            if key in seen:
                raise ValueError(f"{value!r} is there twice; give it once, and ask for more repeats instead")
            seen.add(key)
        return plain

    @model_validator(mode="after")
    def _one_way(self) -> Axis:
        if self.values is not None and (self.first, self.last, self.step) == (None, None, None):
            return self
        if self.values is not None or self.first is None or self.last is None:
            raise ValueError(f"the axis {self.of} needs either values = [...], or from = ... and to = ...")
        if self.of in NAMED:
            raise ValueError(f"the axis {self.of} takes names: give values = [...] instead of a range")
        if not self.first <= self.last:
            raise ValueError(
                f"the axis {self.of} goes from {self.first} to {self.last}: give the smaller one first"
            )
        if self.step is not None and not (self.last - self.first) / self.step <= MOST_VALUES:
            raise ValueError(
                f"the axis {self.of} would take more than {MOST_VALUES} values; give a larger step"
            )
        return self

    @property
    def choices(self) -> tuple[Scalar, ...] | None:
        """The values in their order; None where every number of the range is one."""
        if self.values is not None:
            return self.values
        if self.step is None or self.first is None or self.last is None:
            return None
        count = math.floor((self.last - self.first) / self.step + ROUNDING) + 1
        return tuple(whole_as_int(_rounded(self.first + k * self.step)) for k in range(count))

    def value(self, share: float) -> Scalar:
        """The value at this share (0 <= share < 1) of the axis: equal shares for each choice, or the range's own."""
        choices = self.choices
        if choices is not None:
            return choices[min(int(share * len(choices)), len(choices) - 1)]
        if self.first is None or self.last is None:
            raise ValueError(f"the axis {self.of} has neither values nor a range")
        return whole_as_int(_rounded(self.first + share * (self.last - self.first)))


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
