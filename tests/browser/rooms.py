"""The windows that people have the page in: beside the rig, on a laptop, on a phone; by day and by night."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, Literal

import pytest

Scheme = Literal["light", "dark"]

SIZES = ((1440, 900), (1024, 768), (390, 844))
"""CSS px."""
TOUCHED_BELOW = 700
"""A window that is narrower is a phone's, CSS px."""


@dataclass(frozen=True, slots=True)
class Room:
    """width, height: of the window, CSS px."""

    width: int
    height: int
    scheme: Scheme = "light"

    def __str__(self) -> str:
        return f"{self.width}x{self.height} {self.scheme}"

    @property
    def is_phone(self) -> bool:
        return self.width < TOUCHED_BELOW

    def window(self) -> dict[str, Any]:
        """What a browser needs to know of it."""
        return {
            "viewport": {"width": self.width, "height": self.height},
            "color_scheme": self.scheme,
            "is_mobile": self.is_phone,
            "has_touch": self.is_phone,
        }


SCHEMES: tuple[Scheme, Scheme] = ("light", "dark")
ROOMS = tuple(Room(*size, SCHEMES[(row + turn) % 2]) for turn in range(2) for row, size in enumerate(SIZES))
"""Each size in each scheme; neighbours differ in both."""


def spread_over_rooms(metafunc: pytest.Metafunc, *, everywhere: bool) -> None:
    """Each test of a module that asks for a `room` has the next one; or each has all of them."""
    if "room" not in metafunc.fixturenames:
        return
    module = metafunc.definition.nodeid.partition("::")[0]
    turn = _turns[module]
    _turns[module] += 1
    rooms = ROOMS if everywhere else (ROOMS[turn % len(ROOMS)],)
    metafunc.parametrize("room", rooms, ids=str)


_turns: Counter[str] = Counter()
"""How many tests of a module have a room, by the module's path."""
