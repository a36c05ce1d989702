"""What every section of the rig file is: strict, frozen, of finite numbers; and what is wrong with one, in words."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from control.wrong_values import in_words

__all__ = ["NOT_MEASURED", "Positive", "Section", "in_words"]

Positive = Annotated[float, Field(gt=0.0)]
NOT_MEASURED = "not measured"
"""What stands for the source of figures that are assumed."""


class Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, use_attribute_docstrings=True)
