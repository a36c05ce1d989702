"""The host's limiter: no current, power or change of current passes its limit, whatever is asked."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from control.coils import CoilSet, command_field, currents_for
from control.limiter import CoilLimits, Wanted, check_field_slew, limit

COILS = CoilSet()
ALLOCATION = COILS.centre_allocation()
ALONE = ((800.0, 0.0, 0.0), (0.0, 800.0, 0.0), (0.0, 0.0, 800.0))
"""Each coil makes one component, 8 A for 10 mT."""
TICK = 1.0 / 60.0
TILT = math.radians(25.0)
LIMITS = CoilLimits(
    currents=(8.0, 8.0, 8.0),
    power=300.0,
    slew=(192.0, 436.0, 1714.0),
    resistances=(2.5, 2.0, 1.5),
    ramp=0.050,
    field_slew=0.010 / 0.3,
)
GENEROUS = replace(LIMITS, currents=(1e3,) * 3, power=1e6, slew=(1e6,) * 3)
WALK = Wanted(heading=0.0, rate=2.0, elevation=-TILT, target=-TILT, field=0.010)
LEVEL = replace(WALK, rate=0.0, elevation=0.0, target=0.0)

any_float = st.floats()
entries = st.floats(-2000.0, 2000.0)
matrices = st.tuples(*[st.tuples(entries, entries, entries)] * 3)
positive = st.floats(1e-3, 1e3)
triples = st.tuples(positive, positive, positive)
coil_limits = st.builds(
    CoilLimits, triples, positive, triples, triples, st.floats(1e-3, 1.0), st.floats(1e-3, 1.0)
)
LEANING = Wanted(heading=0.0, rate=0.0, elevation=-1.0, target=0.0, field=0.03125)
ALMOST_SPENT = CoilLimits((1.0, 1.0, 1.0), 1.0, (1.0, 1.0, 559.0), (1.0, 1.0, 1.0), 1.0, 1.0)
"""The strength's own slew leaves a hundredth; a row that lies askew changes most at the steepest elevation."""
motions = st.builds(
    Wanted,
    heading=st.floats(-10.0, 10.0),
    rate=st.floats(-7.0, 7.0),
    elevation=st.floats(-1.05, 1.05),
    target=st.floats(-1.05, 1.05),
    field=st.floats(0.0, 0.05),
)


def field_of(heading: float, elevation: float, strength: float) -> tuple[float, float, float]:
    return command_field(1, heading, -elevation, strength)


def scaled(values: tuple[float, float, float], factor: float) -> list[float]:
    return [factor * value for value in values]


def corners(wanted: Wanted) -> list[tuple[float, float]]:
    """(heading, elevation) at both ends of the tick's motion, and level where the elevation passes through."""
    level = [0.0] if wanted.elevation * wanted.target < 0.0 else []
    return [
        (heading, elevation)
        for heading in (wanted.heading, wanted.heading + wanted.rate * TICK)
        for elevation in (wanted.elevation, wanted.target, *level)
    ]


def test_the_standard_gait_passes_unchanged_wherever_the_robot_points():
    for degrees in range(0, 360, 5):
        granted = limit(replace(WALK, heading=math.radians(degrees)), ALLOCATION, LIMITS, TICK)
        assert (granted.field, granted.rate, granted.limited_by) == (0.010, 2.0, "")


@given(motions, matrices, coil_limits)
def test_no_current_and_no_power_passes_its_limit(wanted, allocation, limits):
    granted = limit(wanted, allocation, limits, TICK)
    for heading, elevation in corners(wanted):
        currents = currents_for(allocation, field_of(heading, elevation, granted.field))
        assert all(abs(i) <= most for i, most in zip(currents, limits.currents, strict=True))
        assert sum(r * i * i for r, i in zip(limits.resistances, currents, strict=True)) <= limits.power


