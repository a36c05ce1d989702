"""What is written of each tick: one type a topic, lab units in the names, every digit of the number.

A value that is not known is left out of its message.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Struct

from server.recording.schemas import quantity

Triple = tuple[float, ...]


class Part(Struct, frozen=True, kw_only=True, omit_defaults=True, gc=False):
    """A piece of a message."""


class OfTick(Part, frozen=True, kw_only=True):
    """Part of one tick of the loop."""

    time_s: Annotated[float, quantity("rig time of the tick", "s")]
    tick: Annotated[int, quantity("number of the tick")]


class FaultPart(Part, frozen=True, kw_only=True):
    """One thing that is wrong."""

    code: Annotated[str, quantity("short name")]
    message: Annotated[str, quantity("what is wrong, in words")]
    since_s: Annotated[float | None, quantity("how long it has been there", "s")] = None


class RunPart(Part, frozen=True, kw_only=True):
    """How far the run is, and how well it went so far."""

    id: Annotated[str, quantity("the run")]
    elapsed_s: Annotated[float, quantity("time walked", "s")]
    duration_s: Annotated[float | None, quantity("how long it will take", "s")] = None
    passes: Annotated[float, quantity("passes of the path that were asked for")]
    passes_done: Annotated[float, quantity("passes of the path done")]
    paused: Annotated[bool, quantity("held by the operator or by an interlock")]
    mean_error_mm: Annotated[float, quantity("mean distance from the reference so far", "mm")]
    steps: Annotated[int, quantity("changes of the pivot")]
    sweeps: Annotated[int, quantity("sweeps")]
    reversals: Annotated[int, quantity("reversals of the sweep")]


class State(OfTick, frozen=True, kw_only=True):
    """What the rig does and what it knows of itself."""

    captured_s: Annotated[float | None, quantity("capture time of the newest picture, rig time", "s")] = None
    rig: Annotated[str, quantity("disarmed, armed, running, held or fault")]
    reason: Annotated[str, quantity("why, in words")]
    faults: Annotated[list[FaultPart], quantity("what is wrong, worst first")]
    simulated: Annotated[bool, quantity("whether the rig is simulated")]
    tracking: Annotated[str, quantity("locked, predicted or lost")]
    tracking_reason: Annotated[str, quantity("why there is no lock, in words")]
    tracking_age_s: Annotated[float | None, quantity("since the last sighting that was believed", "s")] = None
    limited_by: Annotated[str, quantity("the limit that holds the command back")]
    coil_heat: Annotated[Triple, quantity("share of the heat that coils x, y, z may have", length=3)]
    refused_frames: Annotated[int, quantity("pictures refused since the program began")]
    refused_sightings: Annotated[int, quantity("sightings refused since the program began")]
    refused_reports: Annotated[int, quantity("board reports refused since the program began")]
    body_tilt_deg: Annotated[float, quantity("how far the free end is expected to be raised", "deg")]
    run: Annotated[RunPart | None, quantity("the run")] = None


class Measurement(OfTick, frozen=True, kw_only=True):
    """What the tracker saw in the newest picture; without a place where the robot was not found."""

    captured_s: Annotated[float | None, quantity("capture time of the picture, rig time", "s")] = None
    x_mm: Annotated[float | None, quantity("place of the robot's centre", "mm")] = None
    y_mm: Annotated[float | None, quantity("place of the robot's centre", "mm")] = None
    heading_deg: Annotated[float | None, quantity("direction of walking, from x towards y", "deg")] = None
    centre_px: Annotated[Triple, quantity("u, v of the centre", "px", 2)] | None = None
    corners_px: Annotated[Triple, quantity("u, v of each corner in turn", "px")] | None = None
    area_px: Annotated[float | None, quantity("area of the robot in the picture", "px^2")] = None
    window_px: Annotated[Triple, quantity("region that was searched: u0, v0, u1, v1", "px", 4)]
    rivals_px: Annotated[Triple, quantity("u, v of each other blob that looks like the robot", "px")]
    reason: Annotated[str, quantity("why there is no sighting, in words")]
    assumes_ends: Annotated[bool, quantity("only the rig file tells which end is A")]


class Estimate(OfTick, frozen=True, kw_only=True):
    """Where the robot is now, and how sure that is."""

    x_mm: Annotated[float, quantity("place of the robot's centre", "mm")]
    y_mm: Annotated[float, quantity("place of the robot's centre", "mm")]
    heading_deg: Annotated[float, quantity("direction of walking, unwrapped", "deg")]
    sigma_x_mm: Annotated[float, quantity("standard deviation of x", "mm")]
    sigma_y_mm: Annotated[float, quantity("standard deviation of y", "mm")]
    sigma_heading_deg: Annotated[float, quantity("standard deviation of the heading", "deg")]
    covariance_mm_deg: Annotated[
        Triple, quantity("covariance of x, y, heading, row by row", "mm^2, mm deg, deg^2", 9)
    ]


class Reference(OfTick, frozen=True, kw_only=True):
    """Where the robot should be."""

    x_mm: Annotated[float, quantity("desired place", "mm")]
    y_mm: Annotated[float, quantity("desired place", "mm")]
    error_mm: Annotated[float | None, quantity("distance of the estimate from it", "mm")] = None


class CommandMessage(OfTick, frozen=True, kw_only=True):
    """What is asked of the field."""

    controller: Annotated[str, quantity("who asks; empty for nobody")]
    pivot: Annotated[int, quantity("end that is pressed down: 1 is A, -1 is B")]
    rate_deg_s: Annotated[float, quantity("rate of the field's heading", "deg/s")]
    heading_goal_deg: Annotated[float, quantity("where the field's heading stops, unwrapped", "deg")]
    tilt_deg: Annotated[float, quantity("elevation of the field that presses the pivot down", "deg")]
    field_mT: Annotated[float, quantity("strength of the field", "mT")]


class Currents(OfTick, frozen=True, kw_only=True):
    """Coil currents, as the board's newest report has them."""

    commanded_A: Annotated[Triple, quantity("commanded current of coils x, y, z", "A", 3)]
    measured_A: Annotated[Triple, quantity("sensed current of coils x, y, z", "A", 3)]


