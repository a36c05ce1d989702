"""What the board obeys, and that nothing else keeps its coils alive."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from board_bench import CALM, CONFIGURE, Bench

from control.link import wire
from control.link.messages import ARM, BoardCode, Configure, Drive, Flag, Hello, Refusal, Stop, Telemetry

ARMING = replace(CALM, flags=ARM)
NOMINAL = 446
"""What the ADC reads of 24 V."""


def milliseconds_until_zero(bench: Bench) -> int:
    for count in range(1, 1000):
        bench.run(1)
        if bench.board.drive_is_zero:
            return count
    raise AssertionError("the drive never became zero")


def test_a_board_boots_with_a_banner_and_zero_drive() -> None:
    bench = Bench()
    bench.run(3)
    assert bench.heard[0].sequence == 0
    assert bench.heard[0].boot_id == 7
    assert bench.board.state == BoardCode.BOOTED
    assert bench.board.drive_is_zero


def test_a_board_reports_only_once_it_has_been_greeted() -> None:
    bench = Bench()
    bench.run(100)
    assert not [p for p in bench.heard if isinstance(p.message, Telemetry)]
    bench.say(Hello())
    bench.run(100)
    assert len([p for p in bench.heard if isinstance(p.message, Telemetry)]) == 10


def test_a_configuration_is_answered_with_its_hash() -> None:
    bench = Bench().ready()
    assert bench.banners[-1].configuration_hash == wire.configuration_hash(CONFIGURE)
    assert bench.board.state == BoardCode.READY


@pytest.mark.parametrize("time_to_live", [20, 120, 199])
def test_a_time_to_live_zeroes_the_drive_in_the_tick_in_which_it_runs_out(time_to_live: int) -> None:
    bench = Bench().driving()
    bench.send(replace(CALM, time_to_live=time_to_live))
    bench.run(1)  # 49 bytes: arrives and counts its first tick
    assert milliseconds_until_zero(bench) == time_to_live - 1
    assert bench.board.state == BoardCode.EXPIRED


@pytest.mark.parametrize("time_to_live", [200, 201, 65535])
def test_the_dead_man_counts_where_it_is_shorter_than_the_time_to_live(time_to_live: int) -> None:
    bench = Bench().driving()
    bench.send(replace(CALM, time_to_live=time_to_live))
    bench.run(1)
    assert milliseconds_until_zero(bench) == CONFIGURE.dead_man - 1


@pytest.mark.parametrize(
    ("message", "header"),
    [
        pytest.param(CALM, {"sequence": 0}, id="stale"),
        pytest.param(CALM, {"boot_id": 8}, id="another boot"),
        pytest.param(CALM, {"version": 2}, id="another version"),
        pytest.param(replace(CALM, pivot=0), {}, id="pivot 0"),
        pytest.param(replace(CALM, pivot=2), {}, id="pivot 2"),
        pytest.param(replace(CALM, pivot=-128), {}, id="pivot -128"),
        pytest.param(replace(CALM, rate=CONFIGURE.max_rate + 1), {}, id="rate"),
        pytest.param(replace(CALM, rate=-CONFIGURE.max_rate - 1), {}, id="rate back"),
        pytest.param(replace(CALM, rate=-(2**31)), {}, id="rate smallest"),
        pytest.param(replace(CALM, tilt=CONFIGURE.max_tilt + 1), {}, id="tilt"),
        pytest.param(replace(CALM, field=CONFIGURE.max_field + 1), {}, id="field"),
        pytest.param(replace(CALM, time_to_live=0), {}, id="no life"),
        pytest.param(replace(CALM, flags=2), {}, id="unknown flag"),
        pytest.param(CONFIGURE, {}, id="configure while driving"),
        pytest.param(replace(CALM, flags=ARM, pivot=5), {}, id="bad arm edge"),
    ],
)
def test_a_drive_that_is_refused_does_not_renew_the_life(message: Drive | Configure, header: dict) -> None:
    bench = Bench().driving()
    bench.send(CALM)
    bench.run(100)
    number = bench.sequence
    bench.send(message, **{"sequence": (number + 1) % 65536, **header})
    assert milliseconds_until_zero(bench) == CONFIGURE.dead_man - 100
    bench.run(20)
    report = bench.telemetry
    assert report.stale + report.refused + report.bad == 1


def test_values_at_their_limits_are_obeyed() -> None:
    bench = Bench().driving()
    for changes in (
        {"rate": CONFIGURE.max_rate},
        {"rate": -CONFIGURE.max_rate},
        {"tilt": CONFIGURE.max_tilt},
        {"tilt": 0},
        {"field": CONFIGURE.max_field},
        {"field": 0},
        {"time_to_live": 1000},
    ):
        bench.say(replace(CALM, **changes))
    bench.run(20)
    assert bench.telemetry.refused == 0
    assert bench.telemetry.last_sequence == bench.sequence


def test_a_message_that_comes_twice_is_obeyed_once() -> None:
    bench = Bench().driving()
    number = bench.send(CALM)
    bench.run(100)
    bench.send(CALM, sequence=number)
    assert milliseconds_until_zero(bench) == CONFIGURE.dead_man - 100


@pytest.mark.parametrize(
    ("ahead", "obeyed"), [(1, True), (2, True), (1000, True), (1001, False), (40000, False), (65535, False)]
)
def test_a_sequence_number_may_run_ahead_by_a_thousand_and_never_back(ahead: int, obeyed: bool) -> None:
    bench = Bench().driving()
    before = bench.sequence
    bench.say(CALM, sequence=(before + ahead) % 65536)
    bench.run(20)
    assert (bench.telemetry.last_sequence != before) is obeyed
    assert bench.telemetry.stale == (0 if obeyed else 1)


def test_sequence_numbers_go_round() -> None:
    bench = Bench()
    bench.sequence = 65500
    bench.driving()
    assert bench.sequence < 65500
    assert bench.board.state == BoardCode.DRIVING
    assert bench.telemetry.stale == 0


@pytest.mark.parametrize("how", ["ready", "stopped", "expired"])
def test_only_an_arm_edge_leaves_rest(how: str) -> None:
    bench = Bench().ready() if how == "ready" else Bench().driving()
    if how == "stopped":
        bench.stop()
    bench.run(300)
    before = bench.board.state
    bench.say(CALM)
    bench.run(20)
    assert bench.board.state == before
    assert bench.telemetry.last_refusal == Refusal.STATE
    bench.say(ARMING)
    bench.run(20)
    assert bench.board.state == BoardCode.DRIVING
    assert not bench.board.drive_is_zero


def test_a_refused_arm_edge_cannot_be_replayed() -> None:
    bench = Bench()
    bench.say(Hello())
    number = bench.send(ARMING)
    bench.run(2)
    bench.say(CONFIGURE)
    bench.say(ARMING, sequence=number)
    assert bench.board.state == BoardCode.READY


def test_a_board_that_was_not_greeted_takes_no_configuration() -> None:
    bench = Bench()
    bench.say(CONFIGURE)
    bench.say(ARMING)
    assert bench.board.state == BoardCode.BOOTED


def test_a_board_without_configuration_does_not_arm() -> None:
    bench = Bench()
    bench.say(Hello())
    bench.say(ARMING)
    assert bench.board.state == BoardCode.BOOTED


@pytest.mark.parametrize("header", [{}, {"sequence": 0}, {"boot_id": 4711}])
def test_a_stop_always_works(header: dict) -> None:
    bench = Bench().driving()
    bench.send(Stop(), **header)
    bench.run(1)
    assert bench.board.drive_is_zero
    assert bench.board.state == BoardCode.STOPPED


def test_a_hello_zeroes_and_restarts_the_numbers() -> None:
    bench = Bench().driving()
    bench.say(Hello(), sequence=30000)
    assert bench.board.drive_is_zero
    assert bench.board.state == BoardCode.READY
    bench.say(ARMING)
    assert bench.board.state == BoardCode.DRIVING


def test_a_hello_in_another_version_is_answered_and_changes_nothing() -> None:
    bench = Bench().driving()
    banners = len(bench.banners)
    bench.say(Hello(), version=2)
    bench.run(2)
    assert len(bench.banners) == banners + 1
    assert bench.board.state == BoardCode.DRIVING


@pytest.mark.parametrize(
    "changes",
    [
        {"current_limits": (0, 8000, 8000)},
        {"current_limits": (8000, 8000, 12001)},
        {"dead_man": 9},
        {"dead_man": 501},
        {"ramp": 0},
        {"ramp": 1001},
        {"field_slew": 0},
        {"resistances": (2500, 99, 1500)},
        {"inductances": (12500, 5500, 299), "resistances": (2500, 2000, 100)},
        {"inductances": (12500, 5500, 749)},
        {"inductances": (16001, 5500, 1400)},
        {"supply": 4999},
        {"max_field": 32768},
        {"max_rate": 0x10000000},
        {"max_tilt": 10924},
        {"sense_gains": (8929, 8929, 8929, 8929, 8929, 4463)},
        {"sense_gains": (11162, 8929, 8929, 8929, 8929, 8929)},
        {"supply_scale": 65001},
    ],
)
def test_a_configuration_outside_the_arithmetic_is_refused_whole(changes: dict) -> None:
    bench = Bench()
    bench.say(Hello())
    bench.say(replace(CONFIGURE, **changes))
    bench.run(20)
    assert bench.board.state == BoardCode.BOOTED
    assert bench.telemetry.last_refusal == Refusal.CONFIGURATION


def test_over_current_latches_until_the_board_is_greeted_and_configured() -> None:
    bench = Bench().driving()
    twin = bench.board.twin
    for _ in range(2):
        twin.tick((300, 0, 0), NOMINAL)
    assert twin.state == BoardCode.DRIVING
    twin.tick((300, 0, 0), NOMINAL)
    assert twin.duty == (0, 0, 0)
    for message in (CALM, ARMING, Stop(), CONFIGURE):
        bench.say(message)
        assert bench.board.state == BoardCode.FAULT
    bench.run(20)
    assert bench.telemetry.flags & Flag.OVER_CURRENT
    bench.say(Hello())
    bench.say(ARMING)
    assert bench.board.state == BoardCode.BOOTED
    bench.say(CONFIGURE)
    bench.say(ARMING)
    assert bench.board.state == BoardCode.DRIVING


def test_a_driver_fault_zeroes_all_bridges_at_once() -> None:
    bench = Bench().driving()
    bench.board.twin.driver_fault = True
    bench.run(1)
    assert bench.board.drive_is_zero
    bench.run(20)
    assert bench.telemetry.flags & Flag.DRIVER_FAULT


def test_a_reset_board_has_a_new_boot_id_and_obeys_nothing_of_the_old_one() -> None:
    bench = Bench().driving()
    bench.board.reset()
    bench.run(3)
    assert bench.board.twin.boot_id == 8
    bench.say(ARMING, boot_id=7)
    assert bench.board.state == BoardCode.BOOTED
    assert bench.board.drive_is_zero


@pytest.mark.parametrize("seed", range(4))
def test_random_bytes_never_crash_the_board_nor_drive_it(seed: int) -> None:
    source = random.Random(seed)
    bench = Bench().ready()
    for _ in range(200):
        bench.board.write(source.randbytes(100))
        bench.run(2)
        assert bench.board.drive_is_zero
    bench.board.write(b"\0")
    bench.say(ARMING)
    assert bench.board.state == BoardCode.DRIVING


def test_garbage_while_driving_does_not_renew_the_life() -> None:
    source = random.Random(5)
    bench = Bench().driving()
    bench.send(CALM)
    bench.run(1)
    for _ in range(CONFIGURE.dead_man):
        bench.board.write(source.randbytes(50))
        bench.run(1)
    assert bench.board.state == BoardCode.EXPIRED


def test_only_a_driving_board_has_a_duty() -> None:
    """A random walk through all messages; the invariant holds after every millisecond."""
    source = random.Random(11)
    bench = Bench()
    choices = [Hello(), CONFIGURE, CALM, CALM, CALM, ARMING, ARMING, Stop()]
    seen = set()
    for _ in range(400):
        bench.send(source.choice(choices))
        if source.random() < 0.02:
            bench.board.twin.driver_fault = source.random() < 0.5
        for _ in range(source.choice((1, 3, 30, 250) if source.random() < 0.1 else (1, 3, 10))):
            bench.run(1)
            seen.add(bench.board.state)
            assert bench.board.drive_is_zero or bench.board.state == BoardCode.DRIVING
    assert seen == set(BoardCode)


def test_the_same_bytes_give_the_same_bytes() -> None:
    def life() -> tuple[list[wire.Packet], list[tuple[float, float, float]]]:
        bench = Bench().driving()
        bench.turn(0.4, 1.5)
        return bench.heard, bench.board.advance(250)

    assert life() == life()
