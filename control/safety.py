"""Whether the rig may put current into its coils: the state table and the failsafe arbiter.

Both are pure. The arbiter turns what is known at one instant into findings; the most severe one decides.
The table says which state follows; what it does not list is refused with the reason.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum, StrEnum

from control.gait import Gait
from control.model import Pose, Tracking
from control.snapshot import RigState

FRAME_STALE = 0.100
"""A camera without a frame for this long is dead, s (three to six frames at 60 Hz, faults.md)."""
FRAME_TOO_LATE = 0.150
"""A frame that was captured longer ago than this must not steer the robot, s."""
FROZEN_FRAMES = 3
"""This many identical pictures in a row, the first included, are a frozen camera: noise never repeats."""
PREDICT_FOR = 0.150
"""How long the robot may be steered by prediction alone, s (faults.md)."""
TELEMETRY_STALE = 0.300
"""A board that says nothing for this long is gone, s (faults.md)."""
LOOP_STALL = 0.200
"""A tick that comes this much later than the one before stops the field, s (faults.md)."""
CURRENT_MISMATCH = 0.100
"""Sensed and commanded current may differ for this long, s (faults.md row 14)."""

NOT_DRIVING = 0.150
"""A board that should drive and does not for this long has expired or refused, s (five telemetry messages
at the loop's pace, and the serial line's way there and back)."""

SUPPLY_LOW = "supply_low"
"""What the board calls a supply that is off; unlike its other faults it mends without a reset."""


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


class Severity(IntEnum):
    """HOLD: zero current, the run is kept.  DISARM: needs a new arming.  LATCH: needs a reset first."""

    WARN = 1
    HOLD = 2
    DISARM = 3
    LATCH = 4


@dataclass(frozen=True, slots=True)
class Finding:
    severity: Severity
    code: str
    message: str


@dataclass(frozen=True, slots=True)
class Limits:
    """currents: A per coil.  field: T.  rate: rad/s.

    soft, hard: half sizes of the squares that the centre should and must keep, m.
    """

    currents: tuple[float, float, float] = (8.0, 8.0, 8.0)
    field: float = 0.015
    rate: float = math.radians(360.0)
    soft: float = 0.062
    hard: float = 0.068


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


@dataclass(frozen=True, slots=True)
class Health:
    """What is known at one instant; times and ages in s, None or inf for what never came.

    tick_gap: since the last tick.  frame_age: since the newest frame arrived.  frame_delay: from its
    capture to now.  link_ready: greeted and configured.  link_reason: why it is not.
    link_incident: how the conversation with the board broke since the arm edge, "" if it did not.
    not_driving: how long the board has not been driving although it should.
    current_mismatch: how long sensed and commanded currents have disagreed.
    """

    tick_gap: float
    frame_age: float
    frame_delay: float
    identical_frames: int
    tracking: Tracking
    tracking_age: float
    pose: Pose | None
    link_ready: bool
    link_reason: str
    link_incident: str
    telemetry_age: float
    board_faults: tuple[str, ...]
    board_state: str
    not_driving: float
    current_mismatch: float


def assess(health: Health, limits: Limits) -> tuple[Finding, ...]:
    """Everything that is wrong now, most severe first. Comparisons accept; NaN never passes one."""
    found = [*_camera(health), *_robot(health, limits), *_board(health)]
    if not health.tick_gap <= LOOP_STALL:
        found.append(Finding(Severity.HOLD, "stall", f"the loop stood still for {health.tick_gap:.2f} s"))
    return tuple(sorted(found, key=lambda finding: -finding.severity))


def _camera(health: Health) -> list[Finding]:
    if not health.frame_age <= FRAME_STALE:
        return [Finding(Severity.HOLD, "camera", f"no frame {_for(health.frame_age)}")]
    if health.identical_frames >= FROZEN_FRAMES:
        message = f"the camera repeats one picture ({health.identical_frames} times)"
        return [Finding(Severity.HOLD, "frozen", message)]
    if not 0.0 <= health.frame_delay <= FRAME_TOO_LATE:
        allowed = f"0 to {FRAME_TOO_LATE * 1e3:.0f} ms are allowed"
        message = f"frames are {health.frame_delay * 1e3:.0f} ms old, {allowed}"
        return [Finding(Severity.HOLD, "late", message)]
    return []


def _robot(health: Health, limits: Limits) -> list[Finding]:
    if health.tracking is Tracking.LOST or not health.tracking_age <= PREDICT_FOR:
        return [Finding(Severity.HOLD, "lost", "the robot is not seen, or not where it should be")]
    if health.pose is None or not health.pose.is_finite:
        return [Finding(Severity.HOLD, "lost", "the robot's pose is not known")]
    reach = max(abs(health.pose.x), abs(health.pose.y))
    where = f"the robot is at ({health.pose.x * 1e3:.1f}, {health.pose.y * 1e3:.1f}) mm"
    if not reach <= limits.hard:
        return [Finding(Severity.HOLD, "outside", f"{where}, the limit is ±{limits.hard * 1e3:.0f} mm")]
    if not reach <= limits.soft:
        return [Finding(Severity.WARN, "margin", f"{where}, near the limit of the workspace")]
    return []


def _board(health: Health) -> list[Finding]:
    if health.link_incident:
        return [Finding(Severity.LATCH, "board-reset", health.link_incident)]
    if not health.link_ready:
        return [Finding(Severity.DISARM, "link", health.link_reason)]
    if not health.telemetry_age <= TELEMETRY_STALE:
        return [Finding(Severity.DISARM, "telemetry", f"no word from the board {_for(health.telemetry_age)}")]
    if health.board_faults == (SUPPLY_LOW,):
        return [Finding(Severity.DISARM, "supply", "the supply of the coils is low or off; switch it on")]
    if health.board_faults:
        return [Finding(Severity.LATCH, "board", f"the board reports: {', '.join(health.board_faults)}")]
    if not health.not_driving <= NOT_DRIVING:
        return [Finding(Severity.DISARM, "board", f"the board does not drive: it is {health.board_state}")]
    if not health.current_mismatch <= CURRENT_MISMATCH:
        message = "the coils do not carry the commanded current: check the supply and the coil leads"
        return [Finding(Severity.DISARM, "current", message)]
    return []


def _for(age: float) -> str:
    return f"for {age:.2f} s" if math.isfinite(age) else "yet"
