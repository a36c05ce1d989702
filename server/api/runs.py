"""Runs: start one, change it while it goes on, hold it, end it, and look back at this session's."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import Field

from control.metrics import Metrics
from control.runs import Run, RunRequest, RunState
from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.choices import change, selection_json
from server.api.problems import Problem, Rejected, not_found
from server.api.schemas import RunBody, SelectionChange
from server.api.ticks import MILLI, number, scaled

router = APIRouter(tags=["runs"], route_class=StrictRoute)

PAGE = 50
"""Runs in one answer unless asked otherwise."""


def metrics_json(metrics: Metrics) -> dict[str, Any]:
    return {
        "mean_error_mm": scaled(metrics.mean_error, MILLI, 6),
        "normalized_mean_error": number(metrics.normalized_mean_error, 6),
        "rms_error_mm": scaled(metrics.rms_error, MILLI, 6),
        "max_error_mm": scaled(metrics.max_error, MILLI, 6),
        "end_error_mm": scaled(metrics.end_error, MILLI, 6),
        "travelled_mm": scaled(metrics.travelled, MILLI),
        "duration_s": number(metrics.duration),
        "ticks": metrics.ticks,
        "steps": metrics.steps,
        "sweeps": metrics.sweeps,
        "reversals": metrics.reversals,
    }


def run_json(run: Run) -> dict[str, Any]:
    request = run.request
    return {
        "id": run.id,
        "label": request.label,
        "tags": list(request.tags),
        "state": run.state.value,
        "reason": run.reason,
        "started_at": run.started_at.isoformat(timespec="milliseconds").replace("+00:00", "Z"),
        "passes": request.passes,
        "duration_s": request.duration,
        "unattended": request.unattended,
        **selection_json(request.selection),
        "metrics": None if run.metrics is None else metrics_json(run.metrics),
    }


@router.post("/runs", status_code=201)
async def start(rig: TheRig, body: RunBody | None = None) -> dict[str, Any]:
    """Start a run; what is left out comes from the selection."""
    body = body or RunBody()
    request = RunRequest(
        change(rig.selection, body),
        passes=body.passes,
        duration=body.duration_s,
        unattended=body.unattended,
        label=body.label,
        tags=tuple(body.tags),
    )
    return run_json(await rig.start_run(request))


@router.get("/runs")
async def list_runs(
    rig: TheRig,
    cursor: Annotated[str | None, Query(max_length=80)] = None,
    limit: Annotated[int, Query(ge=1, le=500)] = PAGE,
) -> dict[str, Any]:
    """Newest first; `next` is the cursor of the following page, or null."""
    runs = list(rig.runs)
    first = 0 if cursor is None else position(runs, cursor) + 1
    page = runs[first : first + limit]
    more = first + limit < len(runs)
    return {"runs": [run_json(run) for run in page], "next": page[-1].id if more else None}


@router.get("/runs/{run_id}")
async def one(run_id: Annotated[str, Field(max_length=80)], rig: TheRig) -> dict[str, Any]:
    runs = list(rig.runs)
    if run_id == "current":
        return run_json(current(runs))
    return run_json(runs[position(runs, run_id)])


@router.patch("/runs/current")
async def alter(body: SelectionChange, rig: TheRig) -> dict[str, Any]:
    """Another controller, trajectory or gait, or other parameters of them, while the robot walks."""
    current(list(rig.runs))
    return run_json(await rig.change_run(lambda selection: change(selection, body)))


@router.post("/runs/current/stop")
async def stop(rig: TheRig) -> dict[str, Any]:
    """End the run; the rig stays armed."""
    await rig.stop_run()
    return newest(rig)


@router.post("/runs/current/pause")
async def pause(rig: TheRig) -> dict[str, Any]:
    """Hold the run with the coils at zero."""
    await rig.pause_run()
    return newest(rig)


@router.post("/runs/current/resume")
async def resume(rig: TheRig) -> dict[str, Any]:
    """Go on from where the run was held; a rig that was held without a run is armed again (its state)."""
    await rig.resume_run()
    return newest(rig) if rig.snapshot.run is not None else ticks.state(rig.snapshot)


def newest(rig: TheRig) -> dict[str, Any]:
    return run_json(rig.runs[0])


def current(runs: list[Run]) -> Run:
    if not runs or runs[0].state is not RunState.RUNNING:
        raise Rejected(Problem(409, "No run", "There is no run at the moment; arm the rig and start one."))
    return runs[0]


def position(runs: list[Run], run_id: str) -> int:
    for index, run in enumerate(runs):
        if run.id == run_id:
            return index
    raise not_found(f"There is no run {run_id!r} in this session.")
