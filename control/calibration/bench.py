"""The coils driven by hand, without a run: one field at a time, always brought up from zero and back to it.

The bench does what the loop does for a walk, for people with a magnetometer or an ammeter and for the checks
that look at how the robot turns. It goes the loop's own way to the coils, under the board's dead-man and the
arbiter's findings about board and link; the robot it minds only where somebody looks at it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

from control.arbiter import Finding, Severity
from control.coils import Matrix
from control.link.conversion import DriveCommand, LinkError, Telemetry
from control.model import PIVOT_A, Frame
from control.parts import Camera, Parts
from control.safety import Refused
from control.snapshot import ZERO, RigState
from control.vitals import Vitals

FRAME_TIMEOUT = 0.05
"""A step of the bench takes no longer than this without a frame, s: a third of a command's time to live."""
READY_WITHIN = 5.0
"""Board and supply must be there after this long, s; a UNO takes 2 s to boot."""
STRENGTH = 0.010
"""Nominal field of a coil's command, T: the board ramps it from zero as it does the field of a walk."""
SETTLED_AFTER = 5.0
"""A coil's current is within 1 % of its end after so many times L/R."""
ZERO_WITHIN = 1.0
"""After a stop the board must report zero output within this time, s; it takes one report, 10 ms."""
ABOUT_THE_ROBOT = frozenset(
    {"camera", "frame", "frozen", "late", "lost", "outside", "margin", "sign", "stuck"}
)
"""Findings that do not concern coils that stand alone."""


@dataclass(frozen=True, slots=True)
class BenchSettings:
    """ttl: time to live of one command, s.  field_slew: of the board, T/s.  max_field: T."""

    time_to_live: float
    field_slew: float
    max_field: float


STOPPED = "an emergency stop has come: nothing is driven any more"

Watch = Callable[[Telemetry], None]
"""Told of each report of the board while a field is held."""


class Bench:
    """`with Bench(...) as bench:` ends at zero current whatever happens inside."""

    def __init__(self, camera: Camera, parts: Parts, settings: BenchSettings) -> None:
        """The link must have been opened; `camera` sets the pace and, simulated, moves the world."""
        self.parts = parts
        self.camera = camera
        self.settings = settings
        self.telemetry: Telemetry | None = None
        self._vitals = Vitals(parts, camera.now())
        self._then = camera.now()
        self._state = RigState.DISARMED

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.parts.actuation.stop(self.camera.now())

    @property
    def settling_time(self) -> float:
        """From the arm edge until a coil carries its current, s."""
        slowest = max(pair.inductance / pair.resistance for pair in self.parts.coils.pairs)
        return self.strength / self.settings.field_slew + SETTLED_AFTER * slowest

    @property
    def strength(self) -> float:
        """Nominal field of a coil's command, T."""
        return min(STRENGTH, self.settings.max_field)

    def wait_until_ready(self) -> None:
        """Greet the board; raises `Refused` with what stands in the way."""
        give_up = self.camera.now() + READY_WITHIN
        while True:
            self.step()
            blocking = self.blocking
            if blocking is None:
                return
            if self.camera.now() > give_up:
                raise Refused(f"the board is not ready: {blocking.message}")

    @property
    def blocking(self) -> Finding | None:
        """The worst finding about board, link or pace that forbids current."""
        grave = (f for f in self._vitals.findings if f.severity >= Severity.HOLD)
        return next((f for f in grave if f.code not in ABOUT_THE_ROBOT), None)

    def step(self) -> Frame | None:
        """One frame's time: hear the board; the picture, if one came."""
        frame = self.camera.read(FRAME_TIMEOUT)
        now = self.camera.now()
        self._vitals.hear(now, self._state)
        self.telemetry = self._vitals.telemetry
        self._vitals.judge(now - self._then, now, self._state, None)
        self._then = now
        return frame

    def energise(self, drive: DriveCommand) -> None:
        """The arm edge: the field comes up from zero; raises `Refused`."""
        if self.parts.actuation.stopped_from_outside:
            raise Refused(STOPPED)
        self._vitals.energised(self.camera.now())
        self._state = RigState.ARMED
        self._send(replace(drive, start_heading=drive.heading_goal))

    def keep(self, drive: DriveCommand) -> Frame | None:
        """Renew a command and wait a frame; at zero and `Refused` once anything forbids it."""
        frame = self.step()
        if self.parts.actuation.stopped_from_outside:
            raise Refused(STOPPED)
        blocking = self.blocking
        if blocking is not None:
            self.zero()
            raise Refused(blocking.message)
        self._send(drive)
        return frame

    def _send(self, drive: DriveCommand) -> None:
        try:
            self.parts.actuation.hold_steady(drive)
        except LinkError as error:
            self.zero()
            raise Refused(str(error)) from error

    def zero(self) -> None:
        """No current; returns once the board says so, at the latest after a second."""
        self._state = RigState.DISARMED
        self.parts.actuation.stop(self.camera.now())
        give_up = self.camera.now() + ZERO_WITHIN
        self.step()
        while self.camera.now() < give_up and not self._is_zero:
            self.step()

    @property
    def _is_zero(self) -> bool:
        return self.telemetry is not None and self.telemetry.duty == ZERO

    def hold_coil(self, coil: int, current: float, duration: float) -> list[Telemetry]:
        """The board's reports while `coil` (0, 1, 2) carries `current` (A) for `duration` (s), once settled."""
        until = self.camera.now() + self.settling_time + duration
        return self.hold_coil_while(coil, current, lambda: self.camera.now() < until)

    def hold_coil_while(
        self, coil: int, current: float, wanted: Callable[[], bool], watch: Watch | None = None
    ) -> list[Telemetry]:
        """The same as long as `wanted` says; watch: told of each report once the current has settled."""
        drive = self.coil_drive(coil, current)
        self.energise(drive)
        settled_at = self.camera.now() + self.settling_time
        reports: list[Telemetry] = []
        try:
            while wanted():
                self.keep(drive)
                if self.telemetry is None or self.camera.now() < settled_at:
                    continue
                reports.append(self.telemetry)
                if watch is not None:
                    watch(self.telemetry)
        except BaseException:
            self.parts.actuation.stop(self.camera.now())
            raise
        self.zero()
        return reports

    def coil_drive(self, coil: int, current: float) -> DriveCommand:
        """One pair alone: the allocation has one row, and the field is level along y."""
        rows = [(0.0, current / self.strength if row == coil else 0.0, 0.0) for row in range(3)]
        return self.drive((rows[0], rows[1], rows[2]), heading=0.0, tilt=0.0, strength=self.strength)

    def drive(self, allocation: Matrix, heading: float, tilt: float, strength: float) -> DriveCommand:
        """A field that stands on pivot A along `heading` (rad), tilted by `tilt` (rad), of `strength` (T)."""
        return DriveCommand(
            pivot=PIVOT_A,
            rate=0.0,
            heading_goal=heading,
            tilt=tilt,
            field=strength,
            allocation=allocation,
            time_to_live=self.settings.time_to_live,
        )
