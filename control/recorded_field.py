"""The field of a run that is over, followed tick by tick through what was recorded of it."""

from __future__ import annotations

import math

from control.field import Field, FieldTrace
from control.model import Pivot


class RecordedField(Field):
    """Answers as the rig's own mirror of the field did at each tick of the run."""

    def follow(self, time: float, trace: FieldTrace) -> None:
        """Move on to the tick at `time` (s)."""
        if trace.anew:
            self._corners.clear()
        self._corners.extend(trace.corners)
        self._time, self._on = time, trace.is_on
        self._heading, self._elevation = trace.heading, trace.elevation
        self._full_at = trace.full_at
        self._strength = trace.strength + self._missing(time)

    def aim(self, pivot: Pivot, tilt: float, goal: float) -> None:
        """What the field had been told when it was at the tick before. tilt, goal (of its heading): rad."""
        self._target_elevation = -pivot * tilt
        self._goal = goal

    def _missing(self, time: float) -> float:
        """What the field, which comes up at its steady pace, has not got at `time` (s) of its full strength, T."""
        left = self._full_at - time
        return max(0.0, left) * self._field_slew if self._on and math.isfinite(left) else 0.0
