"""How long runs are kept: old ones go by their age, the oldest by the space that all take; pinned ones stay."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from server.catalogue.deleting import delete_run, finish_deletions
from server.catalogue.errors import NoSuchRun, NotNow
from server.catalogue.records import Loose
from server.catalogue.shelf import Shelf

GB = 1e9
"""Bytes."""
OLDEST = timedelta(days=36_500)
"""No run is older than a hundred years; a larger age would not be a date any more."""


@dataclass(frozen=True, slots=True)
class Policy:
    """keep_days: older runs go.  keep_GB: the oldest go while all recordings together are larger.  0: for ever."""

    keep_days: float = 0.0
    keep_GB: float = 0.0


def prunable(shelf: Shelf, policy: Policy, now: datetime | None = None) -> list[Loose]:
    """What `prune` would delete, oldest first; never what is pinned or goes on. Raises `CatalogueError`."""
    catalogue = shelf.catalogue
    by_age = timedelta(days=policy.keep_days) if policy.keep_days > 0.0 else OLDEST
    eldest = (now or datetime.now(UTC)) - min(by_age, OLDEST)
    excess = catalogue.totals().size - policy.keep_GB * GB if policy.keep_GB > 0.0 else 0.0
    return list(_chosen(catalogue.loose(None if excess > 0.0 else eldest), eldest, excess))


def _chosen(runs: list[Loose], eldest: datetime, excess: float) -> Iterator[Loose]:
    """excess: bytes that have to go; a run without a recording frees nothing."""
    for run in runs:
        if run.started_at < eldest or (excess > 0.0 and run.size_bytes > 0):
            excess -= run.size_bytes
            yield run


def prune(shelf: Shelf, policy: Policy, now: datetime | None = None) -> list[Loose]:
    """Delete what the policy no longer keeps; what has gone. Raises `CatalogueError`."""
    finish_deletions(shelf)
    return [run for run in prunable(shelf, policy, now) if _is_deleted(shelf, run.id)]


def _is_deleted(shelf: Shelf, id: str) -> bool:
    """Not what somebody has pinned or deleted at this instant."""
    try:
        delete_run(shelf, id)
    except (NotNow, NoSuchRun):
        return False
    return True
