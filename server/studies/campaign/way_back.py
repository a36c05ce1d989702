"""Back to where a run begins: the robot walks there by itself, and is not recorded."""

from __future__ import annotations

import math
from dataclasses import replace

from control.gait import Gait
from control.model import Pose
from control.runs import Choice, RunRequest, Selection
from control.safety import Limits, Refused
from server.studies.campaign.attendant import Attendant, Interrupted
from server.studies.campaign.operator import Operator
from server.studies.campaign.rules import AIM, MM, Rules, off

TRIES = 5
"""Walks back before it is given up; one is enough where the robot walks as it should."""
WITHIN = 180.0
"""A walk back takes no longer, s: three times right across a workspace of 120 mm at 3 mm/s."""
STANDING = 1e-3
"""Path step of the reference meanwhile, s in 0.1 s: it waits at the start."""
ENOUGH_PASSES = 1000.0
"""The path, at which the walk back does not look, must not end it."""
ID = "way-back"


class WayBack:
    def __init__(self, operator: Operator, attendant: Attendant, rules: Rules) -> None:
        self._operator = operator
        self._attendant = attendant
        self._rules = rules

    def bring(self, start: Pose, selection: Selection) -> None:
        """Until the robot rests at `start` on an armed rig; raises `Interrupted` where it does not come there.

        selection: of the run that begins there.
        """
        gait = self._gait(selection.gait)
        for _ in range(TRIES):
            snapshot = self._attendant.until_fit(gait)
            if not self._rules.is_at(snapshot.pose, start):
                self._walk(start, replace(selection, gait=gait))
                snapshot = self._attendant.until_fit(gait)
            try:
                snapshot = self._attendant.rest(self._rules.rest)
            except Interrupted:
                continue
            if self._rules.is_at(snapshot.pose, start):
                return
        raise Interrupted(self._missed(self._operator.tick().pose, start))

    def _walk(self, start: Pose, selection: Selection) -> None:
        """One way; where it ends early, the next one begins there."""
        self._attendant.say("walking back to the start")
        aim = Choice("to_pose", self._aim(start))
        request = RunRequest(
            replace(selection, controller=aim), ENOUGH_PASSES, duration=WITHIN, unattended=True
        )
        try:
            self._attendant.do(lambda loop: loop.start(ID, request))
            self._attendant.follow()
        except (Refused, Interrupted) as obstacle:
            self._attendant.say(f"the way back was interrupted: {obstacle}")

    def _aim(self, start: Pose) -> dict[str, float]:
        return {
            "x_mm": start.x / MM,
            "y_mm": start.y / MM,
            "heading_deg": math.degrees(math.remainder(start.heading, math.tau)),
            "within_mm": max(0.1, AIM * self._rules.within / MM),
            "within_deg": max(0.5, AIM * math.degrees(self._rules.within_heading)),
        }

    def _gait(self, gait: Gait) -> Gait:
        """The usual gait at the run's field: its own tilt may be one at which the robot hardly walks."""
        limits: Limits = self._operator.do(lambda loop: loop.parts.limits)
        usual = Gait(field=gait.field, path_step=STANDING)
        return replace(usual, max_rate=min(usual.max_rate, limits.rate))

    def _missed(self, pose: Pose | None, start: Pose) -> str:
        allowed = f"{self._rules.within / MM:g} mm and {math.degrees(self._rules.within_heading):g}°"
        if pose is None:
            return f"the robot did not come back to its start: it is not seen; {allowed} are allowed"
        place, turn = off(pose, start)
        return (
            f"the robot did not come back to its start: after {TRIES} tries it is {place / MM:.1f} mm and "
            f"{math.degrees(turn):.0f}° off; {allowed} are allowed"
        )
