"""How far the body lags behind the field: identified on line, one figure per direction of turning."""

from __future__ import annotations

import math

LARGEST = math.radians(12.0)
"""No gait at a usable tilt has more backlash than this (physics.md: 11.5 degrees at a tilt of 10)."""
ENGAGED_AFTER = math.radians(4.0)
"""The field has taken up the play once it has turned this far one way (physics.md: 3.4 degrees at 20)."""
FORGETTING = 0.04
"""Weight of one new sighting once 25 have been averaged."""


class Backlash:
    """Running estimates of (field heading - body heading) while the field pulls the body one way."""

    def __init__(self, half_width: float = 0.0) -> None:
        """half_width: the first guess, rad."""
        self._lag = {1: half_width, -1: -half_width}
        self._seen = {1: 0, -1: 0}

    def observe(self, direction: int, lag: float) -> None:
        """The field pulls towards `direction` (+1, -1) and leads the measured body by `lag`, rad."""
        if not abs(lag) <= LARGEST:
            return
        self._seen[direction] += 1
        self._lag[direction] = lag_after(self._lag[direction], self._seen[direction], lag)

    def lead(self, direction: float) -> float:
        """How far beyond the body's goal the field has to go, rad, signed."""
        return self._lag[1 if direction > 0 else -1]

    @property
    def half_width(self) -> float:
        """Half of the play between the two directions, rad."""
        return max(0.0, 0.5 * (self._lag[1] - self._lag[-1]))


def lag_after(known: float, seen: int, lag: float) -> float:
    """The mean lag (rad) with one more sighting of `lag`; seen: how many there are now."""
    return known + max(FORGETTING, 1.0 / (seen + 1)) * (lag - known)


def pull_after(pull: float, angle: float) -> float:
    """How far the field has turned since it last reversed, rad, signed, once it has turned by `angle` more."""
    return angle if angle * pull < 0.0 else pull + angle
