"""What the runs so far say: the model, the next points, the best one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from control.studies.definition import StudyDefinition
from control.studies.tuning.error_model import ErrorModel
from control.studies.tuning.proposing import Proposal, best_point, propose, spread_points
from control.studies.tuning.space import Point, space_of
from control.studies.tuning.trials import Trial, errors

CERTAIN = 1.0
"""Share of the error that may be saved as long as nothing is known."""


class Tuner:
    """Functions of the trials given, whatever was asked before; the last answers are only kept to be quick."""

    def __init__(self, definition: StudyDefinition) -> None:
        self.space = space_of(definition)
        self._settings, self._seed = definition.tune, definition.seed
        self._proposals: dict[tuple[Trial, ...], Proposal] = {}
        self._best: tuple[tuple[Trial, ...], Point] | None = None
        self._model: tuple[tuple[Trial, ...], ErrorModel] | None = None

    def proposal(self, tried: Sequence[Trial]) -> Proposal:
        """The next points to try together."""
        tried = tuple(tried)
        if tried not in self._proposals:
            self._proposals[tried] = self._proposal(tried)
        return self._proposals[tried]

    def best(self, tried: Sequence[Trial]) -> Point:
        """Where the model believes the error to be smallest; the first point as long as no run has finished."""
        tried = tuple(tried)
        if self._best is None or self._best[0] != tried:
            self._best = tried, self._best_of(tried)
        return self._best[1]

    def _best_of(self, tried: Sequence[Trial]) -> Point:
        model = self.model(tried)
        if model is None:
            return spread_points(self.space, 1, self._seed)[0]
        return best_point(self.space, model, [trial.point for trial in tried], self._seed_after(tried))

    def model(self, tried: Sequence[Trial]) -> ErrorModel | None:
        """None as long as no run has finished."""
        if all(trial.error is None for trial in tried):
            return None
        tried = tuple(tried)
        if self._model is None or self._model[0] != tried:
            places = self.space.places([trial.point for trial in tried])
            self._model = tried, ErrorModel(places, errors(tried))
        return self._model[1]

    def _proposal(self, tried: Sequence[Trial]) -> Proposal:
        """Without any run that finished the search goes on evenly, behind the points it had."""
        settings, points = self._settings, [trial.point for trial in tried]
        model = self.model(tried)
        if model is None:
            had = len(set(points))
            count = settings.at_once if had else settings.first
            return Proposal(spread_points(self.space, had + count, self._seed)[had:], CERTAIN)
        return propose(self.space, model, points, settings.at_once, self._seed_after(tried))

    def _seed_after(self, tried: Sequence[Trial]) -> int:
        """Other candidates each time, the same for the same runs."""
        return int(np.random.SeedSequence([self._seed, len(tried)]).generate_state(1)[0])
