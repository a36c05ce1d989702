"""The seam between a campaign and its rig: what a person does at a rig, for a program."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Protocol, TypeVar

from control.loop import ControlLoop
from control.runs import Run, RunRequest
from control.snapshot import Snapshot
from server.occupation import Occupant

T = TypeVar("T")


class RigGone(Exception):
    """There is no rig any more that could be asked; the text says why."""


class Operator(Protocol):
    """Everything blocks, and belongs to the campaign's thread. All of it raises `RigGone`.

    may_arm: a person has agreed that the campaign arms the rig when it begins.
    is_attended: somebody can come and reset or arm it.
    """

    may_arm: bool
    is_attended: bool

    @property
    def now(self) -> float:
        """The rig's time, s; goes on also while its loop does not."""
        ...

    def occupied(self, by: Occupant) -> AbstractContextManager[None]:
        """The rig belongs to the campaign meanwhile; raises `Refused`."""
        ...

    def tick(self) -> Snapshot:
        """Wait for the rig's next tick, though not for long."""
        ...

    def do(self, act: Callable[[ControlLoop], T]) -> T:
        """Between two ticks; raises what `act` raises, `Refused` among it."""
        ...

    def check_disk(self) -> None:
        """Raises `Refused` where a run could not be recorded."""
        ...

    def start(self, request: RunRequest, permit: Callable[[], None]) -> str:
        """Start a run that is recorded, and listed in the catalogue; its id. Raises like `ControlLoop.start`.

        permit: asked just before, between the same two ticks; what it raises is raised.
        """
        ...

    def outcome(self, id: str) -> Run:
        """A run that was started here, as it is now."""
        ...

    def is_recorded(self, id: str) -> bool:
        """Whether a run that is over is all in its recording and in the catalogue."""
        ...
