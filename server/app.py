"""The web application around a rig: REST, sockets, the scene and the dashboard's files, behind one door."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from fastapi import APIRouter, Depends, FastAPI
from starlette.responses import FileResponse

import web
from server.access.guard import Guard
from server.access.opening import Opening
from server.api import (
    about,
    actions,
    again,
    calibration,
    calibration_runs,
    camera,
    cameras,
    controllers,
    exports,
    faults,
    login,
    manual,
    metrics,
    notifications,
    operator,
    overview,
    ports,
    problems,
    replay,
    retrack,
    rig_file,
    run_catalogue,
    runs,
    scene,
    selection,
    simulated_board,
    state,
    studies,
    telemetry,
    trajectories,
    vision,
)
from server.api.document import document
from server.api.study_json import StudyJson
from server.api.ticks import TickText
from server.calibration.camera import CameraCalibration
from server.calibration.runs import CalibrationRuns
from server.colour_picker import ColourPicker
from server.door import Door
from server.exports.work import Workshop
from server.fault_watch import FaultWatch
from server.fresh_files import ALWAYS_ASK, FreshFiles
from server.jog_order import JogOrder
from server.lease.desk import LeaseDesk
from server.login_page import add_login_page
from server.notifier import Notifier
from server.pictures import Pictures
from server.replay.sessions import ReplaySessions
from server.retrack.desk import RetrackDesk
from server.rig_life import ENDED
from server.scene.feed import SceneFeed
from server.scene.live import LiveView
from server.scene.routes import add_scene_routes
from server.scene.viewers.known import Viewers
from server.studies.desk import StudyDesk
from server.studies.learning import Learning
from server.upkeep import Upkeep
from server.watching.exposition import Exposition
from server.watching.health import Pulse
from server.watching.log import log_event
from server.watching.supervisor import Supervisor
from server.watching.tally import ClientTally, Counting, EventTally, RigTally

if TYPE_CHECKING:
    from server.archive import Archive
    from server.rig import Rig
    from server.rig_changes import RigChanges

log = logging.getLogger(__name__)

WEB_FOLDER = Path(web.__file__).parent
DOCS_PAGE = WEB_FOLDER / "vendor" / "swagger" / "docs.html"
PREFIX = "/api/v1"
PROBLEM_SCHEMA = {
    "description": "RFC 9457 problem document",
    "content": {"application/problem+json": {"schema": {"type": "object"}}},
}
RESPONSES: dict[int | str, dict[str, Any]] = dict.fromkeys((409, 422), PROBLEM_SCHEMA)


ROOMS = (
    login,
    state,
    rig_file,
    selection,
    actions,
    manual,
    controllers,
    trajectories,
    runs,
    run_catalogue,
    overview,
    again,
    retrack,
    exports,
    studies,
    camera,
    cameras,
    calibration,
    calibration_runs,
    simulated_board,
    telemetry,
    faults,
    ports,
    vision,
    notifications,
    about,
    operator,
)
"""One router a resource."""


def create_app(
    rig: Rig,
    archive: Archive,
    changes: RigChanges | None = None,
    guard: Guard | None = None,
    opening: Opening | None = None,
) -> FastAPI:
    """The application of one rig and of the archive that its runs go to; it closes both when it ends.

    changes: the rig's file, when it has one that may be changed.  guard: knows who asks; without one, everybody is
    let in.  opening: names it may be asked by, beside localhost and its address, and other sites that may use it.
    """
    opening = opening or Opening()
    app = FastAPI(
        title="pivotrig",
        version=state.VERSION,
        summary="See, control and record a magnetic pivot walker.",
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
        generate_unique_id_function=document.operation_id,
    )
    app.state.start = uuid4().hex
    app.state.rig = rig
    app.state.archive = archive
    app.state.rig_changes = changes
    app.state.pictures = Pictures(rig)
    app.state.camera_calibration = CameraCalibration(rig)
    app.state.calibration_runs = CalibrationRuns(rig)
    app.state.colour_picker = ColourPicker(rig)
    app.state.lease = rig.attendance = LeaseDesk(rig)
    app.state.tick_text = TickText(app.state.lease.in_state)
    app.state.jog_order = JogOrder()
    app.state.fault_watch = FaultWatch(rig)
    app.state.viewers = Viewers()
    app.state.scene = SceneFeed(rig.updates, LiveView(rig))
    app.state.replays = ReplaySessions()
    app.state.workshop = Workshop()
    app.state.retracks = RetrackDesk()
    app.state.studies = StudyDesk(rig, archive)
    app.state.notifier = Notifier(rig)
    app.state.study_json = StudyJson(app.state.studies)
    app.state.learning = Learning(app.state.studies)
    app.state.ticks = RigTally()
    app.state.pulse = Pulse(rig, app.state.ticks)
    watch(app)
    app.state.guard = guard = guard or Guard()
    app.add_middleware(Door, hosts=opening.hosts, guard=guard, origins=opening.origins)
    app.add_middleware(Counting, tally=app.state.clients)
    problems.install(app)
    document.install(app)
    add_routes(app)
    return app


def watch(app: FastAPI) -> None:
    """Count from now on what the figures are made of, and put the rig's events into the program's log."""
    rig: Rig = app.state.rig
    events, app.state.clients = EventTally(), ClientTally()
    rig.event_log.listeners += [lambda event: events.add(str(event.severity), event.code), log_event]
    app.state.exposition = Exposition(rig, app.state.ticks, events, app.state.clients, state.VERSION)


@asynccontextmanager
async def lifespan(app: FastAPI) -> AsyncIterator[None]:
    """The rig stops before everything else does, and whatever else fails: its stop zeroes the coils."""
    rig, scene, changes = app.state.rig, app.state.scene, app.state.rig_changes
    supervisor = Supervisor(app.state.pulse)
    archive, upkeep = app.state.archive, Upkeep(app.state.archive, rig)
    try:
        await rig.start()
    except BaseException:
        await asyncio.to_thread(archive.close)
        raise
    try:
        upkeep.start()
        app.state.notifier.start()
        app.state.lease.start()
        await app.state.pictures.start()
        await start_scene(scene)
        await app.state.page_files.version()
        if changes is not None:
            changes.start()
        app.state.pulse.begin()
        with rig.watched(app.state.ticks.follow):
            supervisor.start()
            yield
    finally:
        await supervisor.stop()
        try:
            await end_rig(app)
        finally:
            written = asyncio.create_task(asyncio.to_thread(archive.recorder.close), name="last recording")
            try:
                await app.state.calibration_runs.stop()
                await app.state.retracks.stop()
                await app.state.learning.close()
                await app.state.notifier.stop()
                await app.state.lease.stop()
                if changes is not None:
                    await changes.stop()
                end_streams(app)
                await scene.stop()
                app.state.pictures.close()
                await upkeep.stop()
            finally:
                await written
                await asyncio.to_thread(archive.close)


async def end_rig(app: FastAPI) -> None:
    """Zero first; a campaign on the rig ends while there still is one."""
    rig: Rig = app.state.rig
    rig.stop_coils("ended", ENDED)
    try:
        await app.state.studies.close()
    finally:
        await rig.stop()


async def start_scene(scene: SceneFeed) -> None:
    try:
        await scene.start()
    except Exception:  # a rig without a 3D picture is still a rig (faults.md, rule 8)
        log.exception("the 3D scene could not be started; everything else goes on without it")


def end_streams(app: FastAPI) -> None:
    """End all open streams, so that a server that wants to stop need not wait for its viewers."""
    app.state.rig.updates.close()
    app.state.rig.announcements.close()


def add_routes(app: FastAPI) -> None:
    api = APIRouter(prefix=PREFIX, responses=RESPONSES, dependencies=[Depends(operator.listen)])
    for room in ROOMS:
        api.include_router(room.router)
    api.include_router(camera.sockets)
    api.include_router(replay.sockets)
    api.include_router(scene.sockets)
    app.include_router(api)
    files = app.state.page_files = FreshFiles(WEB_FOLDER)
    app.add_api_route("/", files.page, include_in_schema=False)
    app.add_api_route("/docs", docs, include_in_schema=False)
    app.include_router(metrics.router)
    add_login_page(app, WEB_FOLDER)
    add_scene_routes(app)
    app.mount("/static", files)


async def docs() -> FileResponse:
    return FileResponse(DOCS_PAGE, headers=ALWAYS_ASK)
