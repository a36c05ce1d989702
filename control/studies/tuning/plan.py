"""The plan of an auto-tune: points all over, then where improvement is expected, then the best one once more.

A plan is made in blocks. Each block is a function of the definition and of the rows before it, in the order of
their index; neither timing nor the number of workers has a say, and an interrupted tuning goes on where it was.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from control.studies.definition import StudyDefinition
from control.studies.plan import NOTHING, Done, PlannedRun, planned_run
from control.studies.tuning.space import Point
from control.studies.tuning.trials import Trial, trials
from control.studies.tuning.tuner import Tuner

PERCENT = 100.0


@dataclass(frozen=True, slots=True)
class Block:
    """Runs that are planned together.

    indices: of its runs.  confirms: these are the last ones, all at the best point.
    """

    indices: range
    confirms: bool


class TunePlan:
    """A `Plan` for design = "tune"."""

    def __init__(self, definition: StudyDefinition) -> None:
        self._definition, self._settings = definition, definition.tune
        self._tuner = Tuner(definition)

    @property
    def total(self) -> int:
        """Runs at most; fewer where `enough_percent` ends the search."""
        return self._settings.budget

    @property
    def axes(self) -> tuple[str, ...]:
        return tuple(axis.name for axis in self._tuner.space.axes)

    def next(self, done: Done) -> Sequence[int]:
        block = self.blocks(done)[-1]
        return [index for index in block.indices if index not in done]

    def run(self, index: int, done: Done = NOTHING) -> PlannedRun:
        """Raises `IndexError` for a run that cannot be known yet."""
        for block in self.blocks(done):
            if index in block.indices:
                return self._planned(index, block, done)
        raise IndexError(f"run {index} of the tuning is chosen when the runs before it are done")

    def blocks(self, done: Done) -> list[Block]:
        """Up to the first one that is not done."""
        blocks, tried = [self._block([])], list[Trial]()
        while not blocks[-1].confirms and all(index in done for index in blocks[-1].indices):
            tried += self._trials(blocks[-1].indices, done)
            blocks.append(self._block(tried))
        return blocks

    def _block(self, tried: Sequence[Trial]) -> Block:
        """tried: all runs before it."""
        settings, start = self._settings, len(tried)
        left = settings.budget - settings.confirm - start
        if left <= 0 or self._is_enough(tried):
            return Block(range(start, start + settings.confirm), confirms=True)
        points = settings.at_once if start else settings.first
        return Block(range(start, start + min(points * self._definition.repeats, left)), confirms=False)

    def _is_enough(self, tried: Sequence[Trial]) -> bool:
        """Whether so little improvement is expected that the search ends before its budget."""
        enough = self._settings.enough_percent / PERCENT
        return len(tried) > 0 and enough > 0 and self._tuner.proposal(tried).gain < enough

    def _planned(self, index: int, block: Block, done: Done) -> PlannedRun:
        if index in done:
            row = done[index]
            return planned_run(self._definition, index, row.set, row.repeat, dict(row.values))
        before, ahead = self._trials(range(block.indices.start), done), index - block.indices.start
        points = self._points(block, before)[: ahead + 1]
        set_, repeat = _numbered(before, points)
        return planned_run(self._definition, index, set_, repeat, self._tuner.space.values(points[-1]))

    def _points(self, block: Block, before: Sequence[Trial]) -> list[Point]:
        """One a run. Every point has its turn before the first is repeated, so that drift is shared evenly."""
        runs = len(block.indices)
        if block.confirms:
            return [self._tuner.best(before)] * runs
        points = self._tuner.proposal(before).points
        return [points[number % len(points)] for number in range(runs)]

    def _trials(self, indices: range, done: Done) -> list[Trial]:
        return trials([done[index] for index in indices], self._settings.minimise)


def _numbered(before: Sequence[Trial], points: Sequence[Point]) -> tuple[int, int]:
    """Set and repeat of the last of these points: a point that was tried before keeps its set."""
    sets = {trial.point: trial.set for trial in before}
    for point in points:
        sets.setdefault(point, len(sets))
    last = points[-1]
    return sets[last], sum(trial.point == last for trial in before) + points[:-1].count(last)
