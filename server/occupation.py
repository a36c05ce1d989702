"""Who has a rig to itself: a campaign, which nothing but a stop may disturb."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol

from control.safety import Refused


class Occupant(Protocol):
    """name: as people know it, such as: study 'Tilt and path step'."""

    @property
    def name(self) -> str: ...

    def stop(self, reason: str, *, is_end: bool = False) -> None:
        """A person, or the program's end (is_end), has stopped the rig. Must not wait; from signal handlers too."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Stop:
    """One of its own each time. is_end: the program ends."""

    reason: str
    is_end: bool


class Occupation:
    """At most one occupant. latest_stop: for who was not there yet when it came."""

    def __init__(self) -> None:
        self.latest_stop: Stop | None = None
        self._occupant: Occupant | None = None

    @contextmanager
    def by(self, occupant: Occupant) -> Iterator[None]:
        """It has the rig meanwhile; raises `Refused` where another one has."""
        self.require_none()
        self._occupant = occupant
        try:
            yield
        finally:
            self._occupant = None

    @property
    def is_taken(self) -> bool:
        return self._occupant is not None

    def require_none(self) -> None:
        """Raises `Refused` while somebody has the rig to itself."""
        occupant = self._occupant  # it may leave meanwhile, on its own thread
        if occupant is not None:
            raise Refused(f"{occupant.name} is running; stop it first")

    def stop(self, reason: str, *, is_end: bool = False) -> None:
        """Tell the occupant, if there is one."""
        self.latest_stop = Stop(reason, is_end)
        occupant = self._occupant  # it may leave meanwhile, on its own thread
        if occupant is not None:
            occupant.stop(reason, is_end=is_end)
