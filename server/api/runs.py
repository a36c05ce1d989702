"""Runs: start one, change it while it goes on, hold it, end it."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from control.runs import Run, RunRequest, RunState
from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.choices import change, selection_json
from server.api.operator import TheHand
from server.api.problems import Problem, Rejected
from server.api.schemas import RunBody, SelectionChange
from server.catalogue.record_json import time_text
from server.metrics_json import metrics_json as metrics_json

router = APIRouter(tags=["runs"], route_class=StrictRoute)


def run_json(run: Run) -> dict[str, Any]:
    request = run.request
    return {
        "id": run.id,
        "label": request.label,
        "tags": list(request.tags),
        "state": run.state.value,
        "reason": run.reason,
        "started_at": time_text(run.started_at),
        "passes": request.passes,
        "duration_s": request.duration,
        "unattended": request.unattended,
        **selection_json(request.selection),
        "metrics": None if run.metrics is None else metrics_json(run.metrics),
    }


@router.post("/runs", status_code=201)
async def start(rig: TheRig, hand: TheHand, body: RunBody | None = None) -> dict[str, Any]:
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
    return run_json(await rig.start_run(request, hand.require))


@router.patch("/runs/current")
async def alter(body: SelectionChange, rig: TheRig, hand: TheHand) -> dict[str, Any]:
    """Another controller, trajectory or gait, or other parameters of them, while the robot walks."""
    current(list(rig.runs))
    return run_json(await rig.change_run(lambda selection: change(selection, body), hand.require))


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
async def resume(rig: TheRig, hand: TheHand) -> dict[str, Any]:
    """Go on from where the run was held; a rig that was held without a run is armed again (its state)."""
    await rig.resume_run(hand.require)
    return newest(rig) if rig.snapshot.run is not None else ticks.state_of(rig)


def newest(rig: TheRig) -> dict[str, Any]:
    """The run that is on, or was the last one; the rig's state while the robot walks what is no run of its own."""
    walked = rig.snapshot.run
    if not rig.runs or (walked is not None and walked.id != rig.runs[0].id):
        return ticks.state_of(rig)
    return run_json(rig.runs[0])


def current(runs: list[Run]) -> Run:
    if not runs or runs[0].state is not RunState.RUNNING:
        raise Rejected(Problem(409, "No run", "There is no run at the moment; arm the rig and start one."))
    return runs[0]
