"""The delay between field and picture, from headings made up with a known one."""

import math
from dataclasses import replace

import numpy as np
import pytest

from control.calibration.latency import Delay, Wiggled, behind_play, corners_of, delay_of
from control.calibration.turning import Unclear

RATE = math.radians(40.0)
NOISE = math.radians(0.35)


def swings(
    count: int = 24, width: float = math.radians(20.0), rest: float = 0.3
) -> tuple[np.ndarray, np.ndarray]:
    """Times (s, each millisecond) and headings (rad) of a field that turns to and fro, now fast, now slowly."""
    times, headings = [0.0, 0.4], [1.0, 1.0]
    for number in range(count):
        rate = RATE * (1.0 if number // 2 % 2 == 0 else 0.5)
        turn = (0.5 if number == 0 else 1.0) * width * (1 if number % 2 == 0 else -1)
        times += [times[-1] + abs(turn) / rate, times[-1] + abs(turn) / rate + rest]
        headings += [headings[-1] + turn] * 2
    every = np.arange(0.0, times[-1], 0.001)
    return every, np.interp(every, times, headings)


def wiggled(delay: float, play: float = 0.0, offset: float = 0.0, noise: float = NOISE, **more) -> Wiggled:
    """What a camera with 60 frames a second sees of a body behind a play; seed, gain, rate: as named."""
    field_times, field = swings()
    chance = np.random.default_rng(more.get("seed", 1))
    times = np.arange(0.25, field_times[-1], 1.0 / more.get("rate", 60.0))
    body = np.interp(times - delay, *behind_play(field_times, field, play))
    seen = 1.0 + more.get("gain", 1.0) * (body - 1.0) + offset + chance.normal(0.0, noise, len(times))
    return Wiggled(field_times, field, times, (seen + math.pi) % (2 * math.pi) - math.pi)


@pytest.mark.parametrize("delay", [0.0, 0.010, 0.035, 0.060, 0.100, 0.150])
@pytest.mark.parametrize("play_deg", [0.0, 4.0, 7.0])
def test_the_delay_is_found_whatever_the_play(delay: float, play_deg: float) -> None:
    found = delay_of(wiggled(delay, math.radians(play_deg)))
    assert found.delay == pytest.approx(delay, abs=0.002)
    assert math.degrees(found.play) == pytest.approx(play_deg, abs=0.3)


def test_the_standard_error_is_honest() -> None:
    found = [delay_of(wiggled(0.035, math.radians(4.0), seed=seed)) for seed in range(12)]
    far = sum(abs(each.delay - 0.035) > 2.0 * each.standard_error for each in found)
    assert far <= 3
    spread = float(np.std([each.delay for each in found]))
    assert 0.5 * spread <= float(np.mean([each.standard_error for each in found])) <= 2.0 * spread


@pytest.mark.parametrize("offset", [-2.9, -0.3, 0.3, 3.1])
def test_a_camera_that_is_turned_against_the_coils_is_no_later_for_that(offset: float) -> None:
    assert delay_of(wiggled(0.035, offset=offset)).delay == pytest.approx(0.035, abs=0.002)


def test_a_robot_that_follows_by_less_than_the_field_turns_is_no_later_for_that() -> None:
    found = delay_of(wiggled(0.035, gain=0.9))
    assert found.delay == pytest.approx(0.035, abs=0.002)
    assert found.gain == pytest.approx(0.9, abs=0.02)


def test_a_few_false_sightings_do_not_shift_the_delay() -> None:
    clean = wiggled(0.035, math.radians(4.0))
    headings = clean.headings.copy()
    headings[::40] += math.radians(20.0)
    found = delay_of(replace(clean, headings=headings))
    assert found.delay == pytest.approx(0.035, abs=0.002)
    assert found.sightings < len(clean.times)


def test_stamps_that_are_early_give_a_delay_below_zero_instead_of_none() -> None:
    assert delay_of(wiggled(-0.020)).delay == pytest.approx(-0.020, abs=0.002)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        ({"gain": 0.0}, "does not follow"),
        ({"gain": -1.0}, "does not follow"),
        ({"noise": math.radians(8.0)}, "sticks, or is seen badly"),
        ({"rate": 2.0}, "sightings while the field turns are needed"),
        ({"delay": 0.199}, "too late to walk with"),
    ],
)
def test_what_is_unclear_is_refused_in_words(made: dict, words: str) -> None:
    with pytest.raises(Unclear, match=words):
        delay_of(wiggled(**{"delay": 0.035, **made}))


def test_nothing_seen_is_no_delay() -> None:
    nothing = np.zeros(0)
    with pytest.raises(Unclear, match="not seen"):
        delay_of(Wiggled(*swings(), nothing, nothing))


def test_a_body_behind_a_play_stays_within_it() -> None:
    times, field = swings()
    play = math.radians(5.0)
    behind = field - np.interp(times, *behind_play(times, field, play))
    assert np.abs(behind).max() == pytest.approx(0.5 * play)
    assert np.interp(times, *behind_play(times, field, 0.0)) == pytest.approx(field)


def test_the_corners_of_a_line_are_all_that_is_needed_of_it() -> None:
    times, field = swings()
    corners = corners_of(times, field)
    assert len(corners[0]) < 200
    assert np.interp(times, *corners) == pytest.approx(field)


def test_the_answer_is_the_same_from_the_same_sightings() -> None:
    first, second = (delay_of(wiggled(0.035, math.radians(4.0))) for _ in range(2))
    assert isinstance(first, Delay)
    assert first == second
