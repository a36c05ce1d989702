"""What the board makes of a drive: heading, elevation, strength, currents."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from board_bench import ARM, CALM, CONFIGURE, ONE, TILT, Bench
from hypothesis import given, settings
from hypothesis import strategies as st

from control.link.conversion import heading_from, phase, phase_rate
from control.link.messages import BoardCode
from control.simulation.fixed_point import SINE, sine
from control.simulation.motion import FieldMotion

LIMIT = 8.0
TOLERANCE = 0.015 * LIMIT


def motion_of(bench: Bench) -> FieldMotion:
    return bench.board.twin.motion


def test_the_sine_is_within_two_units_and_odd_and_even_as_it_should_be() -> None:
    for angle in range(0, 65536, 7):
        assert SINE[angle] == sine(angle)
        assert abs(SINE[angle] - 32767 * math.sin(angle * math.pi / 32768)) < 2.0
        assert SINE[-angle & 65535] == -SINE[angle]
        assert SINE[(32768 - angle) & 65535] == SINE[angle]


@pytest.mark.parametrize("goal", [0.3, -0.3, 1e-9, 3.0, -3.0])
def test_the_heading_stops_exactly_on_its_goal_from_both_sides(goal: float) -> None:
    bench = Bench().driving()
    rate = math.copysign(2.0, goal)
    for _ in range(170):
        bench.turn(goal, rate)
        bench.run(8)
    assert motion_of(bench).heading == phase(goal)
    bench.turn(0.0, -rate)
    for _ in range(170):
        bench.turn(0.0, -rate)
        bench.run(8)
    assert motion_of(bench).heading == 0


def test_the_heading_crosses_the_seam_of_the_turn() -> None:
    bench = Bench().driving(start=math.pi - 0.05)
    for _ in range(12):
        bench.turn(math.pi + 0.05, 1.0)
        bench.run(8)
    assert motion_of(bench).heading == phase(math.pi + 0.05)


def test_a_goal_that_lies_behind_means_standing_still() -> None:
    bench = Bench().driving()
    bench.turn(-0.2, 1.0)
    bench.run(100)
    assert motion_of(bench).heading == 0


def test_a_heading_moves_by_its_rate_each_millisecond() -> None:
    bench = Bench().driving()
    bench.turn(1.0, 1.25)
    before = motion_of(bench).heading
    bench.run(100)
    assert motion_of(bench).heading - before == 100 * phase_rate(1.25)
    assert heading_from(100 * phase_rate(1.25)) == pytest.approx(0.125, rel=1e-6)


def test_a_pivot_switch_takes_the_ramp_and_holds_the_heading_meanwhile() -> None:
    bench = Bench().driving()
    motion = motion_of(bench)
    assert motion.elevation == -TILT << 16
    bench.send(replace(CALM, pivot=-1, heading_goal=phase(0.5), rate=phase_rate(1.0)))
    ticks = 0
    while motion.elevation != TILT << 16:
        assert motion.heading == 0
        bench.run(1)
        ticks += 1
    assert ticks == CONFIGURE.ramp
    bench.run(10)
    assert motion.heading == 10 * phase_rate(1.0)


@pytest.mark.parametrize("ramp", [1, 7, 50, 150])
def test_the_elevation_slews_evenly_over_the_configured_ramp(ramp: int) -> None:
    motion = FieldMotion()
    motion.configure(ramp, 100)
    motion.start(CALM)
    motion.follow(replace(CALM, pivot=-1))
    seen = []
    for _ in range(ramp):
        motion.advance()
        seen.append(motion.elevation)
    assert seen[-1] == TILT << 16
    ideal = [(-TILT + 2 * TILT * (k + 1) / ramp) * 65536 for k in range(ramp)]
    assert all(abs(s - i) <= 0.01 * TILT * 65536 for s, i in zip(seen, ideal, strict=True))


@given(
    st.lists(
        st.tuples(st.sampled_from((1, -1)), st.integers(0, 10923), st.integers(0, 200)),
        min_size=1,
        max_size=12,
    )
)
@settings(max_examples=50, deadline=None, derandomize=True)
def test_the_elevation_always_arrives_and_stays_within_32_bits(orders: list[tuple[int, int, int]]) -> None:
    motion = FieldMotion()
    motion.configure(50, 100)
    motion.start(CALM)
    for pivot, tilt, wait in orders:
        motion.follow(replace(CALM, pivot=pivot, tilt=tilt))
        for _ in range(wait):
            motion.advance()
            assert abs(motion.elevation) <= 10923 << 16
    for _ in range(101):
        motion.advance()
    pivot, tilt, _ = orders[-1]
    assert motion.elevation == (-pivot * tilt) << 16


def test_the_field_ramps_up_from_zero_at_an_arm_edge() -> None:
    bench = Bench().ready()
    bench.send(replace(CALM, flags=ARM, start_heading=phase(1.0), heading_goal=phase(1.0)))
    bench.run(1)
    strengths = []
    for _ in range(30):
        bench.send(replace(CALM, heading_goal=phase(1.0)))
        bench.run(10)
        strengths.append(motion_of(bench).magnitude / 256)
    assert strengths[0] == pytest.approx(10 * 10000 / 300, rel=0.15)
    assert strengths[-1] == pytest.approx(10000, rel=0.005)
    assert motion_of(bench).heading == phase(1.0)


def test_an_arm_edge_while_driving_starts_from_zero_field() -> None:
    bench = Bench().driving()
    bench.send(replace(CALM, flags=ARM, start_heading=phase(2.0)))
    bench.run(1)
    assert motion_of(bench).magnitude / 256 < 50


@pytest.mark.parametrize("degrees", [0, 33, 90, 145, 180, 250, 315])
@pytest.mark.parametrize("pivot", [1, -1])
def test_the_currents_settle_on_the_field_that_presses_the_pivot_down(degrees: int, pivot: int) -> None:
    """B = |B| [cos e cos phi, cos e sin phi, sin e], phi = heading + 90 deg, e = -pivot * tilt (paper)."""
    heading, tilt = math.radians(degrees), math.radians(25.0)
    bench = Bench().driving(start=heading, pivot=pivot)
    azimuth = heading + 0.5 * math.pi
    asked = (
        LIMIT * math.cos(tilt) * math.cos(azimuth),
        LIMIT * math.cos(tilt) * math.sin(azimuth),
        -pivot * LIMIT * math.sin(tilt),
    )
    for current, wish in zip(bench.board.currents, asked, strict=True):
        assert abs(current - wish) <= TOLERANCE


def test_the_currents_follow_a_turning_field() -> None:
    """2 rad/s of 10 mT: 16 A/s, of which the slowest coil needs 2 V above its R I."""
    bench = Bench().driving(tilt=0)
    worst = 0.0
    for k in range(200):
        bench.turn(0.04 * (k + 2), 2.0, tilt=0)
        bench.run(14)
        heading = heading_from(motion_of(bench).heading)
        x, y, _ = bench.board.currents
        worst = max(worst, abs(x + LIMIT * math.sin(heading)), abs(y - LIMIT * math.cos(heading)))
    assert bench.board.state == BoardCode.DRIVING
    assert worst <= TOLERANCE


def test_the_currents_follow_a_change_of_strength() -> None:
    bench = Bench().driving()
    bench.say(replace(CALM, field=5000))
    for _ in range(20):
        bench.say(replace(CALM, field=5000))
        bench.run(8)
    assert bench.board.currents[1] == pytest.approx(0.5 * LIMIT * math.cos(math.radians(25)), abs=TOLERANCE)


@pytest.mark.parametrize("supply", [22.5, 24.0, 26.0])
@pytest.mark.parametrize("warmth", [0.9, 1.0, 1.12])
def test_the_currents_settle_with_another_supply_and_another_copper_temperature(
    supply: float, warmth: float
) -> None:
    """1.12 times the resistance is copper 30 K warmer than when it was measured."""
    bench = Bench(warmth=warmth)
    bench.board.supply = supply
    bench.driving(start=0.7)
    x, y, _ = bench.board.currents
    level = LIMIT * math.cos(math.radians(25))
    assert abs(x + level * math.sin(0.7)) <= TOLERANCE
    assert abs(y - level * math.cos(0.7)) <= TOLERANCE


def test_saturation_keeps_the_direction_of_the_field() -> None:
    bench = Bench().driving(start=0.5, field=15000)
    bench.run(20)
    report = bench.telemetry
    assert report.flags & 8
    assert max(abs(current) for current in report.commanded) <= 8000
    tilt, level = math.radians(25), math.cos(math.radians(25))
    direction = (-level * math.sin(0.5), level * math.cos(0.5), -math.sin(tilt))
    length = math.dist(report.commanded, (0, 0, 0))
    for current, wish in zip(report.commanded, direction, strict=True):
        assert current / length == pytest.approx(wish, abs=5e-4)


def test_a_saturated_command_reaches_the_limit_of_the_coil_that_needs_most() -> None:
    bench = Bench().driving(field=20000, allocation=(ONE, 0, 0, 0, ONE, 0, 0, 0, ONE // 2))
    assert max(abs(current) for current in bench.telemetry.commanded) >= 7998


@given(
    st.tuples(*[st.integers(-32768, 32767)] * 9),
    st.integers(0, 32767),
    st.integers(0, 2**32 - 1),
    st.integers(0, 10923),
)
@settings(max_examples=150, deadline=None, derandomize=True)
def test_no_command_exceeds_a_limit(allocation: tuple, field: int, heading: int, tilt: int) -> None:
    bench = Bench()
    bench.ready()
    bench.say(replace(CONFIGURE, max_field=32767, field_slew=65535, current_limits=(8000, 3000, 1)))
    drive = replace(CALM, allocation=allocation, field=field, start_heading=heading, tilt=tilt, flags=ARM)
    bench.say(drive)
    bench.run(1)
    commanded = bench.board.twin.coils.commanded
    assert all(abs(i) <= limit for i, limit in zip(commanded, (8000, 3000, 1), strict=True))
    assert all(abs(d) <= steps for d, steps in zip(bench.board.duty, (800, 800, 100), strict=True))


def test_the_report_shows_currents_duty_and_supply() -> None:
    bench = Bench().driving()
    bench.run(20)
    report = bench.telemetry
    for sensed, commanded in zip(report.measured, report.commanded, strict=True):
        assert abs(sensed - commanded) <= 1000 * TOLERANCE + 35
    assert report.supply == pytest.approx(24000, abs=54)  # one count
    assert report.duty[1] / 32768 * 24.0 == pytest.approx(2.0 * report.commanded[1] * 1e-3, abs=0.5)
    assert report.elevation == -TILT


def test_a_supply_that_fails_is_reported_and_the_sensed_current_goes() -> None:
    bench = Bench().driving()
    bench.board.supply = 0.0
    for _ in range(25):
        bench.say(CALM)
        bench.run(10)
    report = bench.telemetry
    assert report.flags & 4
    assert report.supply == 0
    assert all(abs(sensed) < 100 for sensed in report.measured)
    assert abs(report.commanded[1]) > 7000
