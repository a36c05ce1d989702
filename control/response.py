"""Whether the robot turns with the field or against it; pure.

A coil with swapped leads, exchanged coils or a mirrored picture make a closed loop drive the robot away from
where it should go. The field pulls the body, so apart from noise the body never turns against a field that
turns, nor away from one that points elsewhere: if it does, what is believed of the field is wrong.
"""

from __future__ import annotations

import math

from control.model import wrap

FAR = math.radians(20.0)
"""A lead larger than this pulls the body whatever the field does, rad. A smaller one may be the play, a robot
that sticks, or a camera that is not yet registered with the coils."""
STILL = math.radians(0.05)
"""A field that turned less than this from sighting to sighting stands still, rad: 3 degrees a second at 60 Hz."""
AWAY = math.radians(4.0)
"""So far the body may turn against the field, rad: eight times the noise of a difference of two sightings."""
MOST_COUNTED = AWAY / 2.0
"""Of one turn no more is counted than this, rad: three sightings must show it, a push or a false one does not."""
JUMP = math.radians(45.0)
"""A larger turn between two sightings is another sighting, not a motion, rad: the field turns the robot by up
to 6 degrees from frame to frame, and a released one snaps round by up to 30."""


class ResponseWatch:
    """Fed with every sighting while the coils are energised; `forget` at each arm edge."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        self._field = self._body = math.nan
        self._pull = 0.0
        self._against = 0.0

    @property
    def turned_away(self) -> float:
        """How far the body has turned against the field since that began to turn this way, rad."""
        return self._against

    def see(self, field: float, body: float) -> None:
        """A sighting: heading of the field and of the body at its capture time, rad."""
        if not (math.isfinite(field) and math.isfinite(body)):
            return
        turned, self._body = wrap(body - self._body), body
        moved, self._field = wrap(field - self._field), field
        lead = wrap(field - body)
        pull = lead if abs(lead) > FAR else moved
        if abs(pull) > STILL and abs(turned) <= JUMP:
            self._count(turned, math.copysign(1.0, pull))

    def _count(self, turned: float, pull: float) -> None:
        """pull: 1 or -1, which way the field draws the body."""
        if pull != self._pull:
            self._pull, self._against = pull, 0.0
        self._against = max(0.0, self._against + min(-pull * turned, MOST_COUNTED))
