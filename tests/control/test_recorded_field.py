"""What was recorded of the field tells of it as much as the rig itself knew."""

import math
import random

import pytest

from control.field_model import FieldModel
from control.model import PIVOT_A, PIVOT_B
from control.recorded_field import RecordedField

RAMP, SLEW, TILT, STRENGTH = 0.05, 0.03, math.radians(25.0), 0.010
PERIOD = 1.0 / 60.0


def ticks(live: FieldModel, count: int, seed: int):
    """Drives a field about as a walk would, and tells of each tick: when, and what is to be recorded of it."""
    chance = random.Random(seed)
    live.start(0.0, 0.3, PIVOT_A, TILT, STRENGTH)
    for number in range(1, count):
        now = number * PERIOD
        live.advance(now)
        if chance.random() < 0.02:
            live.synchronise(now, now, live.heading + math.radians(5.0))
        if live.is_ready and number % 20 == 0:
            way = chance.choice((-1.0, 1.0))
            live.command(chance.choice((PIVOT_A, PIVOT_B)), TILT, way * 2.0, live.heading + way * 0.5)
        yield now, live.trace()


@pytest.mark.parametrize("seed", range(5))
def test_every_question_is_answered_as_the_rig_s_own_mirror_did(seed):
    live, recorded = FieldModel(RAMP, SLEW), RecordedField(RAMP, SLEW)
    for now, trace in ticks(live, 400, seed):
        recorded.follow(now, trace)
        for ago in (0.0, 0.001, 0.0351, 0.2):
            time = now - ago
            assert recorded.heading_at(time) == live.heading_at(time)
            assert recorded.elevation_at(time) == live.elevation_at(time)
            assert recorded.strength_at(time) == pytest.approx(live.strength_at(time), abs=1e-12)
        assert recorded.turns(now - 0.1, now) == live.turns(now - 0.1, now)
        assert (recorded.is_on, recorded.is_ready, recorded.pivot) == (live.is_on, live.is_ready, live.pivot)


def test_it_has_settled_when_it_stands_where_it_was_told_to_go():
    live, recorded = FieldModel(RAMP, SLEW), RecordedField(RAMP, SLEW)
    live.start(0.0, 0.0, PIVOT_A, TILT, STRENGTH)
    live.command(PIVOT_B, TILT, 1.0, 0.2)
    recorded.aim(PIVOT_B, TILT, 0.2)
    settled = []
    for number in range(1, 60):
        live.advance(number * PERIOD)
        recorded.follow(number * PERIOD, live.trace())
        assert recorded.is_settled == live.is_settled
        settled.append(live.is_settled)
    assert settled[0] is False
    assert settled[-1] is True


def test_a_field_that_has_gone_off_has_no_strength():
    live, recorded = FieldModel(RAMP, SLEW), RecordedField(RAMP, SLEW)
    live.start(0.0, 0.0, PIVOT_A, TILT, STRENGTH)
    live.advance(1.0)
    live.stop(1.0)
    recorded.follow(1.0, live.trace())
    assert recorded.strength_at(1.0) == 0.0
    assert not recorded.is_ready
