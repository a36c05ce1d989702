"""What the rig promises for each fault of the catalogue: what you see, what becomes of a rig that walks, and how soon.

The tests try every one of these out and hold the rig to it; the dashboard shows it beside what the rig does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from control.simulation.faults.injection import KINDS
from control.simulation.faults.kind import FaultKind
from control.snapshot import RigState

RUNNING, HELD, DISARMED, FAULT = RigState.RUNNING, RigState.HELD, RigState.DISARMED, RigState.FAULT

GO_ON = {RUNNING: "nothing to do", HELD: "resume", DISARMED: "arm", FAULT: "reset, then arm"}
"""How the operator goes on from each state."""

FRAME = 17
"""Milliseconds: a frame at 60 Hz, after which the loop looks again."""

REACHING = 200
"""Milliseconds that the simulated hand takes from the picture's border to the robot."""

AGAINST = DISARMED, "sign"
"""The robot turns against the field."""


@dataclass(frozen=True, slots=True)
class Promise:
    """Of a rig that walks.

    sees: what the operator sees.  after: the state it leads to.  code: of the line in the log; "" for a rig that
    carries on.  noticed, zero: at most so long after the fault, ms of the board; None where the robot walks on.
    or_else: another state and code that it may lead to, depending on where the robot is.
    met: the state that the operator meets where the server's watchdog is quicker than the loop.
    parameters: with which it holds, where it is not those that the fault has by itself.
    """

    name: str
    sees: str
    after: RigState
    code: str = ""
    noticed: int | None = None
    zero: int | None = None
    or_else: tuple[RigState, str] | None = None
    met: RigState | None = None
    parameters: Mapping[str, Any] = field(default_factory=dict)

    @property
    def outcomes(self) -> tuple[tuple[RigState, str], ...]:
        """States and codes that are as promised."""
        usual = self.after, self.code
        return (usual,) if self.or_else is None else (usual, self.or_else)

    @property
    def states(self) -> tuple[RigState, ...]:
        """What the operator may meet."""
        return (self.met,) if self.met is not None else tuple(state for state, _ in self.outcomes)

    @property
    def state(self) -> str:
        return " or ".join(state.value for state in self.states)

    @property
    def go_on(self) -> str:
        return " or ".join(GO_ON[state] for state in self.states)

    @property
    def kind(self) -> FaultKind:
        return KINDS[self.name]


_PROMISES = (
    Promise("camera_unplugged", "no frame for 0.10 s", HELD, "camera", 104, 105),
    Promise("camera_frozen", "the camera repeats one picture", HELD, "frozen", 3 * FRAME, 4 * FRAME),
    Promise("camera_late", "no frame for 0.10 s, then how old the frames are", HELD, "camera", 104, 105),
    Promise("camera_drops", "a lower rate, nothing else", RUNNING),
    Promise(
        "camera_mirrored", "the robot is not where it should be, or turns against the field",
        HELD, "lost", 217, 218, or_else=AGAINST,
    ),
    Promise("robot_hidden", "the robot is not seen", HELD, "lost", 217, 218),
    Promise("light_off", "the robot is not seen", HELD, "lost", 217, 218),
    Promise("exposure_jump", "a brighter or darker picture, nothing else", RUNNING),
    Promise("flicker", "bands in the picture, nothing else", RUNNING),
    Promise(
        "glare", "a white spot on the robot; where it is large, the robot is partly covered",
        RUNNING, or_else=(HELD, "lost"),
    ),
    Promise("hand", "the robot is not seen", HELD, "lost", REACHING + 217, REACHING + 218),
    Promise("second_robot", "another robot in the picture, nothing else", RUNNING),
    Promise("debris", "bits in the picture, nothing else", RUNNING),
    Promise("sighting_jumps", "the robot is not where it should be", HELD, "lost", 217, 218),
    Promise("sighting_nan", "the robot is not seen; refused sightings are counted", HELD, "lost", 217, 218),
    Promise("camera_cropped", "pictures of another size", DISARMED, "frame", 2 * FRAME, 3 * FRAME),
    Promise("camera_timeless", "no frame; refused frames are counted", HELD, "camera", 100 + FRAME, 101 + FRAME),
    Promise("line_unplugged", "the port is gone", DISARMED, "link", 2 * FRAME, 155),
    Promise("line_silent", "no word from the board", DISARMED, "telemetry", 320, 325),
    Promise("line_jammed", "the port takes no bytes", DISARMED, "link", 2 * FRAME, 155),
    Promise("line_garbage", "the share of broken messages", DISARMED, "line", 700, 705),
    Promise("line_loses", "a longer round trip, nothing else", RUNNING),
    Promise("line_repeats", "nothing: old messages are not obeyed", RUNNING),
    Promise("line_reorders", "nothing: old messages are not obeyed", RUNNING),
    Promise("line_slow", "the line is slow, and how slow", DISARMED, "slow", 400, 530),
    Promise("board_reset", "the board was reset", FAULT, "board-reset", 2 * FRAME, 2),
    Promise("supply_off", "the supply is low or off", DISARMED, "supply", 2 * FRAME, 3 * FRAME),
    Promise("supply_low", "the supply is low or off", DISARMED, "supply", 2 * FRAME, 3 * FRAME),
    Promise("driver_fault", "the board reports: driver_fault", FAULT, "board", 2 * FRAME, 2),
    Promise("coil_open", "which coil shows no current", DISARMED, "coil", 200, 201, or_else=(HELD, "lost")),
    Promise("sense_dead", "which coil shows no current", DISARMED, "coil", 200, 201),
    Promise("sense_wrong", "the board reports: over_current", FAULT, "board", 3 * FRAME, 50),
    Promise(
        "coil_resistance", "which coil shows less current than commanded",
        DISARMED, "sense", 1500, 1501, or_else=(HELD, "lost"),
    ),
    Promise(
        "coil_swapped", "the robot is not where it should be, or turns against the field",
        HELD, "lost", 400, 401, or_else=AGAINST,
    ),
    Promise("loop_stalls", "the loop stood still", HELD, "stall", 400, 151),
    Promise("computer_sleeps", "the computer slept", HELD, "clock", 2000, 151),
    Promise("report_nan", "no word from the board; refused reports are counted", DISARMED, "telemetry", 320, 325),
    Promise("controller_raises", "what the controller raised", FAULT, "controller", 2 * FRAME, 3 * FRAME),
    Promise("controller_hangs", "which controller hangs", HELD, "clock", 3034, 151, met=FAULT),
    Promise("controller_nonsense", "what the controller returned", FAULT, "controller", 2 * FRAME, 3 * FRAME),
    Promise("robot_put", "the robot is not where it should be", HELD, "lost", 217, 218),
    Promise(
        "coil_hot", "which coil is too hot, and how long it must rest",
        HELD, "heat", 2 * FRAME, 3 * FRAME, parameters={"heat_percent": 105.0},
    ),
    Promise("disk_full", "the run has ended since its recording has failed", DISARMED, "recording", 1000, 1001),
    Promise("disk_read_only", "the run has ended since its recording has failed", DISARMED, "recording", 1000, 1001),
    Promise("disk_slow", "how much of the run waits to be written, nothing else", RUNNING),
)  # fmt: skip

PROMISES: Mapping[str, Promise] = MappingProxyType({promise.name: promise for promise in _PROMISES})
