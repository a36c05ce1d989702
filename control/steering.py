"""What the field should do at this tick: by the walk that is on, by hand, or standing still; never outward."""

from __future__ import annotations

import math

from control.controllers.manual import HOLD, Jog, Manual
from control.model import Pose
from control.parts import Parts
from control.safety import Refused
from control.walk import Walk
from control.walker import Stride
from control.workspace_guard import WorkspaceGuard, arc_to_stop


class Steering:
    """Strides for the loop; keeps the jog that is on."""

    def __init__(self, parts: Parts, guard: WorkspaceGuard) -> None:
        self._parts = parts
        self._guard = guard
        self._manual = Manual()

    def take(self, jog: Jog, pose: Pose | None, now: float) -> None:
        """Swing by hand from `now` (s) on; raises `Refused` where that leads out of the workspace, which to stop
        never does."""
        if jog.rate != 0.0 and pose is not None and self._guard.leads_out(pose, jog.pivot, jog.rate * HOLD):
            raise Refused("this swing leads out of the workspace; swing the other way or about the other end")
        self._manual.take(jog, now)

    def forget(self) -> None:
        """The jog is over."""
        self._manual.forget()

    def stride(self, walk: Walk | None, now: float, gap: float, pose: Pose) -> Stride:
        """walk: the run that is walking, if any.  gap: since the last tick, s.  Raises what a walk raises."""
        if walk is None:
            return self._by_hand(now)
        return walk.step(now, gap, pose, self._parts.field, self._parts.perception.backlash.lead)

    def leads_out(self, stride: Stride, pose: Pose, now: float) -> bool:
        """Whether the robot, told to stop at the next tick, would by then have left where it may be.

        What is seen is as old as the camera is late, the next tick is a frame away, and a change of pivot goes
        on for its ramp.
        """
        frame = self._parts.perception.frame
        late = now - frame.captured_at if frame is not None else math.inf
        stopping_time = late + self._parts.actuation.tick + self._parts.field.ramp
        arc = arc_to_stop(stride.rate, stride.heading_goal - pose.heading, stopping_time)
        return self._guard.leads_out(pose, stride.pivot, arc)

    def standing(self) -> Stride:
        """No motion."""
        return Stride(self._parts.field.pivot, 0.0, self._parts.field.heading)

    def driven_by(self, walk: Walk | None, now: float) -> str:
        """Who decides: the walk's controller, "manual", or "" for nobody."""
        if walk is not None:
            return walk.request.selection.controller.name
        return self._manual.name if self._manual.decide(now) is not None else ""

    def _by_hand(self, now: float) -> Stride:
        """A fresh jog, or standing still."""
        field, jog = self._parts.field, self._manual.decide(now)
        if jog is None or jog.sweep is None or not field.is_ready:
            return self.standing()
        return Stride(jog.pivot, jog.rate, field.heading + math.copysign(jog.sweep, jog.rate))
