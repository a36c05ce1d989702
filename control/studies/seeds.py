"""Random numbers of a study: each run has its own seed, whatever the order in which the runs are done."""

from __future__ import annotations

import numpy as np

SEED_BITS = 53
"""A seed that JSON, and a browser that reads it, keep exactly."""


def run_seed(study_seed: int, index: int) -> int:
    """Of the run's plant: 0 <= seed < 2^53, a function of the study's seed and the run's index."""
    return int(np.random.SeedSequence([study_seed, index]).generate_state(1, np.uint64)[0]) >> (
        64 - SEED_BITS
    )


def generator(study_seed: int, *purpose: int) -> np.random.Generator:
    """Random numbers for one purpose of the study itself."""
    return np.random.default_rng(np.random.SeedSequence([study_seed, *purpose]))