@example(LEANING, ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 362.0, 425.0)), ALMOST_SPENT, 0.0, 0.0)
@given(motions, matrices, coil_limits, st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_no_current_changes_faster_than_it_may(wanted, allocation, limits, turned, raised):
    """The derivatives of B by heading and elevation, anywhere on the way, with the strength's own slew on top."""
    granted = limit(wanted, allocation, limits, TICK)
    heading = wanted.heading + turned * wanted.rate * TICK
    elevation = wanted.elevation + raised * (wanted.target - wanted.elevation)
    sine, cosine = math.sin(elevation), math.cos(elevation)
    by_heading = (-cosine * math.cos(heading), -cosine * math.sin(heading), 0.0)
    by_elevation = (sine * math.sin(heading), -sine * math.cos(heading), cosine)
    ramp = 2.0 * max(abs(wanted.elevation), abs(wanted.target)) / limits.ramp
    for speeds in (
        scaled(currents_for(allocation, by_heading), granted.field * granted.rate),
        scaled(currents_for(allocation, by_elevation), granted.field * ramp),
    ):
        for row, speed, most in zip(allocation, speeds, limits.slew, strict=True):
            own = limits.field_slew * math.hypot(*row)
            assert abs(speed) + own <= most * (1.0 + 1e-12) or speed == 0.0


@given(motions, matrices, coil_limits)
def test_the_field_keeps_its_direction_and_the_turn_its_sense(wanted, allocation, limits):
    granted = limit(wanted, allocation, limits, TICK)
    assert 0.0 <= granted.field <= wanted.field
    assert granted.rate * wanted.rate >= 0.0
    assert abs(granted.rate) <= abs(wanted.rate)
    is_whole = (granted.field, granted.rate) == (wanted.field, wanted.rate)
    assert is_whole or granted.limited_by


@given(any_float, any_float, any_float, any_float, any_float, any_float)
def test_every_float_is_limited_or_refused(heading, rate, elevation, target, field, entry):
    wanted = Wanted(heading, rate, elevation, target, field)
    allocation = ((entry, 0.0, 0.0), *ALLOCATION[1:])
    try:
        granted = limit(wanted, allocation, LIMITS, TICK)
    except ValueError:
        return
    assert abs(granted.field) <= abs(field)
    assert abs(granted.rate) <= abs(rate)
    for at, elevation_ in corners(wanted):
        currents = currents_for(allocation, field_of(at, elevation_, granted.field))
        assert all(abs(i) <= 8.0 for i in currents)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["heading", "rate", "elevation", "target", "field"])
def test_a_motion_that_is_no_number_is_refused(name, value):
    with pytest.raises(ValueError, match="must be finite numbers"):
        limit(replace(WALK, **{name: value}), ALLOCATION, LIMITS, TICK)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_an_allocation_or_a_tick_that_is_no_number_is_refused(value):
    with pytest.raises(ValueError, match="refused"):
        limit(WALK, (ALLOCATION[0], ALLOCATION[1], (0.0, 0.0, value)), LIMITS, TICK)
    with pytest.raises(ValueError, match="refused"):
        limit(WALK, ALLOCATION, LIMITS, value)


@pytest.mark.parametrize(("heading_deg", "coil", "name"), [(90.0, 0, "x"), (0.0, 1, "y")])
def test_each_level_current_counts_up_to_its_limit_and_no_further(heading_deg, coil, name):
    currents = [1e3, 1e3, 1e3]
    currents[coil] = 8.0 * (1.0 + 1e-12)
    limits = replace(GENEROUS, currents=tuple(currents))
    wanted = replace(LEVEL, heading=math.radians(heading_deg))
    assert limit(wanted, ALONE, limits, TICK).limited_by == ""
    granted = limit(replace(wanted, field=0.016), ALONE, limits, TICK)
    assert granted.limited_by == f"current of coil {name}"
    assert granted.field == pytest.approx(0.010, rel=1e-8)


@pytest.mark.parametrize("elevation", [math.pi / 2, -math.pi / 2])
def test_the_current_across_the_plate_counts_as_well(elevation):
    limits = replace(GENEROUS, currents=(1e3, 1e3, 4.0))
    granted = limit(replace(LEVEL, elevation=elevation, target=elevation), ALONE, limits, TICK)
    assert granted.limited_by == "current of coil z"
    assert granted.field == pytest.approx(0.005, rel=1e-8)


def test_the_end_of_the_turn_counts_as_its_beginning_does():
    """A quarter turn in one tick ends on the x coil, or begins on it."""
    limits = replace(GENEROUS, currents=(4.0, 1e3, 1e3))
    for heading, rate in ((0.0, 0.5 * math.pi / TICK), (-0.5 * math.pi, 0.5 * math.pi / TICK)):
        granted = limit(replace(LEVEL, heading=heading, rate=rate), ALONE, limits, TICK)
        assert granted.field == pytest.approx(0.005, rel=1e-8)


