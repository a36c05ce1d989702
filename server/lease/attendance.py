"""What a rig knows of its operator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

T = TypeVar("T")


class Attendance(Protocol):
    """Who looks after a rig."""

    def absence(self, walking: bool) -> str:
        """Why the rig must not go on by itself, "" while it may; on the rig's thread.

        walking: an attended run goes on; else the rig is armed and idle.
        """
        ...

    def in_state(self) -> dict[str, Any] | None:
        """The operator as everybody sees it, None while there is none."""
        ...


class NoLease:
    """Of a rig that is asked by its own program alone: whoever holds it looks after it."""

    def absence(self, walking: bool) -> str:  # noqa: ARG002 (others need it)
        return ""

    def in_state(self) -> None:
        return None


Permit = Callable[[], None]
"""Asked where a command takes effect; raises where it may not any more."""


def free() -> None:
    """The permit of whoever needs none."""


def permitted(request: Callable[[], T], permit: Permit) -> T:
    """Carry it out if it may be."""
    permit()
    return request()
