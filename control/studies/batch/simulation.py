"""Runs of a batch, each by itself: what a run gives does not depend on the others in the list."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from control.metrics import Metrics
from control.studies.batch.compiled import prepared, walk_prepared
from control.studies.batch.outcome import Failed, RunFailed
from control.studies.batch.plain import plain_walk

if TYPE_CHECKING:
    from control.studies.plan import PlannedRun


def simulate(runs: Sequence[PlannedRun]) -> list[Metrics | Failed]:
    """The figures of each run, in order; never raises for what a run does."""
    return [_figures(run) for run in runs]


def _figures(run: PlannedRun) -> Metrics | Failed:
    try:
        compiled = prepared(run)
        return plain_walk(run) if compiled is None else walk_prepared(compiled)
    except RunFailed as failed:
        return Failed(str(failed))
    except Exception as error:  # noqa: BLE001 (controllers and paths may be anyone's code)
        return Failed(f"the run could not be walked: {type(error).__name__}: {error}")
