"""Which points to try next, and which is best: expected improvement that knows of the runs' scatter.

The improvement is over the best that the model believes in, not over the luckiest run, and it counts the less
the more it is scatter that is left to see (augmented expected improvement, Huang et al. 2006). Points that are
tried together are chosen one after the other, as if each had given what is expected of it (Ginsbourger's
"kriging believer").
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import norm, qmc

from control.studies.tuning.error_model import ErrorModel
from control.studies.tuning.space import Floats, Point, Space

CANDIDATES = 10
"""2^10 points all over the cube are compared."""

AROUND, REACHES = 128, (0.1, 0.02)
"""So many more near the best, at each of these distances, in shares of an axis."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """Points to try, and what share of the best error the first one is expected to save, 0-1."""

    points: tuple[Point, ...]
    gain: float


def spread_points(space: Space, count: int, seed: int) -> tuple[Point, ...]:
    """Points all over the space, as even as they can be (Sobol, scrambled by the seed)."""
    return tuple(space.point(shares) for shares in _sobol(space, count, seed))


def propose(space: Space, model: ErrorModel, tried: Sequence[Point], count: int, seed: int) -> Proposal:
    """The next points to try together."""
    candidates = _candidates(space, model, tried, seed)
    places = space.places(candidates)
    points, gain = [], 0.0
    for number in range(count):
        gains = _improvement(model, places)
        chosen = int(np.argmax(gains))
        points.append(candidates[chosen])
        gain = gain if number else float(gains[chosen])
        model = model.expecting(places[chosen])
    return Proposal(tuple(points), gain)


def best_point(space: Space, model: ErrorModel, tried: Sequence[Point], seed: int) -> Point:
    """Where the model believes the error to be smallest."""
    candidates = _candidates(space, model, tried, seed)
    return candidates[int(np.argmin(model.believe(space.places(candidates)).mean))]


def _improvement(model: ErrorModel, places: Floats) -> Floats:
    """Augmented expected improvement, as a share of the error: of a log, near zero."""
    belief = model.believe(places)
    best, deviation = belief.mean.min(), np.maximum(belief.deviation, 1e-12)
    ahead = (best - belief.mean) / deviation
    expected = (best - belief.mean) * norm.cdf(ahead) + deviation * norm.pdf(ahead)
    return expected * (1 - model.scatter / np.hypot(model.scatter, deviation))


def _candidates(space: Space, model: ErrorModel, tried: Sequence[Point], seed: int) -> list[Point]:
    """Points tried, points everywhere, and points about the best of those; each once, in this order."""
    everywhere = [*tried, *(space.point(shares) for shares in _sobol(space, 2**CANDIDATES, seed))]
    best = everywhere[int(np.argmin(model.believe(space.places(everywhere)).mean))]
    near = [space.point(shares) for reach in REACHES for shares in _around(space, best, reach, seed)]
    return list(dict.fromkeys([*everywhere, *near]))


def _around(space: Space, point: Point, reach: float, seed: int) -> Floats:
    """Shares near a point's: a normal step on every axis."""
    rng = np.random.default_rng([seed, round(1 / reach)])
    shares = space.shares(point)
    return np.clip(shares + rng.normal(0.0, reach, (AROUND, len(shares))), 0.0, 1.0)


def _sobol(space: Space, count: int, seed: int) -> Floats:
    rows = qmc.Sobol(len(space.axes), rng=seed).random_base2(max(count - 1, 0).bit_length())
    return rows[:count]
