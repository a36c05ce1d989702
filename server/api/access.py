"""How a route reaches the parts that the application holds.

Asynchronous although nothing is awaited: FastAPI runs plain functions on a worker thread.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from server.api.ticks import TickText
from server.pictures import Pictures

if TYPE_CHECKING:
    from server.archive import Archive
    from server.fault_watch import FaultWatch
    from server.replay.sessions import ReplaySessions
    from server.rig import Rig
    from server.rig_changes import RigChanges
    from server.scene.viewers.known import Viewers
    from server.studies.desk import StudyDesk


async def the_rig(connection: HTTPConnection) -> Rig:
    return connection.app.state.rig


async def the_archive(connection: HTTPConnection) -> Archive:
    return connection.app.state.archive


async def the_replays(connection: HTTPConnection) -> ReplaySessions:
    return connection.app.state.replays


async def the_changes(connection: HTTPConnection) -> RigChanges | None:
    return connection.app.state.rig_changes


async def the_pictures(connection: HTTPConnection) -> Pictures:
    return connection.app.state.pictures


async def the_viewers(connection: HTTPConnection) -> Viewers:
    return connection.app.state.viewers


async def the_tick_text(connection: HTTPConnection) -> TickText:
    return connection.app.state.tick_text


async def the_desk(connection: HTTPConnection) -> StudyDesk:
    return connection.app.state.studies


async def the_fault_watch(connection: HTTPConnection) -> FaultWatch:
    return connection.app.state.fault_watch


TheRig = Annotated["Rig", Depends(the_rig)]
TheArchive = Annotated["Archive", Depends(the_archive)]
TheReplays = Annotated["ReplaySessions", Depends(the_replays)]
TheChanges = Annotated["RigChanges | None", Depends(the_changes)]
ThePictures = Annotated[Pictures, Depends(the_pictures)]
TheViewers = Annotated["Viewers", Depends(the_viewers)]
TheFaultWatch = Annotated["FaultWatch", Depends(the_fault_watch)]
TheDesk = Annotated["StudyDesk", Depends(the_desk)]
TheTickText = Annotated[TickText, Depends(the_tick_text)]
