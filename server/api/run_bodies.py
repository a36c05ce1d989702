"""What can be asked of the catalogue, as it crosses the edge."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field, model_validator

from server.api.schemas import Edge, Label, Tags
from server.catalogue.records import RunQuery
from server.catalogue.retention import Policy

PAGE = 50
"""Runs in one answer unless asked otherwise."""
LARGEST_PAGE = 500
LONGEST_NOTE = 20_000
"""Characters."""

Sought = Annotated[str, Field(max_length=200)]
OlderThan = Annotated[float, Field(gt=0.0, le=36_500.0, description="Days.")]
UntilSize = Annotated[float, Field(gt=0.0, le=1e6, description="GB of all recordings together.")]


class RunFilter(BaseModel):
    """Which runs are listed; what is left out does not matter. text: words that all occur."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    cursor: Annotated[str | None, Field(max_length=400)] = None
    limit: Annotated[int, Field(ge=1, le=LARGEST_PAGE)] = PAGE
    state: Sought = ""
    controller: Sought = ""
    trajectory: Sought = ""
    tag: Sought = ""
    study: Sought = ""
    text: Sought = ""
    simulated: bool | None = None
    pinned: bool | None = None
    since: AwareDatetime | None = None
    until: AwareDatetime | None = None

    def query(self) -> RunQuery:
        return RunQuery(**self.model_dump(exclude={"cursor", "limit"}))


class RunEdit(Edge):
    """What a person writes about a run; what is left out stays as it is."""

    label: Label | None = None
    tags: Tags | None = None
    notes: Annotated[str | None, Field(max_length=LONGEST_NOTE)] = None
    pinned: bool | None = None


class PruneBody(Edge):
    """Which runs go. dry_run: only say which ones would."""

    older_than_days: OlderThan | None = None
    until_size_GB: UntilSize | None = None
    dry_run: bool = False

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if self.older_than_days is None and self.until_size_GB is None:
            raise ValueError("say which runs may go: older_than_days, until_size_GB or both")
        return self

    def policy(self) -> Policy:
        return Policy(keep_days=self.older_than_days or 0.0, keep_GB=self.until_size_GB or 0.0)