def test_a_change_of_pivot_counts_its_way_through_the_level():
    """Tilted by 60 degrees the level part is half; between the two tilts it is the whole field."""
    tilt = math.radians(60.0)
    limits = replace(GENEROUS, currents=(1e3, 5.0, 1e3))
    settled = replace(LEVEL, elevation=-tilt, target=-tilt)
    assert limit(settled, ALONE, limits, TICK).field == 0.010
    switching = replace(settled, target=tilt)
    assert limit(switching, ALONE, limits, TICK).field == pytest.approx(0.00625, rel=1e-8)
    assert limit(replace(settled, elevation=0.0), ALONE, limits, TICK).field == pytest.approx(
        0.00625, rel=1e-8
    )
    assert limit(replace(settled, target=0.0), ALONE, limits, TICK).field == pytest.approx(0.00625, rel=1e-8)


def test_power_is_that_of_all_coils_together_and_goes_with_the_square_of_the_field():
    """At 45 degrees 10 mT need 5.657 A in x and in y: 80 W and 64 W."""
    wanted = replace(LEVEL, heading=math.radians(45.0))
    at_limit = replace(GENEROUS, power=144.0 * (1.0 + 1e-12))
    assert limit(wanted, ALONE, at_limit, TICK).limited_by == ""
    granted = limit(wanted, ALONE, replace(GENEROUS, power=36.0), TICK)
    assert granted.limited_by == "power"
    assert granted.field == pytest.approx(0.005, rel=1e-8)


def test_power_counts_the_coil_across_the_plate():
    wanted = replace(LEVEL, elevation=0.5 * math.pi, target=0.5 * math.pi)
    granted = limit(wanted, ALONE, replace(GENEROUS, power=24.0), TICK)
    assert granted.field == pytest.approx(0.005, rel=1e-8), "8 A in 1.5 ohm are 96 W"


@pytest.mark.parametrize(("coil", "name"), [(0, "x"), (1, "y")])
def test_a_turn_that_is_too_fast_for_a_coil_is_slowed_down_and_keeps_its_field(coil, name):
    """8 A turned at 2 rad/s change by 16 A/s; the strength's own slew takes 26.7 A/s of what is allowed."""
    own = LIMITS.field_slew * 800.0
    slew = [1e6, 1e6, 1e6]
    slew[coil] = own + 16.0 * (1.0 + 1e-9)
    wanted = replace(LEVEL, rate=2.0)
    assert limit(wanted, ALONE, replace(GENEROUS, slew=tuple(slew)), TICK).limited_by == ""
    slew[coil] = own + 8.0
    granted = limit(replace(wanted, rate=-2.0), ALONE, replace(GENEROUS, slew=tuple(slew)), TICK)
    assert granted.limited_by == f"current slew of coil {name}"
    assert granted.rate == pytest.approx(-1.0, rel=1e-8)
    assert granted.field == 0.010


def test_a_turn_changes_no_current_across_the_plate():
    slew = (1e6, 1e6, LIMITS.field_slew * 800.0 + 1e-6)
    assert limit(replace(LEVEL, rate=6.0), ALONE, replace(GENEROUS, slew=slew), TICK).limited_by == ""


@pytest.mark.parametrize(
    ("coil", "needed"),
    [
        (0, 8.0 * math.sin(TILT) * 2.0 * TILT / 0.050),
        (1, 8.0 * math.sin(TILT) * 2.0 * TILT / 0.050),
        (2, 8.0 * 2.0 * TILT / 0.050),
    ],
)
def test_a_change_of_pivot_that_is_too_fast_for_a_coil_weakens_the_field(coil, needed):
    own = LIMITS.field_slew * 800.0
    slew = [1e6, 1e6, 1e6]
    slew[coil] = own + needed * (1.0 + 1e-9)
    assert limit(WALK, ALONE, replace(GENEROUS, slew=tuple(slew)), TICK).limited_by == ""
    slew[coil] = own + 0.5 * needed
    granted = limit(WALK, ALONE, replace(GENEROUS, slew=tuple(slew)), TICK)
    assert granted.limited_by == f"current slew of coil {'xyz'[coil]}"
    assert granted.field == pytest.approx(0.005, rel=1e-8)


