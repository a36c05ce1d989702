"""The estimate of the coils' heat: right by its differential equation, safe for every float."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.coil_heat import (
    ASSUMED_AT_START,
    MOST_CURRENT,
    OFF_AT,
    UNKNOWN,
    WARN_AT,
    CoilHeat,
    ThermalLimits,
    winding_estimate,
)
from control.coils import PAPER_PAIRS
from server.coil_sections import LimitsSection

LIMITS = ThermalLimits(continuous=(9.0, 8.0, 6.0), time_constants=(2700.0, 2100.0, 1300.0))
COLD = CoilHeat()
REST = (0.0, 0.0, 0.0)
FULL = (9.0, 8.0, 6.0)

any_float = st.floats()
shares = st.floats(0.0, 5.0)
currents = st.floats(-10.0, 10.0)


def test_the_continuous_current_leads_to_exactly_all_the_heat() -> None:
    assert COLD.after(math.inf, FULL, LIMITS).shares == (1.0, 1.0, 1.0)
    assert COLD.after(math.inf, (4.5, -4.0, 3.0), LIMITS).shares == (0.25, 0.25, 0.25)


def test_each_coil_takes_its_own_time() -> None:
    warm = COLD.after(1300.0, FULL, LIMITS)
    expected = [1.0 - math.exp(-1300.0 / constant) for constant in LIMITS.time_constants]
    assert warm.shares == pytest.approx(expected, rel=1e-12)


@given(shares, currents, st.floats(0.0, 1e4), st.floats(0.0, 1e4))
def test_two_times_in_a_row_are_one(share: float, current: float, first: float, second: float) -> None:
    heat, load = CoilHeat((share, 0.0, 0.5)), (current, 2.0, 3.0)
    at_once = heat.after(first + second, load, LIMITS)
    in_steps = heat.after(first, load, LIMITS).after(second, load, LIMITS)
    assert in_steps.shares == pytest.approx(at_once.shares, rel=1e-9, abs=1e-12)


@given(shares, currents)
def test_the_heat_obeys_its_differential_equation(share: float, current: float) -> None:
    step = 1e-3
    ((after, _, _),) = [CoilHeat((share, 0.0, 0.0)).after(step, (current, 0.0, 0.0), LIMITS).shares]
    slope = ((current / 9.0) ** 2 - share) / 2700.0
    assert (after - share) / step == pytest.approx(slope, abs=1e-6)


def test_a_coil_cools_down_while_nothing_flows() -> None:
    (one, two, three) = CoilHeat((1.0, 1.0, 1.0)).after(600.0, REST, LIMITS).shares
    assert (one, two, three) == pytest.approx([math.exp(-600.0 / c) for c in LIMITS.time_constants])


@pytest.mark.parametrize("coil", [0, 1, 2])
def test_a_coil_is_too_hot_from_all_its_heat_on(coil: int) -> None:
    just_below = [0.0, 0.0, 0.0]
    just_below[coil] = math.nextafter(OFF_AT, 0.0)
    one, two, three = just_below
    assert not CoilHeat((one, two, three)).after(0.0, REST, LIMITS).is_too_hot
    just_below[coil] = OFF_AT
    one, two, three = just_below
    assert CoilHeat((one, two, three)).after(0.0, REST, LIMITS).is_too_hot


@pytest.mark.parametrize("coil", [0, 1, 2])
def test_a_coil_that_was_too_hot_stays_so_until_it_is_below_the_warning(coil: int) -> None:
    shares = [0.0, 0.0, 0.0]
    shares[coil] = WARN_AT
    assert CoilHeat((shares[0], shares[1], shares[2]), is_too_hot=True).after(0.0, REST, LIMITS).is_too_hot
    shares[coil] = math.nextafter(WARN_AT, 0.0)
    assert (
        not CoilHeat((shares[0], shares[1], shares[2]), is_too_hot=True).after(0.0, REST, LIMITS).is_too_hot
    )


def test_a_warm_coil_that_was_never_too_hot_is_not() -> None:
    assert not CoilHeat((0.99, 0.99, 0.99)).after(0.0, REST, LIMITS).is_too_hot


def test_the_wait_is_as_long_as_the_slowest_coil_takes_to_the_warning() -> None:
    heat = CoilHeat((1.0, 0.9, 0.1))
    assert heat.wait(LIMITS) == pytest.approx(2700.0 * math.log(1.0 / 0.8))
    rested = heat.after(heat.wait(LIMITS), REST, LIMITS)
    assert max(rested.shares) == pytest.approx(WARN_AT, rel=1e-12)
    assert CoilHeat((WARN_AT, 0.0, 0.0)).wait(LIMITS) == 0.0
    assert CoilHeat((0.5, 0.0, 0.0)).wait(LIMITS) == 0.0
    assert CoilHeat((0.0, 0.0, 1.0)).wait(LIMITS) == pytest.approx(1300.0 * math.log(1.0 / 0.8))


@given(any_float, any_float, any_float, any_float)
def test_no_float_ever_makes_the_estimate_a_nonsense_or_a_hot_coil_cold(
    elapsed: float, one: float, two: float, three: float
) -> None:
    heat = CoilHeat((0.5, 0.5, 0.5)).after(elapsed, (one, two, three), LIMITS)
    for share, current, continuous in zip(heat.shares, (one, two, three), LIMITS.continuous, strict=True):
        counted = min(abs(current), MOST_CURRENT) if current == current else MOST_CURRENT
        final = (counted / continuous) ** 2
        assert min(0.5, final) - 1e-12 <= share <= max(0.5, final) + 1e-12


@pytest.mark.parametrize("current", [math.nan, math.inf, -math.inf, 50.1, -50.1])
def test_a_current_that_is_none_counts_as_the_most_that_there_can_be(current: float) -> None:
    heat = COLD.after(10.0, (current, current, current), LIMITS)
    assert heat == COLD.after(10.0, (MOST_CURRENT, MOST_CURRENT, MOST_CURRENT), LIMITS)
    assert heat != COLD.after(10.0, (49.9, 49.9, 49.9), LIMITS)


@pytest.mark.parametrize("elapsed", [math.nan, -1.0, 0.0])
def test_a_time_that_is_none_changes_nothing(elapsed: float) -> None:
    assert CoilHeat((0.3, 0.4, 0.5)).after(elapsed, FULL, LIMITS).shares == (0.3, 0.4, 0.5)


def test_after_a_start_the_coils_count_as_warm_as_they_may_be_for_use() -> None:
    assert UNKNOWN.shares == (ASSUMED_AT_START,) * 3
    assert ASSUMED_AT_START <= WARN_AT
    assert not UNKNOWN.after(1.0, REST, LIMITS).is_too_hot


@pytest.mark.parametrize("share", [-0.1, math.nan, math.inf])
@pytest.mark.parametrize("coil", [0, 1, 2])
def test_a_share_that_is_none_is_refused(share: float, coil: int) -> None:
    shares = [0.1, 0.1, 0.1]
    shares[coil] = share
    with pytest.raises(ValueError, match="share of its heat"):
        CoilHeat((shares[0], shares[1], shares[2]))


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_a_thermal_limit_that_limits_nothing_is_refused(value: float) -> None:
    with pytest.raises(ValueError, match="coil heat: continuous"):
        ThermalLimits((1.0, value, 1.0), (1.0, 1.0, 1.0))
    with pytest.raises(ValueError, match="coil heat: time_constants"):
        ThermalLimits((1.0, 1.0, 1.0), (1.0, 1.0, value))


@pytest.mark.parametrize("pair", PAPER_PAIRS, ids=lambda pair: pair.axis)
def test_the_rig_files_limits_are_the_estimate_of_the_assumed_windings(pair) -> None:
    continuous, constant = winding_estimate(pair)
    coil = "xyz".index(pair.axis)
    assert round(continuous, 1) == LimitsSection().continuous_A[coil]
    assert round(constant, -2) == LimitsSection().heat_time_constant_s[coil]


def test_the_estimate_of_the_x_pair_by_hand() -> None:
    """769 m of 5.17 mm2 wire weigh 36 kg, 13.7 kJ/K; two bundles of 52 mm square and 1.23 m around give 5.1 W/K."""
    continuous, constant = winding_estimate(PAPER_PAIRS[0])
    assert constant == pytest.approx(13.71e3 / 5.096, rel=0.01)
    assert 2.5 * continuous**2 == pytest.approx(5.096 * 40.0, rel=0.01)


def test_an_hour_of_the_standard_eight_only_warms_the_coils() -> None:
    """Mean squares of the standard eight at 10 mT and 25 degrees, measured in simulation over two minutes: 17, 35
    and 11 A^2. The y pair would come to 56 % in the end; standing for ever on 8 A of y alone is too much."""
    thermal = ThermalLimits(
        (*LimitsSection().continuous_A,),  # type: ignore[arg-type]
        (*LimitsSection().heat_time_constant_s,),  # type: ignore[arg-type]
    )
    load = tuple(math.sqrt(square) for square in (17.0, 35.0, 11.0))
    hour = COLD.after(3600.0, load, thermal)  # type: ignore[arg-type]
    assert max(hour.shares) == pytest.approx(0.46, abs=0.01)
    assert max(COLD.after(math.inf, load, thermal).shares) == pytest.approx(0.56, abs=0.01)  # type: ignore[arg-type]
    assert COLD.after(math.inf, (0.0, 8.0, 0.0), thermal).is_too_hot
    assert not COLD.after(3600.0, (0.0, 8.0, 0.0), thermal).is_too_hot
