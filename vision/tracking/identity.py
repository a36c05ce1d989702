"""Which of several blobs is the one that is followed: the likeliest way to tell them all apart, or no answer.

Everything that was seen before is an owner: the robot that is followed, and its rivals. Each is expected at a
place with a standard deviation that grows while it is not seen. A way to tell the blobs apart gives each blob to
one owner or to nobody; its cost is -2 ln of its likelihood, so a difference of 13.8 is odds of 1000 to 1. What
is not told apart with these odds is not told apart. Places and standard deviations are in px.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

from vision.tracking.windows import Place

GATE = 13.8
"""99.9 % point of chi-squared with two degrees of freedom: an owner is not further from its place than that."""
ODDS = 13.8
"""2 ln 1000: the likeliest way counts when every other one is 1000 times less likely."""
SUDDEN = 13.8
"""Cost of an owner that was in view at the last look and is gone now, and of a blob that nobody owns."""
MOST = 5
"""No more blobs, and no more rivals, are reckoned with; the ones next to the robot's place."""


@dataclass(frozen=True, slots=True)
class Owner:
    """Who a blob may be. place: expected.  sigma: standard deviation of each coordinate; inf: anywhere.

    in_view: it was seen at the last look.
    """

    place: Place
    sigma: float
    in_view: bool

    def offset(self, place: Place) -> float:
        """Squared distance from the expected place in standard deviations; 0 for one who may be anywhere."""
        return ((place[0] - self.place[0]) ** 2 + (place[1] - self.place[1]) ** 2) / self.sigma**2

    def reaches(self, place: Place) -> bool:
        return self.offset(place) <= GATE


@dataclass(frozen=True, slots=True)
class Verdict:
    """robot: index of the robot's blob; None when it is none of them, or cannot be told.

    doubtful: indices of the blobs between which it cannot be told.  rivals: index of the rival -> of its blob.
    """

    robot: int | None
    doubtful: tuple[int, ...]
    rivals: dict[int, int]


Pairs = tuple[tuple[int, int], ...]
"""Numbers of a rival and of its blob."""


@dataclass(frozen=True, slots=True)
class _Way:
    """One way to tell all blobs apart, and what it costs."""

    cost: float
    pairs: Pairs


class Question:
    """One picture's blobs and those who may own them. span: of the picture, px.

    unlike: for each blob, what speaks against its being the robot by its looks (-2 ln likelihood).
    """

    def __init__(
        self,
        robot: Owner,
        rivals: Sequence[Owner],
        blobs: Sequence[Place],
        unlike: Sequence[float],
        span: float,
    ) -> None:
        self._robot, self._blobs, self._unlike = robot, blobs, unlike
        self._rivals = [_as_vague(rival, robot) for rival in rivals]
        self._span = span
        self._nobody = 4.0 * math.log(span) + SUDDEN

    def answer(self) -> Verdict:
        """The likeliest way, if every other one is 1000 times less likely."""
        ways = self._ways()
        if not ways:
            return Verdict(None, (), dict(self._rest(frozenset(), None)[1]))
        best = min(ways, key=lambda blob: ways[blob].cost)
        without = self._without_robot(best)
        likeliest = min(ways[best].cost, without.cost)
        near = [blob for blob, way in ways.items() if way.cost - likeliest < ODDS]
        if near == [best] and without.cost - likeliest >= ODDS:
            return Verdict(best, (), dict(ways[best].pairs))
        if not near:
            return Verdict(None, (), dict(without.pairs))
        sure = set(ways[near[0]].pairs).intersection(without.pairs, *(ways[blob].pairs for blob in near))
        return Verdict(None, tuple(near), dict(sure))

    def _ways(self) -> dict[int, _Way]:
        """For each blob that may be the robot, the cheapest way in which it is."""
        ways = {}
        for blob, place in enumerate(self._blobs):
            own = self._cost(self._robot, place) + self._unlike[blob]
            if math.isfinite(own):
                cost, pairs = self._rest(frozenset({blob}), None)
                ways[blob] = _Way(cost + own, pairs)
        return ways

    def _without_robot(self, owned: int) -> _Way:
        """The cheapest way in which the robot is not seen and a blob that looks like it is a rival."""
        cost, pairs = self._rest(frozenset(), owned)
        return _Way(cost + (SUDDEN if self._robot.in_view else 0.0), pairs)

    def _cost(self, owner: Owner, place: Place) -> float:
        if not math.isfinite(owner.sigma):
            return 4.0 * math.log(self._span)
        offset = owner.offset(place)
        return offset + 4.0 * math.log(owner.sigma) if offset <= GATE else math.inf

    def _rest(self, taken: frozenset[int], owned: int | None) -> tuple[float, Pairs]:
        """Cheapest way to give the other blobs to the rivals; the blob `owned` must go to one of them."""

        @cache
        def best(rival: int, free: frozenset[int]) -> tuple[float, Pairs]:
            if rival == len(self._rivals):
                return (math.inf if owned in free else self._nobody * len(free)), ()
            owner = self._rivals[rival]
            cost, pairs = best(rival + 1, free)
            cheapest = cost + (SUDDEN if owner.in_view else 0.0), pairs
            for blob in free:
                own = self._cost(owner, self._blobs[blob])
                if math.isfinite(own):
                    cost, pairs = best(rival + 1, free - {blob})
                    cheapest = min(cheapest, (cost + own, ((rival, blob), *pairs)))
            return cheapest

        return best(0, frozenset(range(len(self._blobs))) - taken)


def _as_vague(rival: Owner, robot: Owner) -> Owner:
    """Once the robot may be anywhere, so may be a rival that was out of sight as well: whoever of the two is seen
    then must not be told by how long ago the other was."""
    return rival if rival.in_view or math.isfinite(robot.sigma) else replace(rival, sigma=math.inf)
