"""Where the scenes are, each with its page and its socket beside it.

/scene is the rig's and /scene/SESSION that of a replay, as everybody sees it; /scene/live/VIEWER and
/scene/SESSION/VIEWER are the same for one viewer, who may hide parts of it and be led to a view.
"""

from __future__ import annotations

import logging
from typing import Annotated, Any
from urllib.parse import urlencode

from fastapi import FastAPI, Path, WebSocket
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from server.replay.sessions import ReplaySessions
from server.scene.feed import SceneFeed
from server.scene.page import scene_page
from server.scene.viewers.known import VIEWER_ID, Viewer, Viewers
from server.streams import StreamEnded

log = logging.getLogger(__name__)

ViewerId = Annotated[str, Path(pattern=VIEWER_ID)]

NOT_RUNNING = 1013
"""Try again later."""


def add_scene_routes(app: FastAPI) -> None:
    app.add_api_websocket_route("/scene", scene_socket)
    app.add_api_websocket_route("/scene/{session}", replay_socket)
    app.add_api_websocket_route("/scene/live/{viewer}", viewers_socket)
    app.add_api_websocket_route("/scene/{session}/{viewer}", viewers_replay_socket)
    app.add_route("/scene/", live_or_replay, include_in_schema=False)
    app.add_route("/scene/{session}/", scene_page, include_in_schema=False)
    app.add_route("/scene/{session}/{viewer}/", scene_page, include_in_schema=False)


async def live_or_replay(request: Request) -> Response:
    """Viser's page opens the socket beside itself and forgets its query, so that a replay has a path of its own."""
    query = dict(request.query_params)
    session = query.pop("replay", None)
    if session is None:
        return await scene_page(request)
    replays: ReplaySessions = request.app.state.replays
    if replays.find(session) is None:
        return Response("This replay is over.", 404, media_type="text/plain")
    return RedirectResponse(f"/scene/{session}/" + (f"?{urlencode(query)}" if query else ""), 307)


async def scene_socket(socket: WebSocket) -> None:
    await serve_scene(socket, socket.app.state.scene, Viewer())


async def viewers_socket(socket: WebSocket, viewer: ViewerId) -> None:
    viewers: Viewers = socket.app.state.viewers
    with viewers.known(viewer) as known:
        await serve_scene(socket, socket.app.state.scene, known)


async def replay_socket(socket: WebSocket, session: str) -> None:
    await serve_replay(socket, session, Viewer())


async def viewers_replay_socket(socket: WebSocket, session: str, viewer: ViewerId) -> None:
    viewers: Viewers = socket.app.state.viewers
    with viewers.known(viewer) as known:
        await serve_replay(socket, session, known)


async def serve_replay(socket: WebSocket, session: str, viewer: Viewer) -> None:
    """The scene of a replay starts with its first viewer."""
    replays: ReplaySessions = socket.app.state.replays
    replay = replays.find(session)
    if replay is None:
        await socket.close(NOT_RUNNING, "this replay is over")
        return
    try:
        feed = await replay.scene()
    except StreamEnded:
        await socket.close(NOT_RUNNING, "this replay is over")
        return
    except Exception:  # a replay without a 3D picture is still a replay
        log.exception("the 3D scene of a replay could not be started")
        await socket.close(NOT_RUNNING, "the 3D scene of this replay cannot be shown")
        return
    await serve_scene(socket, feed, viewer)


async def serve_scene(socket: WebSocket, feed: SceneFeed[Any], viewer: Viewer) -> None:
    if feed.scene is None:
        await socket.close(NOT_RUNNING, "the 3D scene is not running")
        return
    await feed.bridge.serve(socket, viewer)
