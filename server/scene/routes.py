"""Where the scenes are: the rig's at /scene, that of a replay at /scene/SESSION, each with its page and its socket."""

from __future__ import annotations

import logging
from urllib.parse import urlencode

from fastapi import FastAPI, WebSocket
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from server.replay.sessions import ReplaySessions
from server.scene.feed import SceneFeed
from server.scene.page import scene_page
from server.streams import StreamEnded

log = logging.getLogger(__name__)

NOT_RUNNING = 1013
"""Try again later."""


def add_scene_routes(app: FastAPI) -> None:
    app.add_api_websocket_route("/scene", scene_socket)
    app.add_api_websocket_route("/scene/{session}", replay_socket)
    app.add_route("/scene/", live_or_replay, include_in_schema=False)
    app.add_route("/scene/{session}/", scene_page, include_in_schema=False)


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
    await serve_scene(socket, socket.app.state.scene)


async def replay_socket(socket: WebSocket, session: str) -> None:
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
    await serve_scene(socket, feed)


async def serve_scene(socket: WebSocket, feed: SceneFeed) -> None:
    if feed.scene is None:
        await socket.close(NOT_RUNNING, "the 3D scene is not running")
        return
    await feed.bridge.serve(socket)
