"""Whether the rig may put current into its coils: the table of its states, and what a gait may ask for.

The table says which state follows an event; what it does not list is refused with the reason. What is wrong
at an instant, and how gravely, is the arbiter's (`control.arbiter`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from control.gait import Gait
from control.snapshot import RigState, Vector


class Refused(Exception):
    """An interlock forbids what was asked; the text says why and what to do."""


class Event(StrEnum):
    """What can happen to the rig."""

    ARM = "arm"
    START = "start"
    JOG = "jog"
    FINISH = "finish"
    HOLD = "hold"
    RESUME = "resume"
    DISARM = "disarm"
    LATCH = "latch"
    RESET = "reset"


_D, _A, _R, _H, _F = (
    RigState.DISARMED,
    RigState.ARMED,
    RigState.RUNNING,
    RigState.HELD,
    RigState.FAULT,
)

TRANSITIONS: dict[tuple[RigState, Event], RigState] = {
    (_D, Event.ARM): _A,
    (_A, Event.START): _R,
    (_A, Event.JOG): _A,
    (_R, Event.FINISH): _A,
    (_A, Event.HOLD): _H,
    (_R, Event.HOLD): _H,
    (_H, Event.RESUME): _R,
    (_A, Event.DISARM): _D,
    (_R, Event.DISARM): _D,
    (_H, Event.DISARM): _D,
    (_D, Event.LATCH): _F,
    (_A, Event.LATCH): _F,
    (_R, Event.LATCH): _F,
    (_H, Event.LATCH): _F,
    (_F, Event.RESET): _D,
}
"""HELD resumes to RUNNING; a hold without a run resumes to RUNNING for one tick and is armed at once."""

ENERGISED = frozenset({RigState.ARMED, RigState.RUNNING})
"""The only states in which a drive command may leave the host."""

_WHAT_TO_DO = {
    RigState.DISARMED: "arm it first",
    RigState.ARMED: "it is armed and free",
    RigState.RUNNING: "stop the run first",
    RigState.HELD: "resume it, stop the run or disarm",
    RigState.FAULT: "reset it first",
}


def after(state: RigState, event: Event) -> RigState:
    """The state that follows; raises `Refused` where the table has none."""
    following = TRANSITIONS.get((state, event))
    if following is None:
        raise Refused(f"cannot {event} while the rig is {state}: {_WHAT_TO_DO[state]}")
    return following


@dataclass(frozen=True, slots=True)
class Limits:
    """currents: A per coil.  field: T.  rate: rad/s.

    soft: half size of the square that the robot's centre is not driven out of, m.  hard: half size of the
    square outside which it is not driven at all, m.
    """

    currents: Vector
    field: float
    rate: float
    soft: float
    hard: float


def check_gait(gait: Gait, limits: Limits) -> None:
    """Refuse a gait that the rig file's limits do not allow."""
    for name, value, limit, unit in (
        ("fastest swing", math.degrees(gait.max_rate), math.degrees(limits.rate), "degrees/s"),
        ("field", gait.field * 1e3, limits.field * 1e3, "mT"),
    ):
        if not 0.0 <= value <= limit * (1.0 + 1e-9):
            raise Refused(
                f"the {name} of {value:g} {unit} is beyond this rig's {limit:g} {unit}; choose less"
            )
