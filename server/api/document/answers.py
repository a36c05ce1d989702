"""What the most used answers hold. They describe, and convert nothing: answers are made by hand, once for everybody.

Units stand in the names. More fields may come; none that is here goes away.
"""

from __future__ import annotations

from typing import Any, Literal

from pydantic import BaseModel, Field

RigWord = Literal["disarmed", "armed", "running", "held", "fault"]
Triple = list[float | None]
"""Of the axes x, y and z."""


class Problem(BaseModel):
    """RFC 9457: why a request was refused, and what to do."""

    type: str = Field(description="A name of this kind of problem, as a URN.")
    title: str
    status: int
    detail: str = Field(description="What came, what is allowed, in which unit, and what to do.")
    errors: list[dict[str, Any]] = Field(default=[], description="The offending fields of a body or query.")


class Health(BaseModel):
    status: Literal["ok", "failing"]
    version: str
    reason: str = Field(default="", description="Why it is failing.")


class Point(BaseModel):
    x_mm: float | None
    y_mm: float | None


class Pose(Point):
    """In the workspace: x to the right, y up in the camera's picture, heading counter-clockwise from x."""

    heading_deg: float | None


class Fault(BaseModel):
    code: str
    message: str
    since_s: float | None = Field(description="How long it has been there.")


class Command(BaseModel):
    controller: str
    pivot: Literal[1, -1] = Field(description="The end that the robot stands on: 1 is A, -1 is B.")
    rate_deg_s: float | None
    heading_goal_deg: float | None
    tilt_deg: float | None
    field_mT: float | None


class Progress(BaseModel):
    """The run that goes on."""

    id: str
    elapsed_s: float | None
    duration_s: float | None
    passes: float | None
    passes_done: float | None
    paused: bool
    mean_error_mm: float | None
    steps: int = Field(description="Pivot switches.")
    sweeps: int
    reversals: int


class Loop(BaseModel):
    rate_Hz: float | None
    period_p99_ms: float | None
    latency_p50_ms: float | None = Field(description="From a frame to the bytes of its command.")
    latency_p99_ms: float | None
    dropped_frames: int


class Holder(BaseModel):
    id: str = Field(description="A public name of the client, the same for everybody.")
    name: str
    note: str


class State(BaseModel):
    """One snapshot of everything; a tick of the telemetry has the same fields."""

    rig: RigWord
    reason: str = Field(description="Why it is in this state, in the operator's words.")
    faults: list[Fault]
    simulated: bool
    tick: int
    time_s: float | None
    captured_s: float | None
    tracking: Literal["locked", "predicted", "lost"]
    tracking_reason: str
    tracking_age_s: float | None
    error_mm: float | None
    saturated: bool
    limited_by: str
    pose: Pose | None
    pose_sigma: Pose
    reference: Point | None
    currents_A: Triple
    measured_currents_A: Triple
    field_mT: Triple
    coil_heat: Triple = Field(description="Share of the heat that each coil may have.")
    command: Command
    run: Progress | None
    camera: dict[str, float | None]
    loop: Loop
    link: dict[str, Any]
    recording: dict[str, Any]
    operator: Holder | None


class Operator(BaseModel):
    holder: dict[str, Any] | None
    asking: dict[str, Any] | None
    you: str = Field(description="Your own `id`.")
    you_may: Literal["view", "operate", "administer"]
    lease_s: float
    take_over_after_s: float


class Choice(BaseModel):
    name: str
    parameters: dict[str, Any]


class Gait(BaseModel):
    sweep_deg: float
    tilt_deg: float
    field_mT: float
    max_rate_deg_s: float
    path_step_s: float


class Selection(BaseModel):
    """What the next run walks by."""

    controller: Choice
    trajectory: Choice
    gait: Gait


class Kind(BaseModel):
    """A controller or a trajectory. parameters: JSON schema with defaults, bounds and units."""

    name: str
    title: str
    summary: str
    parameters: dict[str, Any]


class Metrics(BaseModel):
    """The figures of a run that is over."""

    mean_error_mm: float | None
    normalized_mean_error: float | None = Field(description="Mean error over the robot's length.")
    rms_error_mm: float | None
    max_error_mm: float | None
    end_error_mm: float | None
    travelled_mm: float | None
    duration_s: float | None
    ticks: int
    steps: int = Field(description="Pivot switches.")
    sweeps: int
    reversals: int


class Run(Selection):
    id: str
    label: str
    tags: list[str]
    state: str
    reason: str
    started_at: str = Field(description="ISO 8601, UTC.")
    passes: float | None
    duration_s: float | None
    unattended: bool
    metrics: Metrics | None


class RunPage(BaseModel):
    """Newest first. next: the cursor of the following page, or null."""

    runs: list[Run]
    next: str | None
    total: int


class Event(BaseModel):
    number: int
    time_s: float
    at: str = Field(description="ISO 8601, UTC.")
    severity: Literal["info", "warn", "error"]
    code: str
    message: str
    run_id: str | None


class EventPage(BaseModel):
    """Newest first. next: the cursor of the following page, or null."""

    events: list[Event]
    next: int | None


class Preview(BaseModel):
    points_mm: list[list[float]]
    length_mm: float
    duration_s: float | None


class Role(BaseModel):
    role: Literal["viewer", "operator", "admin"]