class CornerPart(Part, frozen=True, kw_only=True):
    """A corner point of the field's motion, which is straight between two of them."""

    time_s: Annotated[float, quantity("rig time", "s")]
    heading_deg: Annotated[float, quantity("the field's heading, unwrapped", "deg")]
    elevation_deg: Annotated[float, quantity("the field's elevation, 0 while off", "deg")]


class FieldMessage(OfTick, frozen=True, kw_only=True):
    """The field that the currents make, how the host believes that it moves, and what the board says."""

    field_mT: Annotated[Triple, quantity("field of the commanded currents at the robot, x, y, z", "mT", 3)]
    is_on: Annotated[bool, quantity("whether the board has been told to drive")]
    heading_deg: Annotated[float, quantity("the field's heading as the host believes, unwrapped", "deg")]
    elevation_deg: Annotated[float, quantity("its elevation; above 0 it presses on B", "deg")]
    strength_mT: Annotated[float, quantity("its strength", "mT")]
    full_at_s: Annotated[float | None, quantity("when it is or was at full strength, rig time", "s")] = None
    corners: Annotated[list[CornerPart], quantity("new corner points of its motion, oldest first")]
    corners_anew: Annotated[bool, quantity("the corner points that were told before do not hold")]
    board_heading_deg: Annotated[float | None, quantity("heading in the board's newest report", "deg")] = None
    board_elevation_deg: Annotated[float | None, quantity("elevation in that report", "deg")] = None
    board_time_s: Annotated[float | None, quantity("that report's time since the board's boot", "s")] = None
    board_received_s: Annotated[float | None, quantity("when that report came, rig time", "s")] = None


class TimingMessage(OfTick, frozen=True, kw_only=True):
    """How loop and camera keep their pace."""

    rate_Hz: Annotated[float | None, quantity("ticks", "Hz")] = None
    period_p99_ms: Annotated[float | None, quantity("99th percentile of the loop's period", "ms")] = None
    latency_p50_ms: Annotated[float | None, quantity("median from frame in to bytes out", "ms")] = None
    latency_p99_ms: Annotated[float | None, quantity("99th percentile of the same", "ms")] = None
    dropped_frames: Annotated[int, quantity("pictures that came too fast, since the program began")]
    camera_latency_ms: Annotated[float | None, quantity("from exposure until a picture is here", "ms")] = None
    camera_rate_Hz: Annotated[float | None, quantity("pictures", "Hz")] = None


class BrokenPart(Part, frozen=True, kw_only=True):
    """Messages that were dropped for one reason."""

    what: Annotated[str, quantity("what was wrong with them")]
    count: Annotated[int, quantity("how many there were")]


class LinkMessage(OfTick, frozen=True, kw_only=True):
    """The serial line to the board; counts since the program began."""

    state: Annotated[str, quantity("closed, greeting, configuring or ready")]
    port: Annotated[str, quantity("where the board is plugged in")]
    firmware: Annotated[str, quantity("the board's program")]
    boot_id: Annotated[int, quantity("changes with each start of the board")]
    round_trip_ms: Annotated[float | None, quantity("from the last drive to its echo", "ms")] = None
    round_trip_median_ms: Annotated[float | None, quantity("median of the last drives", "ms")] = None
    round_trip_p99_ms: Annotated[float | None, quantity("99th percentile of the last drives", "ms")] = None
    bad_frames: Annotated[int, quantity("received messages that were broken")]
    bad_share: Annotated[float | None, quantity("broken share of the last second, 0 to 1")] = None
    sent: Annotated[int, quantity("messages sent")]
    received: Annotated[int, quantity("messages received")]
    broken: Annotated[list[BrokenPart], quantity("broken messages by what was wrong with them")]
    resends: Annotated[int, quantity("questions asked again")]
    reconnects: Annotated[int, quantity("times that a lost port was opened again")]
    board_bad: Annotated[int, quantity("broken messages that the board received")]
    refused: Annotated[int, quantity("messages that the board did not obey")]
    stale: Annotated[int, quantity("messages that came too late for the board")]
    board_state: Annotated[str, quantity("what the board does")]
    board_faults: Annotated[tuple[str, ...], quantity("what the board has latched")]
    supply_V: Annotated[float | None, quantity("supply of the coils; 0 where it is not sensed", "V")] = None


class SelectionMessage(OfTick, frozen=True, kw_only=True):
    """What the run uses, at its beginning and whenever that was changed on the way."""

    controller: Annotated[str, quantity("name of the controller")]
    controller_parameters: Annotated[str, quantity("JSON object, units in its names")]
    trajectory: Annotated[str, quantity("name of the trajectory")]
    trajectory_parameters: Annotated[str, quantity("JSON object, units in its names")]
    gait: Annotated[str, quantity("JSON object, units in its names")]
    reference_x_mm: Annotated[Triple, quantity("the path's points", "mm")]
    reference_y_mm: Annotated[Triple, quantity("the path's points", "mm")]
