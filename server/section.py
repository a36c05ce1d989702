"""What every section of the rig file is: strict, frozen, of finite numbers; and what is wrong with one, in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError

Positive = Annotated[float, Field(gt=0.0)]
NOT_MEASURED = "not measured"
"""What stands for the source of figures that are assumed."""


class Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def _nowhere(_: tuple[str | int, ...]) -> str:
    return ""


def in_words(error: ValidationError, place: Callable[[tuple[str | int, ...]], str] = _nowhere) -> str:
    """One line for each wrong value: its name, what is wrong with it, what was given, and where `place` finds it."""
    lines = []
    for problem in error.errors(include_url=False):
        where = ".".join(str(part) for part in problem["loc"]) or "the whole file"
        is_one_value = problem["type"] not in ("missing", "extra_forbidden") and not isinstance(
            problem["input"], dict
        )
        given = f" (given: {problem['input']!r})" if is_one_value else ""
        lines.append(f"  {where}: {problem['msg']}{given}{place(problem['loc'])}")
    return "\n".join(lines)
