"""The C++ core does what the twin does, byte for byte and step for step, in one exchange of each kind."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from twins import ARMING, CALM, CONFIGURE, NOMINAL, Twins

from control.link import messages, wire
from control.link.conversion import phase, phase_rate
from control.link.messages import BoardCode, Flag, Hello, ResetCause, Stop

DEAD_SUPPLY = 0
FULL = 1023


def walk(twins: Twins, ticks: int, **changes: Any) -> None:
    """Commands at 60 Hz with these values."""
    for _ in range(ticks):
        twins.say(replace(CALM, **changes))
        twins.run(16)


def test_a_boot_is_announced_with_its_cause() -> None:
    for cause in ResetCause:
        with Twins(0xFFFF, cause) as twins:
            twins.drain()
            [packet] = twins.words(twins.heard)
            assert isinstance(packet.message, messages.Banner)
            assert (packet.boot_id, packet.message.reset_cause) == (0xFFFF, cause)


def test_a_walk_with_sweeps_both_ways_and_pivot_switches(driving: Twins) -> None:
    for pivot, rate in ((1, 1.5), (-1, -1.5), (1, 0.0), (-1, 2.0)):
        walk(driving, 30, pivot=pivot, rate=phase_rate(rate), heading_goal=phase(math.copysign(0.5, rate)))
    assert driving.twin.state == BoardCode.DRIVING
    headings = {report.heading for report in driving.reports}
    elevations = {report.elevation for report in driving.reports}
    assert len(headings) > 40
    assert {-4551, 4551} < elevations


def test_a_goal_that_lies_behind_means_standing_still(driving: Twins) -> None:
    for rate in (1.0, -1.0):
        walk(driving, 5, rate=phase_rate(rate), heading_goal=phase(-0.5 * rate))
        assert driving.twin.motion.heading == 0


def test_a_field_beyond_the_coils_is_scaled_back(driving: Twins) -> None:
    allocation = (16384, 3000, -2000, 500, -16384, 0, 32767, -32768, 32767)
    for heading in (0.0, 0.9, 2.0, -2.5):
        driving.say(replace(ARMING, start_heading=phase(heading), field=20000, allocation=allocation))
        driving.run(1)
        for _ in range(8):
            driving.say(replace(CALM, heading_goal=phase(heading), field=20000, allocation=allocation))
            driving.run(40)
        assert driving.reports[-1].flags & Flag.SATURATED
        assert driving.reports[-1].duty != (0, 0, 0)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_full_duty_is_reported_as_such(twins: Twins, sign: int) -> None:
    """The strongest slew of the field: a coil that is told to be large wants more than the supply.

    What remains of a step makes it 799 or 800 of 800.
    """
    twins.say(Hello())
    twins.say(replace(CONFIGURE, field_slew=65535, inductances=(16000, 16000, 16000)))
    allocation = tuple(sign * entry for entry in CALM.allocation)
    twins.say(replace(ARMING, tilt=0, allocation=allocation))
    twins.run(60)
    assert max(sign * report.duty[1] for report in twins.reports) >= 799 * 32768 // 800 - 8


@pytest.mark.parametrize("shares", [(3, 2, 1), (1, 2, 3), (2, 3, 1)])
def test_the_coil_that_is_farthest_beyond_its_limit_scales_all_three(twins: Twins, shares: Any) -> None:
    """One coil after the other is a little, more and most beyond its limit."""
    one, two, three = (2000 // share for share in shares)
    twins.say(Hello())
    twins.say(replace(CONFIGURE, current_limits=(one, two, three)))
    allocation = (*(0, 16384, 0), *(0, 16384, 0), *(0, 16384, 0))
    twins.say(replace(ARMING, tilt=0, allocation=allocation, time_to_live=200))
    twins.run(199)
    largest = max(shares)
    for current, limit, share in zip(twins.reports[-1].commanded, (one, two, three), shares, strict=True):
        assert current == pytest.approx(limit * share / largest, abs=8)


@pytest.mark.parametrize("sign", [1, -1])
def test_the_strongest_field_and_allocation_are_scaled_back_too(twins: Twins, sign: int) -> None:
    """Each coil is asked for more than 100 A, as far as the numbers go; a share has 14 bits."""
    twins.say(Hello())
    twins.say(replace(CONFIGURE, max_field=32767, field_slew=65535))
    allocation = (sign * 32767,) * 9
    changes = {"pivot": -1, "field": 32767, "tilt": 6400, "heading_goal": phase(-math.pi / 4)}
    twins.say(replace(ARMING, start_heading=phase(-math.pi / 4), allocation=allocation, **changes))
    twins.run(149)
    assert twins.reports[-1].commanded == pytest.approx((sign * 8000,) * 3, abs=8)


def test_a_command_that_is_not_renewed_expires(driving: Twins) -> None:
    driving.say(replace(CALM, time_to_live=1))
    driving.run(1)
    assert driving.twin.state == BoardCode.EXPIRED
    driving.say(ARMING)
    driving.say(replace(CALM, time_to_live=65535))
    driving.run(199)
    assert driving.twin.state == BoardCode.DRIVING
    driving.run(1)
    assert driving.twin.state == BoardCode.EXPIRED


@pytest.mark.parametrize("place", [0, 1, 2])
def test_over_current_in_any_coil_latches(driving: Twins, place: int) -> None:
    high = tuple(FULL if coil == place else 0 for coil in range(3))
    for _ in range(2):
        driving.tick(high)  # type: ignore[arg-type]
    driving.tick((0, 0, 0))
    for _ in range(2):
        driving.tick(high)  # type: ignore[arg-type]
    assert driving.twin.state == BoardCode.DRIVING
    driving.tick(high)  # type: ignore[arg-type]
    assert driving.twin.state == BoardCode.FAULT
    for message in (CALM, ARMING, Stop(), CONFIGURE):
        driving.say(message)
    driving.run(20)
    assert driving.reports[-1].flags & Flag.OVER_CURRENT
    driving.say(Hello())
    driving.run(20)
    assert not driving.reports[-1].flags & Flag.OVER_CURRENT
    assert driving.reports[-1].configuration_hash == 0


def test_a_driver_fault_latches_while_driving_and_not_otherwise(ready: Twins) -> None:
    ready.set_driver_fault(True)
    ready.run(20)
    assert ready.twin.state == BoardCode.READY
    ready.say(ARMING)
    ready.run(20)
    assert ready.twin.state == BoardCode.FAULT
    assert ready.reports[-1].flags & Flag.DRIVER_FAULT


def test_a_stop_is_obeyed_whatever_its_numbers(driving: Twins) -> None:
    driving.say(Stop(), sequence=65531, boot_id=99)
    assert driving.twin.state == BoardCode.STOPPED
    driving.run(30)
    assert driving.reports[-1].last_sequence == driving.twin._last_sequence


def test_a_stop_before_the_first_configuration_changes_nothing(twins: Twins) -> None:
    twins.say(Stop())
    assert twins.twin.state == BoardCode.BOOTED


@pytest.mark.parametrize("scale", [0, 1, 55000, 65000])
def test_the_supply_goes_up_and_down(twins: Twins, scale: int) -> None:
    twins.say(Hello())
    twins.say(replace(CONFIGURE, supply_scale=scale))
    twins.say(ARMING)
    for count in (NOMINAL, NOMINAL, 300, 335, 336, DEAD_SUPPLY, 1, FULL, NOMINAL):
        twins.say(CALM)
        for _ in range(12):
            twins.tick((50, 20, 10), count)
    assert bool(twins.reports[-1].flags & Flag.SUPPLY_ASSUMED) == (scale == 0)
    assert (twins.reports[-1].supply == 0) == (scale <= 1)


def test_a_sense_that_reads_full_scale_or_nothing_at_all(driving: Twins) -> None:
    """What it reports fits 16 bits although a full reading is 35.7 A."""
    driving.say(Stop())
    for counts in ((FULL, FULL, FULL), (0, 0, 0), (1, 2, 3)):
        for _ in range(30):
            driving.tick(counts)
    assert any(report.measured[0] == 32767 for report in driving.reports)


def test_currents_of_both_directions_are_measured_with_their_own_gains(twins: Twins) -> None:
    twins.say(Hello())
    twins.say(replace(CONFIGURE, sense_gains=(4464, 11161, 11161, 4464, 8929, 7000)))
    for sign in (1, -1):
        twins.say(replace(ARMING, start_heading=phase(0.7 * sign), heading_goal=phase(0.7 * sign), tilt=2000))
        for _ in range(20):
            twins.say(replace(CALM, heading_goal=phase(0.7 * sign), tilt=2000))
            twins.run(16)
        assert twins.twin.state == BoardCode.DRIVING
    assert any(report.measured[0] < 0 for report in twins.reports)
    assert any(report.measured[0] > 0 for report in twins.reports)


def test_a_reset_begins_anew_with_the_next_boot_id(driving: Twins) -> None:
    with Twins(8, ResetCause.WATCHDOG) as after:
        after.say(ARMING, sequence=driving.sequence + 1, boot_id=7)
        after.run(30)
        assert after.twin.state == BoardCode.BOOTED
        assert not after.reports


@pytest.mark.parametrize(("nominal", "is_low"), [(28645, False), (28646, False), (28647, True)])
def test_a_supply_of_three_quarters_is_not_yet_low(twins: Twins, nominal: int, is_low: bool) -> None:
    """400 counts are 21 484 mV, three quarters of 28 646 mV."""
    twins.say(Hello())
    twins.say(replace(CONFIGURE, supply=nominal))
    for _ in range(20):
        twins.tick((0, 0, 0), 400)
    assert bool(twins.reports[-1].flags & Flag.SUPPLY_LOW) is is_low


def test_another_nominal_supply_counts_although_the_sensed_one_stays(driving: Twins) -> None:
    """A weak supply is believed down to half of the nominal one."""
    for nominal in (12000, 48000, 20000):
        driving.say(Stop())
        driving.say(replace(CONFIGURE, supply=nominal))
        driving.say(ARMING)
        for _ in range(100):
            driving.tick((0, 0, 0), 180)
        assert driving.twin.state == BoardCode.DRIVING


@pytest.mark.parametrize("banners", range(19))
@pytest.mark.parametrize("taken", range(0, 16, 3))
def test_every_fill_of_the_transmit_buffer_drops_whole_messages(
    twins: Twins, banners: int, taken: int
) -> None:
    """Every fill of the buffer that banners, reports and a slow line can make."""
    twins.say(Hello())
    for number in range(banners):
        greeting = wire.encode(Hello(), number + 2, twins.boot_id)
        twins.twin.receive(greeting)
        twins.core.receive(greeting)
    twins.drain(taken)
    for _ in range(60):
        twins.tick((0, 0, 0), most=0)
    twins.drain()
    twins.run(20)
    assert twins.reports


@pytest.mark.parametrize("goal", [0, 1, 2, 3, 5, 25])
@pytest.mark.parametrize("rate", [1, 2, 3, 7])
@pytest.mark.parametrize("sense", [1, -1])
def test_the_slowest_rates_arrive_exactly_at_the_nearest_goals(
    driving: Twins, goal: int, rate: int, sense: int
) -> None:
    """In units of 2^-32 turn and of that a millisecond."""
    for _ in range(6):
        driving.say(replace(CALM, rate=sense * rate, heading_goal=sense * goal % 2**32))
        driving.run(10)
    assert driving.reports[-1].heading == sense * goal % 2**32


@pytest.mark.parametrize("ramp", [1, 2, 3, 17, 64, 128, 255, 256, 257, 999, 1000])
def test_a_pivot_switch_takes_its_ramp_whatever_that_is(twins: Twins, ramp: int) -> None:
    twins.say(Hello())
    twins.say(replace(CONFIGURE, ramp=ramp))
    twins.say(ARMING)
    twins.run(3)
    for _ in range(ramp // 50 + 2):
        twins.say(replace(CALM, pivot=-1))
        twins.run(50)
    assert twins.reports[-1].elevation == 4551


@pytest.mark.parametrize("tilt", [0, 1, 2, 3])
def test_the_smallest_tilts_switch_too(driving: Twins, tilt: int) -> None:
    for pivot in (1, -1, 1):
        for _ in range(4):
            driving.say(replace(CALM, pivot=pivot, tilt=tilt))
            driving.run(50)
        assert driving.reports[-1].elevation == -pivot * tilt


@pytest.mark.parametrize(("inductance", "resistance"), [(2121, 400), (3041, 400), (2120, 400), (1000, 1280)])
def test_the_model_of_a_coil_is_rounded_down_at_the_edge_too(
    driving: Twins, inductance: int, resistance: int
) -> None:
    """6 553 601 is 2141 times 3061: where the quotient of 6 553 600 is nearly one more."""
    driving.say(Stop())
    driving.say(replace(CONFIGURE, inductances=(inductance,) * 3, resistances=(resistance,) * 3))
    driving.say(ARMING)
    walk(driving, 30, rate=phase_rate(1.5), heading_goal=phase(1.0))
    assert driving.twin.state == BoardCode.DRIVING
