"""The one immutable record that leaves the loop at each tick; everybody outside reads this and no more.

All values are SI; the edge (`server.api.schemas`) converts to the lab's units.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

from control.field import FieldTrace
from control.model import Observation, Pivot, Pose, Tracking

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)
Covariance = tuple[float, float, float, float, float, float]
"""Of (x, y, heading): the upper triangle xx, xy, xh, yy, yh, hh; m^2, m rad, rad^2."""


class RigState(StrEnum):
    """What the rig may do: only ARMED and RUNNING ever put current into a coil."""

    DISARMED = "disarmed"
    ARMED = "armed"
    RUNNING = "running"
    HELD = "held"
    FAULT = "fault"


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong: a short name, a sentence for people, and when it was first seen (rig time, s)."""

    code: str
    message: str
    since: float


@dataclass(frozen=True, slots=True)
class Command:
    """What the rig asks of the field at this tick.

    rate: of the field's heading, rad/s.  heading_goal: where the field's heading stops, rad.
    tilt: elevation of the field that presses the pivot down, rad.  field: strength, T (0 when idle).
    """

    controller: str
    pivot: Pivot
    rate: float
    heading_goal: float
    tilt: float
    field: float


@dataclass(frozen=True, slots=True)
class Timing:
    """How the loop keeps its pace: rate in Hz, the rest in s; latency is frame-in to bytes-out."""

    rate: float
    period_p99: float
    latency_p50: float
    latency_p99: float
    dropped_frames: int


@dataclass(frozen=True, slots=True)
class CameraTiming:
    """latency: from mid-exposure, as far as it is known, until the frame is here, s.  rate: frames/s.

    None before there are frames.
    """

    latency: float | None = None
    rate: float | None = None


@dataclass(frozen=True, slots=True)
class LinkCounts:
    """What went over the link since the program began, in messages.

    broken: received frames that were dropped, by what was wrong with them.  resends: questions that had to be
    asked again.  reconnects: how often a lost port was opened again.
    Counted by the board since its boot: board_bad, broken frames; refused and stale, whole messages that it
    did not obey.
    """

    sent: int
    received: int
    broken: Mapping[str, int]
    resends: int
    reconnects: int
    board_bad: int
    refused: int
    stale: int


@dataclass(frozen=True, slots=True)
class LinkStatus:
    """The serial link to the board.

    state: "closed", "greeting", "configuring" or "ready".  round_trip: last drive to its echo, s, or None;
    round_trip_median, round_trip_p99: of the last drives.  bad_frames: received and dropped.
    bad_share: 0..1 of the frames of the last second, in the worse direction.
    """

    state: str
    port: str
    firmware: str
    boot_id: int
    round_trip: float | None
    round_trip_median: float | None
    round_trip_p99: float | None
    bad_frames: int
    bad_share: float
    counts: LinkCounts
    board_state: str
    board_faults: tuple[str, ...]
    supply: float


@dataclass(frozen=True, slots=True)
class RunProgress:
    """The run that is going on: error figures are over the ticks so far, in m; see `control.metrics`."""

    id: str
    elapsed: float
    duration: float
    passes: float
    passes_done: float
    paused: bool
    mean_error: float
    steps: int
    sweeps: int
    reversals: int


@dataclass(frozen=True, slots=True)
class BoardReport:
    """The board's own field in its newest report.

    received_at: rig time, s.  board_time: since its boot, s.  heading (in [-pi, pi)), elevation: rad.
    """

    received_at: float
    board_time: float
    heading: float
    elevation: float


@dataclass(frozen=True, slots=True)
class Refusals:
    """What was not let in since the program began: pictures, sightings of the robot, reports of the board."""

    frames: int = 0
    sightings: int = 0
    reports: int = 0


@dataclass(frozen=True, slots=True)
class RecordingStatus:
    """What becomes of the recording of a run.

    state: "off" while nothing is recorded, "recording", or "failed" with the reason in `failure`.  run: its id.
    size: of the file so far, bytes.  ticks_waiting: to be written.  frames_left_out: pictures for which there was no
    time.
    """

    state: Literal["off", "recording", "failed"] = "off"
    run: str | None = None
    size: int = 0
    ticks_waiting: int = 0
    frames_left_out: int = 0
    failure: str = ""


NOT_RECORDED = RecordingStatus()


@dataclass(frozen=True, slots=True)
class Snapshot:
    """One tick.

    time: rig time of this tick, s.  captured_at: capture time of the newest frame, s, None before the first one.
    pose: the estimate carried forward to `time`; None while the robot has not been found.
    pose_sigma, pose_covariance: its standard deviations (m, m, rad) and its whole covariance.
    tracking_reason: why there is no lock, in the operator's words; "" with one.
    tracking_age: time since the last accepted measurement, s (inf before the first one).
    reference: the desired point, m, while a run is on.  error: distance from the pose to it, m.
    currents, measured_currents: commanded and sensed coil currents, A.  field: the field that the
    commanded currents make at the robot, T.  field_trace: how the board moves its field, as the host believes.
    report: what the board says of it, None before the first report.
    limited_by: the limit that holds the command back, "" for none.
    coil_heat: share of the heat that each coil may have, estimated.  refusals: what was not let in.
    recording: filled in by who records; the loop itself knows nothing of it.
    """

    tick: int
    time: float
    captured_at: float | None
    rig: RigState
    reason: str
    faults: tuple[Fault, ...]
    simulated: bool
    pose: Pose | None
    pose_sigma: Vector
    pose_covariance: Covariance
    observation: Observation | None
    tracking: Tracking
    tracking_reason: str
    tracking_age: float
    command: Command
    reference: tuple[float, float] | None
    error: float | None
    currents: Vector
    measured_currents: Vector
    field: Vector
    field_trace: FieldTrace
    report: BoardReport | None
    limited_by: str
    coil_heat: Vector
    refusals: Refusals
    body_tilt: float
    run: RunProgress | None
    camera: CameraTiming
    timing: Timing
    link: LinkStatus
    recording: RecordingStatus = NOT_RECORDED
