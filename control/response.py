"""Whether the robot turns with the field or against it; pure.

A coil with swapped leads, exchanged coils or a mirrored picture make a closed loop drive the robot away from
where it should go. The field pulls the body, so the body never turns away from where the field is believed to
point, apart from noise: if it does, what is believed is wrong.
"""

from __future__ import annotations

import math

from control.model import wrap

ALIGNED = math.radians(3.0)
"""With a lead no larger than this the body lies along the field, and nothing is counted, rad: eight times the
noise of one sighting."""
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
        self._body = math.nan
        self._against = 0.0

    @property
    def turned_away(self) -> float:
        """How far the body has turned against the field since the two last agreed, rad."""
        return self._against

    def see(self, field: float, body: float) -> None:
        """A sighting: heading of the field and of the body at its capture time, rad."""
        if not (math.isfinite(field) and math.isfinite(body)):
            return
        turned, self._body = wrap(body - self._body), body
        lead = wrap(field - body)
        if abs(lead) <= ALIGNED:
            self._against = 0.0
        elif abs(turned) <= JUMP:
            against = -math.copysign(turned, turned * lead)
            self._against = max(0.0, self._against + min(against, MOST_COUNTED))
