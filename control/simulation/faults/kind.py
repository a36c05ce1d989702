"""What a kind of fault is: its name, the operator's words for it, its parameters, and the switch it throws."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from pydantic import Field

from control.registry import Parameters
from control.simulation.faults.points import FaultPoints


class Family(StrEnum):
    CAMERA = "camera"
    LINE = "line"
    BOARD = "board"
    COMPUTER = "computer"
    CONTROLLER = "controller"
    LIMITS = "limits"
    DISK = "disk"


class Nothing(Parameters):
    """A fault that is there or is not."""


def _stays(points: FaultPoints) -> None:
    """What has happened once needs no end."""


@dataclass(frozen=True, slots=True)
class FaultKind:
    """One kind of fault.

    row: of the list of faults that the rig promises to survive.  what: happens, in the operator's words.
    mends: how it goes away.  begin, end: throw the switch and put it back; `begin` takes the parameters.
    happens_once: it is over as soon as it has begun.
    """

    name: str
    row: int
    family: Family
    title: str
    what: str
    mends: str
    begin: Callable[[FaultPoints, Any], None]
    end: Callable[[FaultPoints], None] = _stays
    parameters: type[Parameters] = Nothing
    happens_once: bool = False


WHEN_TAKEN_AWAY = "when the fault is taken away"


def quantity(default: float, unit: str, least: float, most: float, title: str) -> Any:
    """A parameter with its unit and range."""
    return Field(default=default, ge=least, le=most, title=title, json_schema_extra={"unit": unit})


def share(default: float, title: str) -> Any:
    """A share of all, 0 to 1."""
    return quantity(default, "1", 0.0, 1.0, title)
