"""The failsafe arbiter: what is known at one instant -> what is wrong, most severe first; pure.

The most severe finding decides; the others are kept, so that clearing one cause keeps the rest. Every
comparison accepts what is good, so that a number that is none is never good.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

from control.axes import AXES
from control.coil_heat import OFF_AT, WARN_AT
from control.current_check import Mismatch
from control.link.conversion import BoardState
from control.model import Pose, Tracking
from control.response import AWAY
from control.safety import Limits
from control.snapshot import Vector
from control.workspace_guard import reach

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
CLOCK_GAP = 1.0
"""A tick later than this is no busy computer but one that slept, or a clock that jumped, s (faults.md)."""
CURRENT_MISMATCH = 0.100
"""Sensed and commanded current may differ for this long, s (faults.md row 14)."""
NOT_DRIVING = 0.150
"""A board that should drive and does not for this long has expired or refused, s (five telemetry messages
at the loop's pace, and the serial line's way there and back)."""
LINE_POOR = 0.01
"""Share of broken frames on the serial line above which it is worth a warning (faults.md)."""
LINE_BAD = 0.10
"""Share of broken frames above which the line is not to be trusted with current (faults.md)."""
LINE_SLOW = 0.100
"""A command and its echo that take longer are worth a warning, s: three times the usual two ticks (33 ms), and more
than a line takes that loses a third of its messages (67 ms)."""
LINE_TOO_SLOW = 0.200
"""Beyond this a stop would come no sooner than the board's own dead-man, s."""
STUCK_SHOWN = 5.0
"""A sweep that the robot did not make is shown for this long, s: several sweeps at walking pace."""

SUPPLY_LOW = "supply_low"
"""What the board calls a supply that is off; unlike its other faults it mends without a reset."""


class Severity(IntEnum):
    """HOLD: zero current, the run is kept.  DISARM: needs a new arming.  LATCH: needs a reset first."""

    OK = 0
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
class Health:
    """What is known at one instant; times and ages in s, None or inf for what never came.

    tick_gap: since the last tick.  frame_age: since the newest frame arrived.  frame_delay: from its
    capture to now.  camera_trouble: why none can come, "" when one could.  frame_problem: why the newest
    picture is not one of this rig's camera, "" if it is.  calibration_problem: why the saved calibration is not
    this camera's, "" if it is.
    tracking_reason: why the robot is not seen, "" where that is not known.
    reach_limit: half side of the square that the robot's centre must keep now, m.
    turned_away: how far the body has turned against the field, rad.  stuck_age: since a sweep was given up.
    link_ready: greeted and configured.  link_reason: why it is not.  link_incident: how the conversation with
    the board broke since the arm edge, "" if it did not.  bad_share: broken share of the line's frames, 0..1.
    line_lateness: how long a command and its echo certainly take.
    not_driving: how long the board has not been driving although it should.
    current_mismatch: how long sensed and commanded currents have disagreed.  mismatch: in what way, at last.
    coil_heat: share of the heat that each coil may have.  is_too_hot: they must cool down first.
    heat_wait: how long that takes.
    """

    tick_gap: float
    frame_age: float
    frame_delay: float
    frame_problem: str
    identical_frames: int
    tracking: Tracking
    tracking_age: float
    pose: Pose | None
    reach_limit: float
    turned_away: float
    stuck_age: float
    link_ready: bool
    link_reason: str
    link_incident: str
    bad_share: float
    line_lateness: float
    telemetry_age: float
    board_faults: tuple[str, ...]
    board_state: str
    not_driving: float
    current_mismatch: float
    mismatch: Mismatch
    coil_heat: Vector
    is_too_hot: bool
    heat_wait: float
    camera_trouble: str = ""
    calibration_problem: str = ""
    tracking_reason: str = ""


def assess(health: Health, limits: Limits) -> tuple[Finding, ...]:
    """Everything that is wrong now, most severe first; equally severe ones in the order of the signal's way."""
    found = [
        *_loop(health),
        *_camera(health),
        *_robot(health, limits),
        *_board(health),
        *_line(health),
        *_response(health),  # after board and line: what they lack explains a robot that turns wrongly
        *_heat(health),
    ]
    return tuple(sorted(found, key=lambda finding: -finding.severity))


def verdict(findings: tuple[Finding, ...]) -> Severity:
    """How grave the worst of them is."""
    return max((finding.severity for finding in findings), default=Severity.OK)


def _loop(health: Health) -> Iterator[Finding]:
    gap = health.tick_gap
    if 0.0 <= gap <= LOOP_STALL:
        return
    if 0.0 <= gap <= CLOCK_GAP:
        yield Finding(Severity.HOLD, "stall", f"the loop stood still for {gap:.2f} s")
    else:
        message = f"the computer slept or its clock jumped: {gap:.2f} s passed between two ticks"
        yield Finding(Severity.HOLD, "clock", message)


