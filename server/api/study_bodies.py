"""Studies as they cross the edge towards the server: a definition as JSON or as the text of a TOML file."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from typing import Annotated, Any, Self

from pydantic import Field, JsonValue, ValidationError, model_validator

from control.studies.definition import StudyDefinition
from control.studies.table import METRICS
from server.api.problems import Problem, Rejected, invalid, offence, offences
from server.api.schemas import Edge

LONGEST_FILE = 200_000
"""Characters of a definition; ten thousand listed sets are more than anybody writes."""
DEEPEST_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){20}""")
"""A key of so many parts belongs to no study, and Python's reader of TOML takes minutes for one of thousands."""


class DefinitionBody(Edge):
    """Either `definition`, as JSON, or `toml`, the text of a file."""

    definition: dict[str, JsonValue] | None = None
    toml: Annotated[str | None, Field(max_length=LONGEST_FILE)] = None

    @model_validator(mode="after")
    def _one_of_them(self) -> Self:
        if (self.definition is None) == (self.toml is None):
            raise ValueError("send either definition (JSON) or toml (the text of a file)")
        return self

    def read(self) -> StudyDefinition:
        """Raises `Rejected` with every wrong field. For a worker thread: thousands of sets take seconds."""
        return definition_of(self.definition if self.definition is not None else _parsed(self.toml or ""))


Jobs = Annotated[int, Field(ge=0, le=256, description="Processes of a batch; 0: one a core.")]


class Begin(Edge):
    """Go on with a study. consent: to current through the coils of a real rig, while nobody looks."""

    consent: bool = False
    jobs: Jobs = 0


class StudyBody(DefinitionBody):
    """A study to make. begin: at once.  consent, jobs: as in `Begin`."""

    begin: bool = True
    consent: bool = False
    jobs: Jobs = 0

    @property
    def how(self) -> Begin:
        return Begin(consent=self.consent, jobs=self.jobs)


Metric = Annotated[str | None, Field(max_length=40, json_schema_extra={"enum": list(METRICS)})]


def metric_of(name: str | None, usual: str) -> str:
    """Raises `Rejected` for what is no metric."""
    if name is None or name in METRICS:
        return name or usual
    raise Rejected(invalid([offence(("metric",), f"{name[:40]!a} is no metric", ", ".join(METRICS))]))


def definition_of(raw: Mapping[str, Any]) -> StudyDefinition:
    try:
        return StudyDefinition.model_validate_json(json.dumps(raw))
    except ValidationError as error:
        raise Rejected(wrong(offences(error.errors()))) from None
    except (TypeError, ValueError, RecursionError) as error:  # TOML has dates, and no end of nesting
        raise Rejected(wrong([offence((), f"this is no study: {error}")])) from None


def _parsed(text: str) -> Mapping[str, Any]:
    if DEEPEST_KEY.search(text):
        raise Rejected(wrong([offence((), "this is no study: a key has more than 20 parts")]))
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise Rejected(wrong([offence((), f"this is no TOML: {error}")])) from None


def wrong(errors: list[dict[str, Any]]) -> Problem:
    """A value that may be of several kinds is complained of once for each; the first says enough."""
    told: dict[str, dict[str, Any]] = {}
    for error in errors:
        told.setdefault(_place(error["loc"]), error)
    return invalid(told.values())


def _place(location: list[Any]) -> str:
    """Without what pydantic calls the kinds that it has tried."""
    kinds = ("bool", "int", "float", "constrained-str", "str")
    return ".".join(str(part) for part in location if part not in kinds)