def test_the_elevation_now_counts_as_much_as_where_it_goes():
    slew = (1e6, 1e6, LIMITS.field_slew * 800.0 + 4.0 * 2.0 * TILT / 0.050)
    for elevation, target in ((-TILT, 0.1), (0.1, -TILT), (TILT, TILT)):
        wanted = replace(LEVEL, elevation=elevation, target=target)
        assert limit(wanted, ALONE, replace(GENEROUS, slew=slew), TICK).field == pytest.approx(
            0.005, rel=1e-8
        )


def test_an_elevation_beyond_the_upright_counts_as_upright():
    slew = (LIMITS.field_slew * 800.0 + 8.0 * 2.0 * 2.0 / 0.050, 1e6, 1e6)
    wanted = replace(LEVEL, elevation=2.0, target=2.0)
    assert limit(wanted, ALONE, replace(GENEROUS, slew=slew), TICK).field == pytest.approx(0.010, rel=1e-8)


def test_where_the_strength_alone_uses_the_slew_up_nothing_may_ramp_or_turn():
    slew = (1e6, 1e6, LIMITS.field_slew * 800.0 * 0.5)
    assert limit(WALK, ALONE, replace(GENEROUS, slew=slew), TICK).field == 0.0
    slew = (LIMITS.field_slew * 800.0 * 0.5, 1e6, 1e6)
    assert limit(replace(LEVEL, rate=2.0), ALONE, replace(GENEROUS, slew=slew), TICK).rate == 0.0


def test_of_several_limits_the_one_that_leaves_least_is_named():
    limits = replace(GENEROUS, currents=(1e3, 6.0, 1e3), power=32.0)
    granted = limit(LEVEL, ALONE, limits, TICK)
    assert granted.limited_by == "power"
    assert granted.field == pytest.approx(0.005, rel=1e-8)
    assert limit(LEVEL, ALONE, replace(limits, power=100.0), TICK).limited_by == "current of coil y"


def test_a_limited_field_is_what_names_the_limit_where_the_turn_is_limited_too():
    limits = replace(GENEROUS, currents=(1e3, 4.0, 1e3), slew=(LIMITS.field_slew * 800.0 + 4.0, 1e6, 1e6))
    granted = limit(replace(LEVEL, rate=2.0), ALONE, limits, TICK)
    assert granted.limited_by == "current of coil y"
    assert granted.field == pytest.approx(0.005, rel=1e-8)
    assert granted.rate == pytest.approx(1.0, rel=1e-8), "half the field turns twice as fast"


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
@pytest.mark.parametrize("name", ["currents", "power", "slew", "resistances", "ramp", "field_slew"])
def test_a_limit_that_limits_nothing_is_refused(name, value):
    wrong = value if name in ("power", "ramp", "field_slew") else (1.0, 1.0, value)
    with pytest.raises(ValueError, match=f"coil limits: {name} must be finite and above 0"):
        replace(LIMITS, **{name: wrong})


@pytest.mark.parametrize(("coil", "name"), [(0, "x"), (1, "y"), (2, "z")])
def test_a_field_that_comes_up_faster_than_a_current_may_change_is_refused(coil, name):
    """10 mT in 40 ms change 8 A by 200 A/s."""
    slew = [1e6, 1e6, 1e6]
    slew[coil] = 200.0 * (1.0 + 1e-9)
    check_field_slew(ALONE, replace(LIMITS, field_slew=0.25, slew=tuple(slew)))
    slew[coil] = 200.0
    with pytest.raises(ValueError, match=f"coil {name} by 200 A/s; below 200 A/s is allowed"):
        check_field_slew(ALONE, replace(LIMITS, field_slew=0.25, slew=tuple(slew)))


@given(st.floats(-0.06, 0.06), st.floats(-0.06, 0.06), st.floats(-10.0, 10.0), st.sampled_from([1, -1]))
def test_the_paper_rig_walks_with_its_whole_field_but_for_its_hardest_places(x, y, heading, pivot):
    """Beyond 8 A only where a pair is weakest: never less than 95 % of the field."""
    wanted = replace(WALK, heading=heading, elevation=-pivot * TILT, target=pivot * TILT)
    assume(max(abs(x), abs(y)) <= 0.06)
    assert limit(wanted, COILS.local_allocation(x, y), LIMITS, TICK).field >= 0.0095