def _camera(health: Health) -> Iterator[Finding]:
    if health.calibration_problem:
        yield Finding(Severity.DISARM, "calibration", health.calibration_problem)
    if health.frame_problem:
        yield Finding(Severity.DISARM, "frame", health.frame_problem)
    elif not health.frame_age <= FRAME_STALE:
        yield Finding(Severity.HOLD, "camera", health.camera_trouble or f"no frame {_for(health.frame_age)}")
    elif not health.identical_frames < FROZEN_FRAMES:
        message = f"the camera repeats one picture ({health.identical_frames} times)"
        yield Finding(Severity.HOLD, "frozen", message)
    elif not 0.0 <= health.frame_delay <= FRAME_TOO_LATE:
        allowed = f"0 to {FRAME_TOO_LATE * 1e3:.0f} ms are allowed"
        message = f"frames are {health.frame_delay * 1e3:.0f} ms old, {allowed}"
        yield Finding(Severity.HOLD, "late", message)


def _robot(health: Health, limits: Limits) -> Iterator[Finding]:
    pose = health.pose
    if health.tracking is Tracking.LOST or not health.tracking_age <= PREDICT_FOR:
        message = "the robot is not seen, or not where it should be"
        if health.tracking_reason:
            message += f": {health.tracking_reason}"
        yield Finding(Severity.HOLD, "lost", message)
    elif pose is None or not pose.is_finite:
        yield Finding(Severity.HOLD, "lost", "the robot's pose is not known")
    elif not reach(pose) <= health.reach_limit:
        message = f"{_where(pose)}, the limit is ±{health.reach_limit * 1e3:.1f} mm: bring it back in"
        yield Finding(Severity.HOLD, "outside", message)
    elif not reach(pose) <= limits.soft:
        message = f"{_where(pose)}, beyond ±{limits.soft * 1e3:.0f} mm: it is driven only inward"
        yield Finding(Severity.WARN, "margin", message)


def _response(health: Health) -> Iterator[Finding]:
    if not health.turned_away <= AWAY:
        message = (
            "the robot turns against the field: a pair of coils with swapped leads, two pairs exchanged, a "
            "mirrored picture or a turned magnet; check them with `pivotrig calibrate`"
        )
        yield Finding(Severity.DISARM, "sign", message)
    if not health.stuck_age > STUCK_SHOWN:
        message = "the robot does not make its sweeps: does it stick, or is the field too weak?"
        yield Finding(Severity.WARN, "stuck", message)


def _board(health: Health) -> Iterator[Finding]:
    if health.link_incident:
        yield Finding(Severity.LATCH, "board-reset", health.link_incident)
    elif not health.link_ready:
        yield Finding(Severity.DISARM, "link", health.link_reason)
    elif not health.telemetry_age <= TELEMETRY_STALE:
        yield Finding(Severity.DISARM, "telemetry", f"no word from the board {_for(health.telemetry_age)}")
    elif health.board_faults == (SUPPLY_LOW,):
        yield Finding(Severity.DISARM, "supply", "the supply of the coils is low or off; switch it on")
    elif health.board_faults:
        yield Finding(Severity.LATCH, "board", f"the board reports: {', '.join(health.board_faults)}")
    elif not health.not_driving <= NOT_DRIVING and health.board_state == BoardState.EXPIRED:
        message = "no fresh command reached the board in time: it has switched the coils off by itself"
        yield Finding(Severity.HOLD, "expired", message)
    elif not health.not_driving <= NOT_DRIVING:
        yield Finding(Severity.DISARM, "board", f"the board does not drive: it is {health.board_state}")
    elif not health.current_mismatch <= CURRENT_MISMATCH:
        yield Finding(Severity.DISARM, health.mismatch.code, health.mismatch.message)


def _line(health: Health) -> Iterator[Finding]:
    if not health.bad_share <= LINE_POOR:
        severity = Severity.WARN if health.bad_share <= LINE_BAD else Severity.DISARM
        message = (
            f"{health.bad_share:.0%} of the messages on the serial line are broken: check cable and ground"
        )
        yield Finding(severity, "line", message)
    if not health.line_lateness <= LINE_SLOW:
        severity = Severity.WARN if health.line_lateness <= LINE_TOO_SLOW else Severity.DISARM
        message = (
            "the serial line is slow, or loses messages: a command and its echo take "
            f"{health.line_lateness * 1e3:.0f} ms; check its adapter, and what else uses its USB hub"
        )
        yield Finding(severity, "slow", message)


def _heat(health: Health) -> Iterator[Finding]:
    hottest, axis = max(zip(health.coil_heat, AXES, strict=True), key=_heat_of)
    if health.is_too_hot or not hottest < OFF_AT:
        message = (
            f"coil {axis} is at {hottest:.0%} of the heat it may have; it must cool to {WARN_AT:.0%}, "
            f"in about {health.heat_wait / 60.0:.0f} min"
        )
        yield Finding(Severity.HOLD, "heat", message)
    elif not hottest <= WARN_AT:
        message = f"coil {axis} is at {hottest:.0%} of the heat it may have: use less field, or let it rest"
        yield Finding(Severity.WARN, "heat", message)


def _heat_of(one: tuple[float, str]) -> float:
    """A share that is no number is the hottest of all."""
    share = one[0]
    return math.inf if math.isnan(share) else share


def _where(pose: Pose) -> str:
    return f"the robot is at ({pose.x * 1e3:.1f}, {pose.y * 1e3:.1f}) mm"


def _for(age: float) -> str:
    return f"for {age:.2f} s" if math.isfinite(age) else "yet"
