"""Studies: made, looked at while they go on, stopped, resumed, taken away."""

from __future__ import annotations

import asyncio
import io
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, TypeVar

from fastapi import APIRouter, Depends, Query, Request, Response
from pydantic import Field
from starlette.responses import FileResponse

from control.simulation.plants import plants
from control.studies.checking import Survey
from control.studies.definition import StudyDefinition
from server.access.caller import Caller, TheCaller
from server.api.access import TheDesk
from server.api.body import StrictRoute
from server.api.choices import listing
from server.api.operator import TheLease
from server.api.problems import Problem, Rejected, not_found, offence
from server.api.study_bodies import Begin, DefinitionBody, Metric, StudyBody, metric_of, wrong
from server.api.study_json import StudyJson, axes_json
from server.lease.desk import LeaseDesk
from server.studies.child import ChildFailed
from server.studies.desk import Asked, StudyDesk
from server.studies.errors import NoSuchStudy, StudyBusy, StudyStoreError
from server.studies.expectation import expected_wall
from server.studies.learning import Learning
from server.studies.progress import measure_of
from server.studies.study import RESULTS, Study

T = TypeVar("T")

router = APIRouter(tags=["studies"], route_class=StrictRoute)

StudyId = Annotated[str, Field(max_length=80)]
PAGE = "report.html"


async def the_json(request: Request) -> StudyJson:
    return request.app.state.study_json


TheJson = Annotated[StudyJson, Depends(the_json)]


async def the_learning(request: Request) -> Learning:
    return request.app.state.learning


TheLearning = Annotated[Learning, Depends(the_learning)]


async def blocking(work: Callable[..., T], *arguments: Any) -> T:
    """On a worker thread; what goes wrong with a study as a problem document."""
    try:
        return await asyncio.to_thread(work, *arguments)
    except NoSuchStudy as error:
        raise not_found(str(error)) from error
    except StudyBusy as error:
        raise busy(error) from error
    except StudyStoreError as error:
        raise Rejected(Problem(503, "Cannot be kept", str(error))) from error


def busy(error: StudyBusy) -> Rejected:
    return Rejected(Problem(409, "Busy", str(error)))


async def the_study(study_id: StudyId, desk: TheDesk) -> Study:
    return await blocking(desk.store.open, study_id)


TheStudy = Annotated[Study, Depends(the_study)]


@router.get("/plants")
async def list_plants() -> list[dict[str, Any]]:
    """The simulated robots of a batch, with the JSON schema of each one's parameters."""
    return listing(plants)


@router.post("/studies", status_code=201)
async def create(
    body: StudyBody, desk: TheDesk, shown: TheJson, lease: TheLease, caller: TheCaller
) -> dict[str, Any]:
    """Make a study, and begin it unless `begin` is false."""
    asked = desk.asked(consent=body.how.consent, jobs=body.how.jobs)
    definition = await asyncio.to_thread(body.read)
    found = await desk.surveyed(definition)
    if found.problems:
        raise Rejected(wrong([offence((), text) for text in found.problems]))
    if body.begin:
        asked = permitted(asked, definition, lease, caller)
        with_words(lambda: desk.require_free(definition.on))
    study = await blocking(desk.store.create, definition)
    desk.tell_of("created", study)
    if body.begin:
        await begun(desk, study, asked)
    return await blocking(shown.short, study)


def permitted(asked: Asked, definition: StudyDefinition, lease: LeaseDesk, caller: Caller) -> Asked:
    """A campaign needs the rig's lease to begin, and belongs to the server then; a batch needs none."""
    return replace(asked, permit=lease.hand(caller).require) if definition.on == "rig" else asked


def with_words(check: Callable[[], None]) -> None:
    try:
        check()
    except StudyBusy as error:
        raise busy(error) from error


async def begun(desk: StudyDesk, study: Study, asked: Asked) -> None:
    try:
        await desk.begin(study, asked)
    except StudyBusy as error:
        raise busy(error) from error


@router.post("/studies/preview")
async def preview(body: DefinitionBody, desk: TheDesk) -> dict[str, Any]:
    """How many runs that would be and about how long they take; or `problems`, by field, and nothing else."""
    try:
        definition = await asyncio.to_thread(body.read)
    except Rejected as rejected:
        return _nothing_but(rejected.problem.errors)
    found = await desk.surveyed(definition)
    return {
        "sets": found.sets,
        "runs": found.runs,
        "seconds": round(expected_wall(definition, found), 1),
        "rig_seconds": round(found.walking + found.resting, 1),
        "axes": axes_json(definition),
        "problems": _problems(found),
        "definition": definition.to_json(),
        "toml": definition.to_toml(),
    }


def _nothing_but(problems: Any) -> dict[str, Any]:
    unknown = dict.fromkeys(("sets", "runs", "seconds", "rig_seconds", "definition", "toml"))
    return {**unknown, "axes": [], "problems": list(problems)}


def _problems(found: Survey) -> list[dict[str, Any]]:
    return [offence((), text) for text in found.problems]


