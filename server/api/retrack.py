"""A recorded run looked at again, by another tracker, filter or controller."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from fastapi import APIRouter, Depends, Request, Response
from pydantic import Field, JsonValue

from control.runs import Choice
from server.api.access import TheArchive, TheRig
from server.api.body import StrictRoute
from server.api.exports import Finished, TheFinished
from server.api.problems import Problem, Rejected, not_found
from server.api.recorded import record_of
from server.api.schemas import ChoiceBody, Edge
from server.retrack.changes import Changes, RetrackError, changed_rig, rig_then
from server.retrack.desk import Busy, Job, RetrackDesk

if TYPE_CHECKING:
    from server.rig import Rig

router = APIRouter(tags=["runs"], route_class=StrictRoute)

RunId = Annotated[str, Field(max_length=80)]


async def the_desk(request: Request) -> RetrackDesk:
    return request.app.state.retracks


TheDesk = Annotated[RetrackDesk, Depends(the_desk)]


class RetrackBody(Edge):
    """What is to be different from how it was. rig: whose settings are taken first, the run's own or the rig's now.

    vision, estimator: some values of these sections of the rig file.
    controller: asked at each tick what it would command.  estimate: which one it is shown.
    """

    rig: Literal["then", "now"] = "then"
    vision: dict[str, JsonValue] = Field(default_factory=dict)
    estimator: dict[str, JsonValue] = Field(default_factory=dict)
    controller: ChoiceBody | None = None
    estimate: Literal["recorded", "again"] = "recorded"

    def changes(self, rig: Rig) -> Changes:
        asked = self.controller
        return Changes(
            vision=self.vision,
            estimator=self.estimator,
            rig=rig.settings.to_recorded() if self.rig == "now" else None,
            controller=None if asked is None else Choice(asked.name, asked.parameters),
            estimate=self.estimate,
        )


@router.post("/runs/{run_id}/retrack", status_code=202)
async def look_again(finished: TheFinished, body: RetrackBody, rig: TheRig, desk: TheDesk) -> dict[str, Any]:
    """Look at its pictures again; what comes of it is asked for under the same address."""
    changes = body.changes(rig)
    await asyncio.to_thread(_check, finished, changes)
    try:
        job = desk.start(finished.run.id, finished.path, changes)
    except Busy as busy:
        raise Rejected(Problem(409, "Busy", f"{str(busy).capitalize()}.")) from busy
    return {"job": job.id}


def _check(finished: Finished, changes: Changes) -> None:
    """What can be seen to be wrong before the recording is opened. It blocks."""
    from server.retrack.retracking import NO_PICTURES, law_of

    if finished.run.recording_state == "complete" and not finished.run.frames:
        raise Rejected(Problem(409, "No pictures", f"{NO_PICTURES[0].upper()}{NO_PICTURES[1:]}."))
    try:
        then = rig_then(finished.run.settings)
    except RetrackError as error:
        raise Rejected(Problem(409, "Settings lost", str(error))) from error
    try:
        changed_rig(then, changes)
        if changes.controller is not None:
            law_of(changes.controller.name, changes.controller.parameters)
    except RetrackError as error:
        raise Rejected(Problem(422, "Not acceptable", str(error))) from error


@router.get("/runs/{run_id}/retrack", response_class=Response)
async def look(run_id: RunId, archive: TheArchive, desk: TheDesk) -> Response:
    """How far it is, and in the end the comparison, and curves in at most 2 000 points; stage "none": never asked."""
    run = await asyncio.to_thread(record_of, archive, run_id)
    return _answer(desk.of(run.id) or Job(0, run.id, stage="none"))


@router.delete("/runs/{run_id}/retrack", response_class=Response)
async def cancel(run_id: RunId, desk: TheDesk) -> Response:
    """End it, or forget what came of it; nothing is left."""
    job = await desk.cancel(run_id)
    if job is None:
        raise not_found(f"The run {run_id[:80]!a} has not been looked at again since the server was started.")
    return _answer(job)


def _answer(job: Job) -> Response:
    result = job.result
    content = {
        "job": job.id,
        "run": job.run,
        "stage": job.stage,
        "progress": job.progress,
        "reason": job.reason,
        "changes": None if result is None else result.changes,
        "comparison": None if result is None else result.comparison,
        "series": None if result is None else result.series,
    }
    return Response(msgspec.json.encode(content), media_type="application/json")
