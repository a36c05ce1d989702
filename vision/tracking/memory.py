"""What is remembered of the robot and of the other blobs, and how that grows vague while they are not seen.

A robot without current cannot move by itself; the rig takes the current away 150 ms after it was last seen. Until
then it walks at up to its own length per second, and a hand that covers it may push it as fast. So a remembered place
holds for ELSEWHERE_AFTER with a standard deviation that grows with time; after that somebody may have carried the
robot anywhere. What never grows old: its heading (a robot at rest does not turn round), and who else is there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vision.tracking.detection import Blob
from vision.tracking.identity import MOST, Owner
from vision.tracking.windows import Place

STILL = 0.12
"""Standard deviation of a place that was seen just now, body lengths: a coarse search sees it to a grid point."""
WANDER = 0.25
"""It grows by so many body lengths per second; the gate is 3.7 of it, so nearly a length per second is covered
(half a length at 100 deg/s, the fastest swing, is 0.87 of it)."""
CARRIED = 0.5
"""The same of another robot, body lengths per second: somebody may be moving it while the robot is covered by it."""
ELSEWHERE_AFTER = 1.5
"""A robot that was not seen for so long may be anywhere, s: half as long again as a hand covers it in passing."""
FORGOTTEN_AFTER = 5.0
"""What it looks like is remembered for so long, s: a hand that goes uncovers it bit by bit, and a part of it is not
taken for the whole. After that it may be another robot, or other light."""

LOOKS_GATE = 18.5
"""99.9 % point of chi-squared with four degrees of freedom: length, width, area and colour."""
LENGTH_SPREAD = 0.02
"""Standard deviation of the logarithm of the length in the picture, by light, blur and tilt (from the scenes)."""
WIDTH_SPREAD = 0.04
"""The same of the width: a third of the length, so as many px are more of it."""
AREA_SPREAD = 0.05
"""The same of the area within the thresholds, which light and shadow change most."""
COLOUR_SPREAD = 0.04
"""Standard deviation of the shares of blue, green and red, by the colour of the light."""
TILT_DOUBT = 0.5
"""The expected foreshortening may be wrong by this share of itself: how far an end lifts is measured on no rig."""
LEARNING = 0.05
"""Share of a new sighting in the remembered looks: a third of a second at 60 Hz."""
STEADY = 0.15
"""Two sightings agree when they are not further apart than that, body lengths."""


def sigma_after(gap: float, length: float, wander: float = WANDER) -> float:
    """Standard deviation of a place `gap` seconds after it was seen, in the body length's unit; inf: anywhere."""
    return length * (STILL + wander * gap) if 0.0 <= gap <= ELSEWHERE_AFTER else math.inf


@dataclass(frozen=True, slots=True)
class Looks:
    """What a blob looks like: length, width (px), area (px^2), shares of blue, green and red (sum 1).

    slack: by which share length and area may be wrong because the tilt is not known well.
    """

    length: float
    width: float
    area: float
    shares: tuple[float, float, float]
    slack: float = 0.0

    @classmethod
    def of(cls, blob: Blob) -> Looks:
        blue, green, red = blob.mean_colour
        light = max(blue + green + red, 1.0)
        first, second, third, _ = blob.corners
        return cls(
            length=max(math.dist(second, third), 1.0),
            width=max(math.dist(first, second), 1.0),
            area=blob.area,
            shares=(blue / light, green / light, red / light),
        )

    def tilted(self, tilt: float) -> Looks:
        """What is seen from above of a body with these looks that stands on one end, tilt in rad."""
        if tilt == 0.0:
            return self
        short = math.cos(tilt)
        return Looks(
            self.length * short, self.width, self.area * short, self.shares, TILT_DOUBT * (1.0 - short)
        )

    def flat(self, tilt: float) -> Looks:
        """What a body that is seen tilted looks like when it lies flat."""
        if tilt == 0.0:
            return self
        short = math.cos(tilt)
        return Looks(self.length / short, self.width, self.area / short, self.shares, self.slack)

    def unlike(self, seen: Looks) -> float:
        """How many standard deviations lie between these, expected, and what is seen, squared."""
        doubt = self.slack**2
        return (
            math.log(self.length / seen.length) ** 2 / (LENGTH_SPREAD**2 + doubt)
            + (math.log(self.width / seen.width) / WIDTH_SPREAD) ** 2
            + math.log(self.area / seen.area) ** 2 / (AREA_SPREAD**2 + doubt)
            + math.dist(self.shares, seen.shares) ** 2 / COLOUR_SPREAD**2
        )

    def learnt(self, new: Looks) -> Looks:
        """The remembered looks after another sighting."""
        (blue, green, red), (new_blue, new_green, new_red) = self.shares, new.shares
        return Looks(
            self.length + LEARNING * (new.length - self.length),
            self.width + LEARNING * (new.width - self.width),
            self.area + LEARNING * (new.area - self.area),
            (
                blue + LEARNING * (new_blue - blue),
                green + LEARNING * (new_green - green),
                red + LEARNING * (new_red - red),
            ),
        )


