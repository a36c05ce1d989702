"""How surely a term's share of the variance is known: the interval of Fisher's F with an effect behind it.

Steiger and Fouladi, Noncentrality interval estimation, 1997; the noncentral F by Patnaik's (1949) two moments, which
is good to the digits that are shown and holds for effects of any size.
"""

from __future__ import annotations

from scipy import optimize, special

from control.studies.analysis.intervals import LEVEL, Interval

ROUNDING = 1e-12
"""Share of all variance below which a sum of squares is rounding."""


def share(gained: float, left: float, total: float, freedoms: tuple[int, int]) -> Interval:
    """gained, left, total: sums of squares of a term, of the runs around the model, and of everything.

    freedoms: of the term and of what is left. Runs that do not scatter at all leave nothing unsure; without repeats
    there is no interval.
    """
    value = gained / total
    term, rest = freedoms
    if rest < 1:
        return Interval(value)
    if left <= ROUNDING * total:
        return Interval(value, value, value)
    noise = left / rest
    beside = (total - gained) / noise
    low, high = (
        effect / (effect + beside)
        for effect in (_effect(gained / term / noise, freedoms, 0.5 + side * LEVEL) for side in (0.5, -0.5))
    )
    return Interval(value, min(low, value), max(high, value))


def chance(gained: float, left: float, total: float, freedoms: tuple[int, int]) -> float:
    """p: chance of as much without any effect; NaN without repeats."""
    term, rest = freedoms
    if rest < 1:
        return float("nan")
    if left <= ROUNDING * total:
        return 0.0 if gained > ROUNDING * total else 1.0
    return float(special.fdtrc(term, rest, gained / term / (left / rest)))


def _effect(ratio: float, freedoms: tuple[int, int], chance_below: float) -> float:
    """The noncentrality with which F lies below the ratio with that chance; 0 where even no effect makes it rarer."""
    term, rest = freedoms

    def excess(effect: float) -> float:
        wide = (term + effect) ** 2 / (term + 2.0 * effect)
        return float(special.fdtr(wide, rest, ratio / (1.0 + effect / term))) - chance_below

    if excess(0.0) <= 0.0:
        return 0.0
    top = term * (ratio + 1.0)
    while excess(top) > 0.0:
        top *= 2.0
    return float(optimize.brentq(excess, 0.0, top))  # pyright: ignore[reportArgumentType]
