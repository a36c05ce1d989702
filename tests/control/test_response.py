"""A robot that turns against its field is noticed; one that follows, rests, sticks or is pushed is not."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.model import wrap
from control.response import AWAY, FAR, JUMP, MOST_COUNTED, STILL, ResponseWatch

FRAME = 1.0 / 60.0
NOISE = math.radians(0.35)
RATES = [math.radians(rate) for rate in (20.0, 60.0, 115.0, 360.0)]


def against(watch: ResponseWatch, field: list[float], body: list[float]) -> float:
    """The most that is found on the way."""
    worst = 0.0
    for one, other in zip(field, body, strict=True):
        watch.see(one, other)
        worst = max(worst, watch.turned_away)
    return worst


def turning(rate: float, angle: float, start: float = 0.0) -> list[float]:
    """Headings from frame to frame."""
    return [start + rate * FRAME * k for k in range(int(angle / abs(rate) / FRAME) + 1)]


@pytest.mark.parametrize("start", [0.0, 3.0, -3.1, 40.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("rate", RATES)
def test_a_body_that_mirrors_the_field_is_noticed_within_8_degrees(rate, sense, start) -> None:
    turn = max(math.radians(8.0), 5.0 * rate * FRAME)
    field = turning(sense * rate, turn, start)
    body = [start - (heading - start) for heading in field]
    assert against(ResponseWatch(), field, body) > AWAY


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_body_that_follows_through_its_play_never_counts(rate, sense) -> None:
    """Sweeps to and fro with 11 degrees of play, the most that there is, and the camera's noise."""
    chance, half, body = random.Random(5), math.radians(5.7), 0.0
    watch, start = ResponseWatch(), 0.0
    for sweep in range(20):
        towards = sense if sweep % 2 == 0 else -sense
        field = turning(towards * rate, math.radians(30.0), start)
        start = field[-1]
        for heading in field:
            body = min(max(body, heading - half), heading + half)
            watch.see(heading, body + chance.gauss(0.0, NOISE))
            assert watch.turned_away < AWAY


def test_a_body_that_sticks_while_the_field_goes_on_never_counts() -> None:
    chance = random.Random(3)
    field = turning(math.radians(60.0), math.radians(150.0))
    body = [chance.gauss(0.0, NOISE) for _ in field]
    assert against(ResponseWatch(), field, body) < AWAY


def test_a_body_that_snaps_round_while_the_field_stands_still_is_noticed() -> None:
    """What a swapped coil does at the arm edge: the field comes up the other way round."""
    body = turning(math.radians(600.0), math.radians(170.0))
    assert against(ResponseWatch(), [0.0] * len(body), body) > AWAY


def test_one_false_sighting_or_one_push_does_not_count() -> None:
    for back_again in (True, False):
        watch = ResponseWatch()
        for body in [0.0] * 10 + [math.radians(20.0)] + [0.0 if back_again else math.radians(20.0)] * 10:
            watch.see(0.0, body)
            assert watch.turned_away <= MOST_COUNTED


def test_a_sighting_elsewhere_is_no_turn() -> None:
    watch = ResponseWatch()
    watch.see(0.0, 0.0)
    watch.see(0.0, JUMP + 1e-9)
    assert watch.turned_away == 0.0
    watch.see(0.0, 0.0)
    assert watch.turned_away == 0.0
    watch.see(0.0, -JUMP - 1e-9)
    assert watch.turned_away == 0.0
    watch.forget()
    watch.see(0.0, 0.0)
    watch.see(0.0, JUMP - 1e-9)
    assert watch.turned_away == MOST_COUNTED


def test_the_thresholds_are_many_times_the_noise() -> None:
    assert [round(math.degrees(angle), 9) for angle in (FAR, AWAY, MOST_COUNTED, JUMP)] == [20, 4, 2, 45]
    assert 8 * NOISE * math.sqrt(2.0) < AWAY


def test_three_sightings_must_show_it() -> None:
    watch, step = ResponseWatch(), math.radians(5.0)
    found = []
    for k in range(5):
        watch.see(0.0, 0.6 + k * step)
        found.append(watch.turned_away)
    assert found == pytest.approx([0.0, AWAY / 2, AWAY, 1.5 * AWAY, 2 * AWAY])


