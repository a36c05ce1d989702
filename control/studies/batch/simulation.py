"""Runs of a batch, each by itself: what a run gives does not depend on the others in the list."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from control.metrics import Metrics
from control.simulation.plants import MissingExtra
from control.studies.batch.compiled import Prepared, prepared, walk_prepared
from control.studies.batch.outcome import Failed, RunFailed
from control.studies.batch.plain import plain_walk

if TYPE_CHECKING:
    from control.studies.plan import PlannedRun


def simulate(runs: Sequence[PlannedRun]) -> list[Metrics | Failed]:
    """The figures of each run, in order; never raises for what a run does. Raises `MissingExtra`."""
    return [_figures(run) for run in runs]


def _figures(run: PlannedRun) -> Metrics | Failed:
    try:
        compiled = _prepared(run)
        return walk_prepared(compiled) if compiled is not None else _walked(run)
    except RunFailed as failed:
        return Failed(str(failed))


def _prepared(run: PlannedRun) -> Prepared | None:
    with _anyones_code():
        return prepared(run)


def _walked(run: PlannedRun) -> Metrics:
    with _anyones_code():
        return plain_walk(run)


@contextmanager
def _anyones_code() -> Iterator[None]:
    """Controllers, paths and plants may be anyone's, and raise whatever they like: it is their run that fails.

    What is not installed is no matter of the run, and would be a result for ever.
    """
    try:
        yield
    except (RunFailed, MissingExtra):
        raise
    except Exception as error:
        raise RunFailed(f"the run could not be walked: {type(error).__name__}: {error}") from error
