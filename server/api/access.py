"""How a route reaches the parts that the application holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from server.api.ticks import TickText
from server.pictures import Pictures

if TYPE_CHECKING:
    from server.rig import Rig


def the_rig(connection: HTTPConnection) -> Rig:
    return connection.app.state.rig


def the_pictures(connection: HTTPConnection) -> Pictures:
    return connection.app.state.pictures


def the_tick_text(connection: HTTPConnection) -> TickText:
    return connection.app.state.tick_text


TheRig = Annotated["Rig", Depends(the_rig)]
ThePictures = Annotated[Pictures, Depends(the_pictures)]
TheTickText = Annotated[TickText, Depends(the_tick_text)]
