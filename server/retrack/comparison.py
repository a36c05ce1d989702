"""Then and now in figures: estimates, tracking, and what a controller would have commanded."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from control.model import Pose, Tracking, wrap
from server.retrack.asked import Answer
from server.retrack.recorded_tick import RecordedTick
from server.settings import MM

OPEN_LOOP = "asked at each tick in the situation that the run was in then; it was not obeyed"


class Spread:
    """Mean, root mean square and largest of magnitudes, and when that was."""

    def __init__(self) -> None:
        self.count = 0
        self._sum = self._squares = 0.0
        self._largest, self._at = 0.0, 0.0

    def add(self, value: float, time: float) -> None:
        self.count += 1
        self._sum += value
        self._squares += value * value
        if value > self._largest:
            self._largest, self._at = value, time

    @property
    def mean(self) -> float | None:
        return self._sum / self.count if self.count else None

    @property
    def rms(self) -> float | None:
        return math.sqrt(self._squares / self.count) if self.count else None

    def to_json(self) -> dict[str, float | None]:
        largest, at = (self._largest, self._at) if self.count else (None, None)
        return {"mean": self.mean, "rms": self.rms, "max": largest, "at_s": at}


class Eyes:
    """How well the robot was seen in the pictures that both have looked at."""

    def __init__(self) -> None:
        self._pictures = self._locked = self._refused = self.times_lost = 0
        self._was_lost = False

    def picture(self, tracking: str, *, sighted: bool) -> None:
        """sighted: something like the robot was there, which the filter may have refused."""
        is_locked, is_lost = tracking == Tracking.LOCKED, tracking == Tracking.LOST
        self._pictures += 1
        self._locked += is_locked
        self._refused += sighted and not is_locked
        self.times_lost += is_lost and not self._was_lost
        self._was_lost = is_lost

    def to_json(self) -> dict[str, float | int | None]:
        share = self._locked / self._pictures if self._pictures else None
        return {
            "locked_share": share,
            "times_lost": self.times_lost,
            "sightings_refused": self._refused,
        }


class Commands:
    """The other controller beside what the rig was told, where no limit of the coils held that back."""

    def __init__(self) -> None:
        self._asked = self._anew = self._same_pivot = self._same_rate = 0
        self._rate = Spread()

    def add(self, tick: RecordedTick, answer: Answer) -> None:
        if answer.now is None or tick.limited_by:
            return
        self._asked += 1
        self._anew += answer.then.is_of(tick)
        self._same_pivot += answer.now.pivot == tick.command.pivot
        self._same_rate += answer.now.has_rate_of(tick)
        self._rate.add(math.degrees(abs(answer.now.rate - tick.command.rate)), tick.since_start)

    def to_json(self) -> dict[str, Any] | None:
        if not self._asked:
            return None
        return {
            "ticks": self._asked,
            "same_pivot_share": self._same_pivot / self._asked,
            "same_rate_share": self._same_rate / self._asked,
            "rate_deg_s": self._rate.to_json(),
            "walked_again_share": self._anew / self._asked,
            "note": OPEN_LOOP,
        }


@dataclass(frozen=True, slots=True)
class Seen:
    """One tick twice. pose, tracking: the second time.  looked: at a picture; sighted: the robot was in it."""

    tick: RecordedTick
    pose: Pose | None
    tracking: Tracking
    looked: bool
    sighted: bool
    answer: Answer | None

    @property
    def distance(self) -> float | None:
        """Between the two estimates, m."""
        then = self.tick.pose
        if self.pose is None or then is None:
            return None
        return self.pose.distance_to(then.x, then.y)

    @property
    def turn(self) -> float | None:
        """From the recorded heading to the second one, rad."""
        then = self.tick.pose
        return None if self.pose is None or then is None else wrap(self.pose.heading - then.heading)

    @property
    def error(self) -> float | None:
        """From the second estimate to the reference, m."""
        reference = self.tick.reference
        return None if self.pose is None or reference is None else self.pose.distance_to(*reference)

    @property
    def error_then(self) -> float | None:
        then, reference = self.tick.pose, self.tick.reference
        return None if then is None or reference is None else then.distance_to(*reference)


class Comparison:
    """Add every tick since the first picture."""

    def __init__(self) -> None:
        self._ticks = self._pictures = self._known = self._known_then = 0
        self._position, self._heading = Spread(), Spread()
        self._error, self._error_then = Spread(), Spread()
        self._eyes, self._eyes_then = Eyes(), Eyes()
        self._commands = Commands()

    @property
    def pictures(self) -> int:
        return self._pictures

    def add(self, seen: Seen) -> None:
        tick = seen.tick
        self._ticks += 1
        _put(self._position, seen.distance, 1.0 / MM, tick.since_start)
        _put(self._heading, seen.turn, 180.0 / math.pi, tick.since_start)
        if seen.error is not None and seen.error_then is not None:
            self._error.add(seen.error / MM, tick.since_start)
            self._error_then.add(seen.error_then / MM, tick.since_start)
        self._known += seen.pose is not None
        self._known_then += tick.pose is not None
        if seen.looked:
            self._pictures += 1
            self._eyes.picture(seen.tracking, sighted=seen.sighted)
            was_sighted = tick.seen_at is not None and tick.seen_at == tick.captured_at
            self._eyes_then.picture(tick.tracking, sighted=was_sighted)
        if seen.answer is not None:
            self._commands.add(tick, seen.answer)

    def to_json(self) -> dict[str, Any]:
        """Lab units in the names; shares 0 to 1. The errors are of the ticks at which both know the robot."""
        now, then = self._eyes.to_json(), self._eyes_then.to_json()
        return {
            "ticks": self._ticks,
            "pictures": self._pictures,
            "position_mm": self._position.to_json(),
            "heading_deg": self._heading.to_json(),
            "known_share": {"then": self._share(self._known_then), "now": self._share(self._known)},
            "mean_error_mm": {"then": self._error_then.mean, "now": self._error.mean},
            **{name: {"then": then[name], "now": now[name]} for name in now},
            "command": self._commands.to_json(),
        }

    def _share(self, count: int) -> float | None:
        return count / self._ticks if self._ticks else None


def _put(spread: Spread, value: float | None, factor: float, time: float) -> None:
    if value is not None:
        spread.add(abs(value) * factor, time)
