"""What each viewer of a scene wants to see, between the page that says so and the stream that shows it."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from server.scene.layers import AT_FIRST, Layer
from server.scene.views import ViewName

VIEWER_ID = r"^[0-9a-f]{16}$"
"""What a page calls its viewer: chance, so that two pages do not share one."""


@dataclass(frozen=True, slots=True)
class AskedView:
    name: ViewName
    smooth: bool


@dataclass
class Viewer:
    """One page's scene. All of it is used on the event loop only.

    shown: its layers.  view: that it was asked to take next, None when there is none.
    streams: how many of its scene's sockets are open.  full_field: the end of its field colours, T.
    follows: whether its eye is led after the robot.
    """

    shown: frozenset[Layer] = AT_FIRST
    view: AskedView | None = None
    streams: int = 0
    full_field: float | None = None
    follows: bool = False
    wished: asyncio.Event = field(default_factory=asyncio.Event)
    """Set when the page has asked for something else."""
    changed: asyncio.Event = field(default_factory=asyncio.Event)
    """Set when the page is to hear how its scene is."""
    users: int = 0

    def show(self, layers: frozenset[Layer]) -> None:
        self.shown = layers
        self.wished.set()

    def look(self, name: ViewName, *, smooth: bool) -> None:
        self.view = AskedView(name, smooth)
        self.wished.set()

    def report(self, full_field: float, *, follows: bool) -> None:
        if (full_field, follows) != (self.full_field, self.follows):
            self.full_field, self.follows = full_field, follows
            self.changed.set()

    @contextmanager
    def streaming(self) -> Iterator[None]:
        """While a socket of its scene is open."""
        self.streams += 1
        self.changed.set()
        try:
            yield
        finally:
            self.streams -= 1
            self.follows = self.follows and self.streams > 0
            self.changed.set()


class Viewers:
    """Those whose page or stream is open."""

    def __init__(self) -> None:
        self._viewers: dict[str, Viewer] = {}

    def __len__(self) -> int:
        return len(self._viewers)

    @contextmanager
    def known(self, id: str) -> Iterator[Viewer]:
        """The viewer of that name, for as long as somebody has to do with it; the page or the stream may come first."""
        viewer = self._viewers.setdefault(id, Viewer())
        viewer.users += 1
        try:
            yield viewer
        finally:
            viewer.users -= 1
            if viewer.users == 0:
                del self._viewers[id]