@dataclass(frozen=True, slots=True)
class Memory:
    """The robot when it was last seen. place: px.  seen_at: s.  vagueness: how well the place was known then, px."""

    place: Place
    seen_at: float
    looks: Looks | None = None
    vagueness: float = 0.0

    def owner_at(self, time: float, length: float, *, in_view: bool) -> Owner:
        """Where it may be at a time, s. length: of the body, px."""
        sigma = math.hypot(sigma_after(time - self.seen_at, length), self.vagueness)
        return Owner(self.place, sigma, in_view)

    def looks_at(self, time: float) -> Looks | None:
        """What it must look like at a time, s; None when that is forgotten."""
        return self.looks if time - self.seen_at <= FORGOTTEN_AFTER else None


class Steadiness:
    """Counts sightings that agree with each other. length: of the body, px."""

    def __init__(self, length: float) -> None:
        self._apart = STEADY * length
        self._place: Place = (0.0, 0.0)
        self._count = 0

    def sees(self, place: Place) -> int:
        """How many sightings in a row agree, with this one."""
        agrees = math.dist(place, self._place) <= self._apart
        self._place, self._count = place, self._count + 1 if agrees else 1
        return self._count

    def broken(self) -> None:
        self._count = 0


@dataclass(frozen=True, slots=True)
class Rival:
    """Another blob of the robot's colour and size. place: px.  seen_at: s."""

    place: Place
    seen_at: float


class Company:
    """Who else is on the plate. length: of a body, px."""

    def __init__(self, length: float) -> None:
        self._length = length
        self._rivals: list[Rival] = []
        self._looked_at = -math.inf

    def clear(self) -> None:
        self._rivals, self._looked_at = [], -math.inf

    def unwatched_for(self, now: float) -> float:
        """Since the whole picture was last looked at, s."""
        gap = now - self._looked_at
        return gap if gap >= 0.0 else math.inf

    def places(self, now: float, within: float) -> tuple[Place, ...]:
        """Of those that were seen in the last `within` seconds, px."""
        return tuple(rival.place for rival in self._rivals if now - rival.seen_at <= within)

    def owners(self, now: float) -> list[Owner]:
        """What each of them may be taken for now, in the order of `recognise`."""
        return [
            Owner(
                rival.place,
                sigma_after(now - rival.seen_at, self._length, CARRIED),
                in_view=rival.seen_at >= self._looked_at,
            )
            for rival in self._rivals
        ]

    def recognise(self, pairs: Mapping[int, Place], now: float) -> None:
        """The whole picture was looked at: these of them (by number) were seen, at these places."""
        for number, place in pairs.items():
            self._rivals[number] = Rival(place, now)
        self._looked_at = now

    def meet(self, others: Sequence[Place], now: float, *, everywhere: bool) -> None:
        """All that was seen beside the robot, which is known for sure; everywhere: in the whole picture.

        Who has not been seen for long has left, or was taken away: the robot itself is here.
        """
        if everywhere:
            self._looked_at = now
        unseen = [
            rival
            for rival, owner in zip(self._rivals, self.owners(now), strict=True)
            if now - rival.seen_at <= ELSEWHERE_AFTER and not any(owner.reaches(place) for place in others)
        ]
        self._rivals = [*(Rival(place, now) for place in others), *unseen][: 2 * MOST]
