"""What one viewer of the 3D scene wants to see: `WS /api/v1/scene?viewer=ID`, beside the scene's own socket.

ID is 16 hexadecimal digits that the page makes up; its viewer is at /scene/live/ID/, that of a replay at
/scene/SESSION/ID/. To {"type": "show", "layers": ["field", "coils", ...]} the other layers disappear from this viewer
alone; {"type": "view", "name": "above", "smooth": true} leads its eye to a named view, "follow" after the robot.
Whenever it changes, {"type": "scene", "watching", "full_field_mT", "follows"} says whether the scene's socket is open,
where the scale of the field's colours ends, and whether the eye follows the robot. What cannot be understood is
answered by {"type": "problem", "detail"}.
"""

from __future__ import annotations

from typing import Annotated

import msgspec
from fastapi import APIRouter, Query, WebSocket

from server.api.access import TheViewers
from server.api.sockets import Line, serve
from server.scene.layers import Layer
from server.scene.viewers.known import VIEWER_ID, Viewer
from server.scene.views import ViewName

sockets = APIRouter()

MILLI = 1e3


class Show(msgspec.Struct, tag_field="type", tag="show", forbid_unknown_fields=True):
    layers: frozenset[Layer]


class Look(msgspec.Struct, tag_field="type", tag="view", forbid_unknown_fields=True):
    """smooth: False where the page's user wants less motion."""

    name: ViewName
    smooth: bool = True


_decoder = msgspec.json.Decoder(Show | Look)


@sockets.websocket("/scene")
async def scene(
    socket: WebSocket, viewers: TheViewers, viewer: Annotated[str, Query(pattern=VIEWER_ID)]
) -> None:
    """Nothing of it can act on the rig."""
    await socket.accept()
    with viewers.known(viewer) as known:
        line = Line(socket)
        await serve(socket, hear(socket, line, known), report(line, known))


async def hear(socket: WebSocket, line: Line, viewer: Viewer) -> None:
    while (event := await socket.receive())["type"] != "websocket.disconnect":
        try:
            wish = _decoder.decode(event.get("bytes") or event.get("text") or b"")
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            await line.send_text(msgspec.json.encode({"type": "problem", "detail": str(error)}).decode())
            continue
        if isinstance(wish, Show):
            viewer.show(wish.layers)
        else:
            viewer.look(wish.name, smooth=wish.smooth)


async def report(line: Line, viewer: Viewer) -> None:
    while True:
        viewer.changed.clear()
        await line.send_text(msgspec.json.encode(as_told(viewer)).decode())
        await viewer.changed.wait()


def as_told(viewer: Viewer) -> dict[str, object]:
    full = viewer.full_field
    return {
        "type": "scene",
        "watching": viewer.streams > 0,
        "full_field_mT": None if full is None else round(full * MILLI, 3),
        "follows": viewer.follows,
    }
