"""Which blob of a picture is the robot, by its place, its looks and who else is there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from vision.tracking.colour import Image
from vision.tracking.detection import Blob, Candidate, Window
from vision.tracking.identity import MOST, Owner, Question, Verdict
from vision.tracking.memory import LOOKS_GATE, Company, Looks, Memory
from vision.tracking.seeking import Seeker
from vision.tracking.windows import Place, touches

POINTED = 0.75
"""Somebody who points at a robot does not miss its middle by more, body lengths."""
VAGUE = 0.2
"""Standard deviation of such a point about the middle, body lengths."""
SAME = 0.35
"""Two places nearer to each other than that are one blob, seen roughly and seen precisely; body lengths: two robots
side by side are 0.4 apart."""


@dataclass(frozen=True, slots=True)
class View:
    """One picture. at: capture time, s.  window: the part that is looked at, px."""

    image: Image
    at: float
    window: Window


@dataclass(frozen=True, slots=True)
class Robot:
    """What the robot should be like. owner: its place.  looks: None when they are not known."""

    owner: Owner
    looks: Looks | None


@dataclass(frozen=True, slots=True)
class Found:
    """What a view holds.

    robot: the robot's blob, if it is told.  others: places of all other blobs that are wholly in view, px.
    doubtful: places of those among which it is not told.
    is_covered: where it should be is something of its colour that does not look like it; or that is the only one.
    """

    robot: Blob | None
    others: tuple[Place, ...]
    doubtful: tuple[Place, ...] = ()
    is_covered: bool = False


class Recogniser:
    """Keeps track of who else is there, too. length: of the body, px.  span: a typical distance in the picture, px."""

    def __init__(self, seeker: Seeker, company: Company, length: float, span: float) -> None:
        self._seeker = seeker
        self._company = company
        self._length = length
        self._span = span

    def look(self, view: View, robot: Robot) -> Found:
        """The robot within a window."""
        rivals = self._company.owners(view.at)
        seen = self._seeker.glance(view.image, view.window)
        if seen is not None and _is_surely(seen, robot, rivals):
            return Found(robot=seen, others=())
        candidates = self._seeker.within(view.image, view.window)
        near = _nearest(candidates, robot.owner, rivals)
        blobs = [self._seeker.measured(view.image, view.window, candidate) for candidate in near]
        verdict = self._verdict(robot, rivals, near, blobs)
        whole = [each for each in candidates if not touches(each.box, view.window)]
        return _found(verdict, near, blobs, whole, robot)

    def search(self, view: View, robot: Robot) -> Found:
        """The robot anywhere in the picture.

        A blob that covers the robot's place without being the robot may be the robot and another one together: it
        says nothing about where that one is.
        """
        candidates = self._seeker.everywhere(view.image)
        rivals = self._company.owners(view.at)
        nearest = _nearest(candidates, robot.owner, rivals)
        near, blobs = self._closely(view, nearest, robot.owner)
        verdict = self._verdict(robot, rivals, near, blobs)
        found = _found(verdict, near, blobs, [*near, *_without(candidates, nearest)], robot)
        pairs = {rival: near[number] for rival, number in verdict.rivals.items()}
        if found.is_covered:
            pairs = {rival: each for rival, each in pairs.items() if not _holds(each.box, robot.owner.place)}
        self._company.recognise({rival: each.centre for rival, each in pairs.items()}, view.at)
        return found

    def watch(self, view: View, found: Found) -> None:
        """The whole picture, for who else is there while the robot is known."""
        robot = found.robot
        places = [candidate.centre for candidate in self._seeker.everywhere(view.image)]
        if robot is not None:
            places = [place for place in places if math.dist(place, robot.centre) > SAME * self._length]
        self._company.meet(places, view.at, everywhere=True)

    def pointed_out(self, view: View, told: Place) -> Memory:
        """Where somebody says that the robot is; all other blobs are others.

        The middle of the blob there, if it has the robot's shape; two that touch are one blob, whose middle is
        neither's, and then the point itself is all that is known.
        """
        candidates = self._seeker.everywhere(view.image)
        there = Owner(told, POINTED * self._length, in_view=True)
        near, blobs = self._closely(view, _nearest(candidates, there, ()), there)
        places = [
            each.centre if blob is None else blob.centre for each, blob in zip(near, blobs, strict=True)
        ]
        places += [each.centre for each in candidates if not there.reaches(each.centre)]
        meant = min(
            (blob for blob in blobs if blob is not None),
            key=lambda blob: math.dist(blob.centre, told),
            default=None,
        )
        if meant is not None and math.dist(meant.centre, told) <= POINTED * self._length:
            pointed, apart = Memory(meant.centre, view.at), SAME
        else:
            pointed, apart = Memory(told, view.at, vagueness=VAGUE * self._length), POINTED
        others = [place for place in places if math.dist(place, pointed.place) > apart * self._length]
        self._company.meet(others, view.at, everywhere=True)
        return pointed

    def _closely(
        self, view: View, near: Sequence[Candidate], owner: Owner
    ) -> tuple[list[Candidate], list[Blob | None]]:
        """Blobs of the coarse grid, those within reach of an owner looked at closely."""
        looked: dict[Window, tuple[Candidate, Blob | None]] = {}
        for each in near:
            parts = self._seeker.beneath(view.image, each) if owner.reaches(each.centre) else []
            looked |= {part.box: (part, blob) for part, blob in parts or [(each, None)]}
        kept = list(looked.values())[:MOST]
        return [part for part, _ in kept], [blob for _, blob in kept]

    def _verdict(
        self, robot: Robot, rivals: Sequence[Owner], near: Sequence[Candidate], blobs: Sequence[Blob | None]
    ) -> Verdict:
        places = [candidate.centre for candidate in near]
        if len(places) == 1 and not any(rival.reaches(places[0]) for rival in rivals):
            return Verdict(0 if robot.owner.reaches(places[0]) else None, (), {})
        unlike = [_unlike(blob, robot.looks) for blob in blobs]
        return Question(robot.owner, rivals, places, unlike, self._span).answer()


def _nearest(candidates: Sequence[Candidate], robot: Owner, rivals: Sequence[Owner]) -> list[Candidate]:
    """Those that are reckoned with: first what no rival in view explains, then by distance from the robot's place."""

    def order(candidate: Candidate) -> tuple[bool, float]:
        place = candidate.centre
        is_known = math.isinf(robot.sigma) and any(each.in_view and each.reaches(place) for each in rivals)
        return is_known, robot.offset(place)

    return list(candidates) if len(candidates) <= 1 else sorted(candidates, key=order)[:MOST]


