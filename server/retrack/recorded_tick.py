"""One tick of a recording as the parts of a rig take it: SI, and only what looking again needs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import msgspec

from control.field import Corner, FieldTrace
from control.model import PIVOT_A, PIVOT_B, Pivot, Pose
from control.snapshot import Command
from server.recording.messages import CommandMessage, Estimate, FieldMessage, Measurement, Reference, State
from server.recording.reading.recording import Recording
from server.recording.reading.tick_reading import Tick
from server.settings import MM

TOPICS = ("/state", "/estimate", "/measurement", "/reference", "/command", "/field")
MILLI = 1e-3


@dataclass(frozen=True, slots=True)
class RecordedTick:
    """time, captured_at (of the newest picture): rig time, s.  since_start: of the run, s.

    seen_at: capture time of the newest picture in which the robot was found.
    elapsed: time walked so far, s; None while no run is on.
    """

    number: int
    time: float
    since_start: float
    captured_at: float | None
    rig: str
    tracking: str
    elapsed: float | None
    limited_by: str
    pose: Pose | None
    seen_at: float | None
    reference: tuple[float, float] | None
    command: Command
    trace: FieldTrace


def recorded_ticks(recording: Recording) -> Iterator[RecordedTick]:
    """One after the other; a tick of which something is missing or makes no sense is left out."""
    offset = rig_time_at_start(recording)
    for messages in recording.ticks(topics=TOPICS):
        try:
            yield _tick(messages, offset)
        except (KeyError, msgspec.ValidationError):
            continue


def rig_time_at_start(recording: Recording) -> float:
    """What the rig's clock showed when the run began, s."""
    for entry in recording.messages(["/state"]):
        if isinstance(entry.data, dict) and isinstance(entry.data.get("time_s"), float):
            return entry.data["time_s"] - entry.time_s
    return 0.0


def _tick(messages: Tick, offset: float) -> RecordedTick:
    state = msgspec.convert(messages["/state"], State)
    return RecordedTick(
        number=state.tick,
        time=state.time_s,
        since_start=state.time_s - offset,
        captured_at=state.captured_s,
        rig=state.rig,
        tracking=state.tracking,
        elapsed=None if state.run is None else state.run.elapsed_s,
        limited_by=state.limited_by,
        pose=_pose(messages),
        seen_at=_seen_at(messages),
        reference=_reference(messages),
        command=_command(msgspec.convert(messages["/command"], CommandMessage)),
        trace=_trace(msgspec.convert(messages["/field"], FieldMessage)),
    )


def _pose(messages: Tick) -> Pose | None:
    if "/estimate" not in messages:
        return None
    found = msgspec.convert(messages["/estimate"], Estimate)
    return Pose(found.x_mm * MM, found.y_mm * MM, math.radians(found.heading_deg))


def _seen_at(messages: Tick) -> float | None:
    if "/measurement" not in messages:
        return None
    return msgspec.convert(messages["/measurement"], Measurement).captured_s


def _reference(messages: Tick) -> tuple[float, float] | None:
    if "/reference" not in messages:
        return None
    wanted = msgspec.convert(messages["/reference"], Reference)
    return wanted.x_mm * MM, wanted.y_mm * MM


def _command(sent: CommandMessage) -> Command:
    return Command(
        controller=sent.controller,
        pivot=_pivot(sent.pivot),
        rate=math.radians(sent.rate_deg_s),
        heading_goal=math.radians(sent.heading_goal_deg),
        tilt=math.radians(sent.tilt_deg),
        field=sent.field_mT * MILLI,
    )


def _pivot(sign: int) -> Pivot:
    return PIVOT_A if sign > 0 else PIVOT_B


def _trace(field: FieldMessage) -> FieldTrace:
    return FieldTrace(
        is_on=field.is_on,
        heading=math.radians(field.heading_deg),
        elevation=math.radians(field.elevation_deg),
        strength=field.strength_mT * MILLI,
        full_at=math.inf if field.full_at_s is None else field.full_at_s,
        corners=tuple(
            Corner(each.time_s, math.radians(each.heading_deg), math.radians(each.elevation_deg))
            for each in field.corners
        ),
        anew=field.corners_anew,
    )
