"""What categorical terms explain of the sets' means, by weighted least squares; balanced or not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Codes = NDArray[np.int64]
Term = tuple[int, ...]
"""Which factors take part: (0,) a main effect, (0, 2) an interaction of two."""
NO_RANK = 1e-9
"""Singular values below this share of the largest count as none."""


def basis(codes: Sequence[Codes], counts: Array, terms: Sequence[Term]) -> Array:
    """Orthonormal columns (sets, rank) that span mean and terms. codes: level of each set, one array a factor.

    counts: (sets,) runs of each set; its mean's row is weighted with their root.
    """
    columns = [np.ones((len(counts), 1))]
    columns += [indicators(levels(codes, term)) for term in terms]
    u, singular, _ = np.linalg.svd(np.hstack(columns) * np.sqrt(counts)[:, None], full_matrices=False)
    return u[:, singular > NO_RANK * singular[0]]


def explained(columns: Array, counts: Array, means: Array) -> float:
    """Sum of squares of the part that a basis explains. means: (sets,)."""
    return float(np.sum((columns.T @ (np.sqrt(counts) * means)) ** 2))


def levels(codes: Sequence[Codes], term: Term) -> Codes:
    """Number of the combination of the term's factors, for each set."""
    joined = np.stack([codes[factor] for factor in term], axis=1)
    return np.ravel(np.unique(joined, axis=0, return_inverse=True)[1]).astype(np.int64)


def indicators(level: Codes) -> Array:
    return (level[:, None] == np.arange(level.max() + 1)).astype(float)