def _without(candidates: Sequence[Candidate], some: Sequence[Candidate]) -> list[Candidate]:
    return [each for each in candidates if not any(each is one for one in some)]


def _is_surely(blob: Blob, robot: Robot, rivals: Sequence[Owner]) -> bool:
    """Whether a blob that is alone in its window is the robot and nobody else."""
    if not robot.owner.reaches(blob.centre) or any(rival.reaches(blob.centre) for rival in rivals):
        return False
    return _unlike(blob, robot.looks) < LOOKS_GATE


def _unlike(blob: Blob | None, looks: Looks | None) -> float:
    """What speaks against a blob's being the robot by its looks.

    No more than the gate: a robot that something covers or touches looks like nothing that is known.
    """
    if blob is None:
        return LOOKS_GATE
    return 0.0 if looks is None else min(looks.unlike(Looks.of(blob)), LOOKS_GATE)


def _found(
    verdict: Verdict,
    near: Sequence[Candidate],
    blobs: Sequence[Blob | None],
    candidates: Sequence[Candidate],
    robot: Robot,
) -> Found:
    """Only a robot that looks like itself is measured."""
    chosen = None if verdict.robot is None else near[verdict.robot]
    seen = None if verdict.robot is None else blobs[verdict.robot]
    blob = seen if _unlike(seen, robot.looks) < LOOKS_GATE else None
    is_bounded, place = math.isfinite(robot.owner.sigma), robot.owner.place
    return Found(
        robot=blob,
        others=tuple(candidate.centre for candidate in candidates if candidate is not chosen),
        doubtful=tuple(near[number].centre for number in verdict.doubtful),
        is_covered=blob is None
        and (
            seen is not None
            or (is_bounded and (chosen is not None or any(_holds(each.box, place) for each in near)))
        ),
    )


def _holds(box: Window, place: Place) -> bool:
    return box[0] <= place[0] <= box[2] and box[1] <= place[1] <= box[3]
