"""What every model at the edge is, and the values that several of them share; lab units, in the name or as `unit`."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Name = Annotated[str, StringConstraints(min_length=1, max_length=80)]
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


class Edge(BaseModel):
    """Strict: unknown fields, NaN, infinity and numbers in quotes are refused."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)
