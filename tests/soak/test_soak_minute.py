"""A minute of the soak, as `make soak` plays it for an hour."""

from __future__ import annotations

import pytest

from tests.soak.report import broken_words
from tests.soak.soak import MINUTE, Plan, Soak

pytestmark = pytest.mark.exclusive

SEED = 9


def test_a_minute_of_faults_under_load_breaks_no_invariant() -> None:
    """Whatever fails while people watch, the rig keeps what it promises, records it, and leaves nothing behind."""
    outcome = Soak(Plan(MINUTE, SEED), lambda _: None).run()
    assert not outcome.broken, broken_words(outcome)
    assert outcome.stage is not None
    assert outcome.load is not None
    assert outcome.stage.counts["fault"] >= 4
    assert outcome.stage.counts["runs"] >= 2
    assert outcome.load.counts["pictures"] > 0
    assert outcome.load.counts["telemetry messages"] > 0
