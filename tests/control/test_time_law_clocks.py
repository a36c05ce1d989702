"""Time laws: how fast the reference moves along its path."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.gait import Gait, TimeLaw
from control.trajectories import Path, trajectories
from control.trajectories.arc_length import ArcLength
from control.trajectories.time_law import Law, Retimed, law_of
from control.trajectories.trajectory import length_of

EIGHT = trajectories.build("eight", {})
PATHS = {
    "eight": EIGHT,
    "lissajous": trajectories.build("lissajous", {}),
    "line": trajectories.build("line", {}),
    "letter": trajectories.build("letter", {"letter": "M"}),
    "square": trajectories.build("waypoints", {}),
}
LENGTHS = {name: ArcLength(path) for name, path in PATHS.items()}

names = st.sampled_from(list(PATHS))
laws = st.sampled_from(list(TimeLaw))
gaits = st.builds(
    Gait,
    time_law=laws,
    path_step=st.floats(0.02, 0.9),
    speed=st.floats(2e-4, 0.05),
    acceleration=st.floats(1e-4, 1.0),
)

patient = settings(max_examples=60, deadline=None)


def retimed(name: str, gait: Gait, passes: float = 1.0) -> Retimed:
    return Retimed(PATHS[name], law_of(gait, LENGTHS[name], passes))


def speeds_of(path: Path, until: float, count: int = 4000) -> np.ndarray:
    points = np.array([path.point(t) for t in np.linspace(0.0, until, count + 1).tolist()])
    return np.hypot(*np.diff(points, axis=0).T) * count / until


def test_the_path_step_runs_the_papers_clock() -> None:
    quick = retimed("eight", Gait(path_step=0.3))
    for t in (0.0, 7.0, 41.0, 100.0):
        assert quick.point(t) == pytest.approx(EIGHT.point(3.0 * t), abs=1e-15)
    assert quick.duration == pytest.approx(125.663706 / 3.0)


def test_at_the_papers_path_step_nothing_is_changed_at_all() -> None:
    plain = retimed("eight", Gait())
    assert all(plain.point(t) == EIGHT.point(t) for t in np.linspace(0.0, 300.0, 1001).tolist())


@pytest.mark.parametrize("name", ["eight", "lissajous", "letter", "line"])
@pytest.mark.parametrize("law", [TimeLaw.CONSTANT_SPEED, TimeLaw.WAIT])
def test_a_constant_speed_is_constant_on_every_path(name: str, law: TimeLaw) -> None:
    path = retimed(name, Gait(time_law=law, speed=0.004))
    speeds = speeds_of(path, path.duration)
    assert np.percentile(np.abs(speeds / 0.004 - 1.0), 99) < 0.005
    assert path.duration == pytest.approx(length_of(PATHS[name]) / 0.004, rel=1e-6)


def test_a_constant_speed_goes_round_again_on_a_closed_path() -> None:
    path = retimed("eight", Gait(time_law=TimeLaw.CONSTANT_SPEED))
    assert path.closed
    assert path.point(1.3 * path.duration) == pytest.approx(path.point(0.3 * path.duration), abs=1e-9)


@patient
@given(names, st.floats(1e-3, 0.05), st.floats(1e-4, 1.0), st.floats(0.05, 3.0))
def test_a_trapezoid_keeps_its_speed_and_acceleration_from_rest_to_rest(
    name: str, speed: float, acceleration: float, passes: float
) -> None:
    gait = Gait(time_law=TimeLaw.TRAPEZOIDAL, speed=speed, acceleration=acceleration)
    law, lengths = law_of(gait, LENGTHS[name], passes), LENGTHS[name]
    times = np.linspace(-0.1, 1.1, 1201) * law.whole
    walked = np.array([lengths.length_at(law.path_time(t)) for t in times.tolist()])
    speeds = np.diff(walked) / np.diff(times)
    assert walked[0] == pytest.approx(0.0, abs=1e-12)
    whole = lengths.whole * (passes if PATHS[name].closed else min(1.0, passes))
    assert walked[-1] == pytest.approx(whole, rel=1e-9)
    assert speeds.min() >= -1e-9
    assert speeds.max() <= speed * (1.0 + 1e-6)
    assert np.abs(np.diff(speeds) / np.diff(times)[0]).max() <= acceleration * (1.0 + 1e-3) + 1e-9


def test_a_trapezoid_takes_the_time_that_its_ramps_cost() -> None:
    gait = Gait(time_law=TimeLaw.TRAPEZOIDAL, speed=0.004, acceleration=0.001)
    assert retimed("line", gait).duration == pytest.approx(0.080 / 0.004 + 0.004 / 0.001)


def test_a_short_way_never_reaches_the_full_speed() -> None:
    gait = Gait(time_law=TimeLaw.TRAPEZOIDAL, speed=0.05, acceleration=0.001)
    assert retimed("line", gait).duration == pytest.approx(2.0 * math.sqrt(0.080 / 0.001))


def test_a_walk_of_several_passes_rests_only_at_its_end() -> None:
    gait = Gait(time_law=TimeLaw.TRAPEZOIDAL, speed=0.004, acceleration=0.001)
    path = retimed("eight", gait, passes=2.0)
    assert not path.closed
    in_the_middle = speeds_of(path, path.duration)[1000:3000]
    assert in_the_middle == pytest.approx(0.004, rel=0.02)
    assert path.point(10.0 * path.duration) == pytest.approx(EIGHT.point(0.0), abs=1e-9)


@patient
@given(names, gaits, st.floats(0.1, 3.0), st.floats(0.0, 1.0))
def test_each_law_knows_when_it_was_where(name: str, gait: Gait, passes: float, share: float) -> None:
    law: Law = law_of(gait, LENGTHS[name], passes)
    assert law.whole > 0.0
    time = share * law.whole
    place = law.path_time(time)
    assert law.path_time(law.time(place)) == pytest.approx(place, abs=1e-6 * PATHS[name].duration)


@patient
@given(names, gaits, st.floats(0.1, 3.0))
def test_a_whole_walk_is_the_passes_that_were_asked_for(name: str, gait: Gait, passes: float) -> None:
    path, lengths = PATHS[name], LENGTHS[name]
    end = law_of(gait, lengths, passes).path_time(law_of(gait, lengths, passes).whole)
    if gait.time_law is TimeLaw.PATH_STEP:
        assert end == pytest.approx(passes * path.duration)
    else:
        walked = passes if path.closed else min(1.0, passes)
        assert lengths.length_at(end) == pytest.approx(walked * lengths.whole, rel=1e-6)


@patient
@given(names, gaits)
def test_no_law_goes_back_or_jumps(name: str, gait: Gait) -> None:
    law = law_of(gait, LENGTHS[name], 1.0)
    places = [law.path_time(t) for t in np.linspace(0.0, law.whole, 301).tolist()]
    steps = [there - here for here, there in itertools.pairwise(places)]
    assert min(steps) >= -1e-9
    assert max(steps) <= 0.2 * PATHS[name].duration


@patient
@given(names, st.floats(0.0, 5.0))
def test_lengths_and_times_of_a_path_are_each_others_inverse(name: str, passes: float) -> None:
    lengths = LENGTHS[name]
    length = passes * lengths.whole
    assert lengths.length_at(lengths.time_at(length)) == pytest.approx(length, abs=1e-9)
