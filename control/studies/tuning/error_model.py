"""What runs tell about the error everywhere: a Gaussian process over the tuned axes, with the runs' own scatter.

scikit-learn's process (Rasmussen and Williams 2006, algorithm 2.1) over log(error), since errors are positive
and scatter in proportion. Its lengths, its strength and the scatter of single runs are the most probable ones
under weak priors (maximum a posteriori): a dozen runs cannot tell a length from a scatter by their likelihood
alone. Nothing is drawn at random here, and linear algebra keeps to one thread, so the same runs always give
the same model.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel
from threadpoolctl import threadpool_limits

from control.studies.tuning.space import Floats

SMOOTHNESS = 2.5
"""Of the Matérn kernel: twice differentiable, the usual assumption for a response that is smooth, not analytic."""

LENGTH, LENGTH_SPREAD = 0.5, 0.8
"""Prior of a length scale: half of an axis, times or over e^0.8."""

STRENGTH, STRENGTH_SPREAD = 1.0, 1.0
"""Prior of the variance of what is to be learned, in standardised errors."""

SCATTER, SCATTER_SPREAD = 0.1, 1.5
"""Prior of a single run's variance, in standardised errors: wide, since this is what differs between robots."""

LENGTH_BOUNDS = (0.03, 30.0)
STRENGTH_BOUNDS = (1e-3, 1e3)
SCATTER_BOUNDS = (1e-6, 10.0)
"""Where the search ends: far out in the priors, so that no answer lies on a bound."""

BEGINNINGS = (0.2, 0.6, 2.0)
"""Length scales from which the search starts, in shares of an axis; the best result counts."""


@dataclass(frozen=True, slots=True)
class Belief:
    """What is believed of the true error at some places, (places,) each, in log units.

    deviation: of the belief itself, without a single run's scatter.
    """

    mean: Floats
    deviation: Floats


class ErrorModel:
    """A process fitted to runs."""

    def __init__(self, places: Floats, errors: Floats) -> None:
        """places: (runs, coordinates) of the unit cube; errors: (runs,), above zero."""
        logs = np.log(errors)
        self._centre, self._unit = float(logs.mean()), float(logs.std()) or 1.0
        self._places, self._targets = places, (logs - self._centre) / self._unit
        with threadpool_limits(1):
            kernel = _most_probable(self._places, self._targets)
            self._signal, self._noise = kernel.k1, float(kernel.k2.noise_level)
            self._process = self._conditioned()

    def _conditioned(self) -> Any:
        """The latent process: the scatter is on the data and not in the prediction."""
        return _process(self._signal, self._noise).fit(self._places, self._targets)

    def believe(self, places: Floats) -> Belief:
        with threadpool_limits(1):
            mean, deviation = self._process.predict(places, return_std=True)
        return Belief(self._centre + self._unit * mean, self._unit * deviation)

    def drawn(self, places: Floats, draws: int, seed: int) -> Floats:
        """(places, draws) surfaces that the runs allow, in log units."""
        with threadpool_limits(1):
            surfaces = self._process.sample_y(places, draws, random_state=seed)
        return self._centre + self._unit * surfaces

    @property
    def scatter(self) -> float:
        """Standard deviation of a single run, in log units: 0.1 is 10 % of the error."""
        return self._unit * math.sqrt(self._noise)

    def expecting(self, place: Floats) -> ErrorModel:
        """The same model, as if a run at this place, (coordinates,), had given what is expected there."""
        other = object.__new__(ErrorModel)
        other._centre, other._unit = self._centre, self._unit
        other._signal, other._noise = self._signal, self._noise
        with threadpool_limits(1):
            expected = self._process.predict(place[None, :])
            other._places = np.vstack([self._places, place])
            other._targets = np.append(self._targets, expected)
            other._process = other._conditioned()
        return other

    def error(self, log: Floats) -> Floats:
        """The mean error of runs whose typical log error this is: the scatter lifts a mean above a median."""
        return np.exp(log + self.scatter**2 / 2)


def _process(kernel: Any, scatter: float = 1e-10) -> Any:
    """With the kernel as it is. scatter: variance of each run beyond what is in the kernel."""
    fixed: Any = None
    return GaussianProcessRegressor(kernel, alpha=scatter, optimizer=fixed)


def _most_probable(places: Floats, targets: Floats) -> Any:
    """Lengths, strength and scatter of the highest posterior."""
    process = _process(_kernel(places.shape[1], BEGINNINGS[0])).fit(places, targets)

    def unlikely(theta: Floats) -> tuple[float, Floats]:
        likelihood, slope = process.log_marginal_likelihood(theta, eval_gradient=True, clone_kernel=False)
        prior, prior_slope = _prior(theta)
        return -(likelihood + prior), -(slope + prior_slope)

    starts = [_kernel(places.shape[1], length) for length in BEGINNINGS]
    found = [_descended(unlikely, start) for start in starts]
    return starts[0].clone_with_theta(min(found, key=lambda result: result[0])[1])


def _descended(unlikely: Callable[[Floats], tuple[float, Floats]], start: Any) -> tuple[float, Floats]:
    result = minimize(unlikely, start.theta, jac=True, bounds=start.bounds, method="L-BFGS-B")
    return float(result.fun), result.x


def _kernel(coordinates: int, length: float) -> Any:
    lengths: Any = [length] * coordinates
    smooth = Matern(lengths, LENGTH_BOUNDS, nu=SMOOTHNESS)
    return ConstantKernel(STRENGTH, STRENGTH_BOUNDS) * smooth + WhiteKernel(SCATTER, SCATTER_BOUNDS)


def _prior(theta: Floats) -> tuple[float, Floats]:
    """Log density of the priors and its slope; theta: logs of strength, lengths and scatter, in this order."""
    lengths = len(theta) - 2
    middle = np.log([STRENGTH, *[LENGTH] * lengths, SCATTER])
    spread = np.array([STRENGTH_SPREAD, *[LENGTH_SPREAD] * lengths, SCATTER_SPREAD])
    off = (theta - middle) / spread
    return float(-0.5 * off @ off), -off / spread
