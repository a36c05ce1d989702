"""A run taken away: as a table, as the recording itself, as a figure or as a film."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Depends, Request, Response
from pydantic import Field
from starlette.responses import FileResponse

from control.runs import RunState
from server.api.access import TheArchive, TheRig
from server.api.download import Download
from server.api.problems import Problem, Rejected
from server.api.recorded import path_of, record_of
from server.catalogue.records import RunRecord
from server.exports.formats import FORMATS, Job
from server.exports.naming import file_name

if TYPE_CHECKING:
    from server.archive import Archive
    from server.rig import Rig

router = APIRouter(tags=["runs"])

FINISHED_WITHIN = 5.0
"""How long a request waits for the file of a run that is over, s; half a second is recorded after its end."""
FIGURE_KEPT = "private, max-age=600"
"""A browser may show a figure again without asking, so that looking through runs does not draw each anew."""


@dataclass(frozen=True, slots=True)
class Finished:
    """A run whose recording has its end, or what is left of it."""

    run: RunRecord
    path: Path

    def headers(self, format: str) -> dict[str, str]:
        name = file_name(self.run.id, self.run.label, FORMATS[format].suffix)
        return {
            "content-type": FORMATS[format].media_type,
            "content-disposition": f'attachment; filename="{name}"',
        }


async def finished(
    run_id: Annotated[str, Field(max_length=80)], rig: TheRig, archive: TheArchive
) -> Finished:
    """The recording that is asked for, or the problem with it."""
    is_over = any(run.id == run_id and run.state is not RunState.RUNNING for run in rig.runs)
    return await asyncio.to_thread(_found, archive, run_id, is_over)


TheFinished = Annotated[Finished, Depends(finished)]


def _found(archive: Archive, run_id: str, is_over: bool) -> Finished:
    """is_over: the run is one of this program's, and has ended; the catalogue may be a moment behind."""
    run = record_of(archive, run_id)
    if run.recording_state == "none":
        raise Rejected(Problem(409, "No recording", f"The run {run.id} was not recorded."))
    if run.recording_state == "writing" and not (
        is_over and archive.recorder.written(run.id, FINISHED_WITHIN)
    ):
        detail = (
            f"The run {run.id} is being recorded; stop it first, then ask again. If its program has died, "
            "`pivotrig runs recover` keeps what there is."
        )
        raise Rejected(Problem(409, "Still recorded", detail))
    return Finished(run, path_of(archive, run.id))


@router.get("/runs/{run_id}/recording.mcap", response_class=FileResponse)
async def recording(finished: TheFinished) -> Response:
    """The recording itself: an MCAP file, which Foxglove and the public `mcap` libraries open."""
    return FileResponse(finished.path, headers=finished.headers("mcap"))


def _download(request: Request, rig: Rig, finished: Finished, format: str, overlay: bool = False) -> Download:
    job = Job(finished.path, format, overlay)
    return Download(request.app.state.workshop, job, rig.updates.wait_closed, finished.headers(format))


@router.get("/runs/{run_id}/samples.csv", response_class=Response)
async def samples_csv(request: Request, rig: TheRig, finished: TheFinished) -> Response:
    """One row a tick, a header with the columns' names, empty where something is unknown."""
    return _download(request, rig, finished, "csv")


@router.get("/runs/{run_id}/samples.parquet", response_class=Response)
async def samples_parquet(request: Request, rig: TheRig, finished: TheFinished) -> Response:
    """The same table with units and descriptions in its fields, and the settings of the run."""
    return _download(request, rig, finished, "parquet")


@router.get("/runs/{run_id}/samples.mat", response_class=Response)
async def samples_mat(request: Request, rig: TheRig, finished: TheFinished) -> Response:
    """The same table for MATLAB and Octave: one variable a column, `units` and `settings` beside them."""
    return _download(request, rig, finished, "mat")


@router.get("/runs/{run_id}/plot.png", response_class=Response)
async def plot_png(request: Request, rig: TheRig, finished: TheFinished) -> Response:
    """The figure of the run: its path, its error over time, and how the errors are distributed."""
    return _figure(_download(request, rig, finished, "png"))


@router.get("/runs/{run_id}/plot.svg", response_class=Response)
async def plot_svg(request: Request, rig: TheRig, finished: TheFinished) -> Response:
    """The same figure, to be edited."""
    return _figure(_download(request, rig, finished, "svg"))


def _figure(download: Download) -> Download:
    """Shown in a page as it is; a link with `download` saves it under its name all the same."""
    shown = download.headers["content-disposition"].replace("attachment", "inline")
    download.headers["content-disposition"] = shown
    download.headers["cache-control"] = FIGURE_KEPT
    return download


@router.get("/runs/{run_id}/video.mp4", response_class=Response)
async def video(request: Request, rig: TheRig, finished: TheFinished, overlay: bool = False) -> Response:
    """The camera's pictures as a film in real time, sent while it is made; with what the rig knew, if wanted."""
    if finished.run.recording_state == "complete" and not finished.run.frames:
        detail = f"The run {finished.run.id} was recorded without pictures; set frames_Hz under [recording]."
        raise Rejected(Problem(409, "No pictures", detail))
    return _download(request, rig, finished, "mp4", overlay)