def test_what_is_counted_is_taken_back_by_following() -> None:
    watch = ResponseWatch()
    for body in (0.6, 0.62, 0.64):
        watch.see(0.0, body)
    assert watch.turned_away == pytest.approx(0.04)
    watch.see(0.0, 0.63)
    assert watch.turned_away == pytest.approx(0.03)
    watch.see(0.0, 0.59)
    assert watch.turned_away == 0.0, "never below none"
    watch.see(0.0, 0.61)
    assert watch.turned_away == pytest.approx(0.02)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_field_that_turns_back_begins_anew(sense) -> None:
    watch = ResponseWatch()
    for k in range(4):
        watch.see(sense * 0.02 * k, -sense * 0.02 * k)
    assert watch.turned_away == pytest.approx(0.06)
    watch.see(sense * 0.04, -sense * 0.06)
    assert watch.turned_away == 0.0


def test_a_small_lead_of_a_field_that_stands_still_pulls_nothing_and_a_large_one_does() -> None:
    watch = ResponseWatch()
    watch.see(0.0, FAR - 0.01)
    watch.see(0.0, FAR - 1e-9)
    assert watch.turned_away == 0.0
    watch.see(0.0, FAR + 0.001)
    assert watch.turned_away == pytest.approx(0.001, rel=1e-5)


def test_a_field_that_hardly_moves_stands_still() -> None:
    watch = ResponseWatch()
    watch.see(0.0, 0.0)
    watch.see(STILL, -0.01)
    assert watch.turned_away == 0.0
    watch.see(2.1 * STILL, -0.02)
    assert watch.turned_away == pytest.approx(0.01)


@pytest.mark.parametrize("offset", [4.0, 10.0, 15.0, -15.0])
def test_a_camera_that_is_not_registered_with_the_coils_never_counts(offset) -> None:
    """The body follows, seen at a constant angle to where the field is believed to point."""
    chance, watch, half, body, start = random.Random(9), ResponseWatch(), math.radians(1.5), 0.0, 0.0
    watch.see(0.0, 0.0)
    for sweep in range(20):
        field = turning((-1.0) ** sweep * math.radians(60.0), math.radians(10.0), start)
        start = field[-1]
        for heading in field:
            body = min(max(body, heading - half), heading + half)
            watch.see(heading, body + math.radians(offset) + chance.gauss(0.0, NOISE))
            assert watch.turned_away < AWAY


def test_sweeps_of_ten_degrees_are_enough_to_notice_a_mirror() -> None:
    watch, start, half, body, worst = ResponseWatch(), 0.0, math.radians(1.5), 0.0, 0.0
    for sweep in range(2):
        field = turning((-1.0) ** sweep * math.radians(60.0), math.radians(10.0), start)
        start = field[-1]
        for heading in field:
            body = min(max(body, -heading - half), -heading + half)
            watch.see(heading, body)
            worst = max(worst, watch.turned_away)
    assert worst > AWAY


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_it_counts_alike_across_the_half_turn(sense) -> None:
    watch = ResponseWatch()
    for body in (3.10, 3.12, 3.14, 3.16, 3.18):
        watch.see(sense * 2.4, wrap(sense * body))
    assert watch.turned_away == pytest.approx(0.08)


def test_forgetting_begins_anew() -> None:
    watch = ResponseWatch()
    for body in (0.6, 0.7, 0.8, 0.9, 1.0):
        watch.see(0.0, body)
    assert watch.turned_away > AWAY
    watch.forget()
    assert watch.turned_away == 0.0
    watch.see(0.0, 1.1)
    assert watch.turned_away == 0.0, "the first sighting has nothing before it"


@given(st.lists(st.tuples(st.floats(), st.floats()), max_size=20))
def test_no_float_makes_it_a_nonsense(sightings) -> None:
    watch = ResponseWatch()
    for field, body in sightings:
        watch.see(field, body)
        assert 0.0 <= watch.turned_away < math.inf


@pytest.mark.parametrize("nonsense", [(math.nan, 0.2), (0.0, math.nan), (math.inf, 0.2), (0.0, math.inf)])
def test_a_sighting_that_is_none_is_left_out(nonsense) -> None:
    watch = ResponseWatch()
    for sighting in ((0.0, 0.6), nonsense, (0.0, 0.61)):
        watch.see(*sighting)
    assert watch.turned_away == pytest.approx(0.01)