@router.get("/studies")
async def list_studies(shown: TheJson) -> dict[str, Any]:
    """Newest first."""
    return {"studies": await blocking(shown.listed)}


@router.get("/studies/{study_id}")
async def one(
    study: TheStudy, shown: TheJson, learning: TheLearning, metric: Annotated[Metric, Query()] = None
) -> dict[str, Any]:
    """With the mean of each set so far and its 95 % interval, of ME or of another metric.

    answer, surface: of a search for the best, which may be some seconds old while it goes on; null for other designs.
    """
    wanted = metric_of(metric, measure_of(study.definition))
    whole = await blocking(shown.whole, study, wanted)
    return {**whole, **await learning.of(study, whole["rows"])}


@router.post("/studies/{study_id}/stop")
async def stop(study: TheStudy, desk: TheDesk, shown: TheJson) -> dict[str, Any]:
    """It ends in good order, and can be resumed."""
    if desk.work_on(study.id) is None and await blocking(lambda: study.state) == "running":
        detail = "It is carried out by another program; stop it there (Ctrl-C)."
        raise Rejected(Problem(409, "Busy", detail))
    await desk.stop(study.id)
    return await blocking(shown.short, study)


@router.post("/studies/{study_id}/resume")
async def resume(
    study: TheStudy,
    desk: TheDesk,
    shown: TheJson,
    lease: TheLease,
    caller: TheCaller,
    body: Begin | None = None,
) -> dict[str, Any]:
    """Go on with what is left; nothing that has finished is done again."""
    how = body or Begin()
    asked = desk.asked(consent=how.consent, jobs=how.jobs)
    if await blocking(lambda: study.is_complete):
        raise Rejected(Problem(409, "Finished", "This study has finished; nothing is left to be done."))
    await begun(desk, study, permitted(asked, study.definition, lease, caller))
    return await blocking(shown.short, study)


@router.delete("/studies/{study_id}", status_code=204)
async def delete(study: TheStudy, desk: TheDesk, shown: TheJson, learning: TheLearning) -> Response:
    """Its table and report; its runs stay in the catalogue. One that goes on is refused."""
    if desk.work_on(study.id) is not None:
        raise Rejected(Problem(409, "Busy", "The study goes on; stop it first."))
    await blocking(desk.store.delete, study.id)
    shown.forget(study.id)
    learning.forget(study.id)
    desk.tell_of("deleted", study)
    return Response(status_code=204)


@router.get("/studies/{study_id}/definition.toml", response_class=Response)
async def definition_toml(study: TheStudy) -> Response:
    """What was asked for, as `pivotrig study` takes it."""
    return _file(study.definition.to_toml().encode(), "application/toml", f"study-{study.id}.toml")


@router.get("/studies/{study_id}/table.csv", response_class=Response)
async def table_csv(study: TheStudy) -> Response:
    """A line a run, in the order of the plan."""
    return _file(await blocking(lambda: study.table().csv()), "text/csv", f"study-{study.id}.csv")


@router.get("/studies/{study_id}/plot.png", response_class=Response)
async def plot_png(study: TheStudy, desk: TheDesk) -> Response:
    """The figure that fits its axes."""
    return Response(await drawn(desk, "plot", study), media_type="image/png")


@router.get("/studies/{study_id}/report", response_class=FileResponse)
async def report(study: TheStudy, desk: TheDesk) -> Response:
    """The report as a page that stands alone; made anew when runs have finished since."""
    return FileResponse(await _report_page(desk, study), media_type="text/html")


@router.get("/studies/{study_id}/report.zip", response_class=Response)
async def report_zip(study: TheStudy, desk: TheDesk) -> Response:
    """The report with its figures and tables, the definition and the table of all runs."""
    await _report_page(desk, study)
    return _file(await blocking(_zipped, study), "application/zip", f"study-{study.id}.zip")


async def drawn(desk: StudyDesk, verb: Any, study: Study) -> bytes:
    if not (await blocking(study.tally)).done:
        raise Rejected(Problem(409, "Nothing yet", "No run of this study has finished."))
    try:
        return await desk.drawn(verb, study)
    except ChildFailed as error:
        raise Rejected(Problem(409, "Cannot be drawn", str(error))) from error


async def _report_page(desk: StudyDesk, study: Study) -> Path:
    path = study.report_folder / PAGE
    if not await blocking(_is_fresh, study, path):
        await drawn(desk, "report", study)
    return path


def _is_fresh(study: Study, path: Path) -> bool:
    """Whether it was made of all rows: it has the time of the rows that it was made of."""
    results = study.folder / RESULTS
    return path.exists() and results.exists() and path.stat().st_mtime_ns == results.stat().st_mtime_ns


def _zipped(study: Study) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("definition.toml", study.definition.to_toml())
        file.writestr("table.csv", study.table().csv())
        for path in sorted(study.report_folder.rglob("*")):
            if path.is_file():
                file.write(path, path.relative_to(study.report_folder))
    return packed.getvalue()


def _file(content: bytes, media_type: str, name: str) -> Response:
    return Response(
        content, media_type=media_type, headers={"content-disposition": f'attachment; filename="{name}"'}
    )
