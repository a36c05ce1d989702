"""The host's mirror of the board's field, against the board's twin at the end of its serial line."""

import itertools
import math
import random
from collections.abc import Iterator

import pytest

from control.coils import PAPER_PAIRS, CoilSet
from control.field_model import FieldModel
from control.link.conversion import Configuration, DriveCommand
from control.link.port import Link
from control.model import PIVOT_A, PIVOT_B, TURN, Pivot, wrap
from control.simulation.board import TwinBoard, Winding

TILT = math.radians(25.0)
RAMP = 0.05
SLEW = 0.010 / 0.3
CONFIGURATION = Configuration(
    current_limits=(8.0, 8.0, 8.0),
    dead_man=0.2,
    ramp=RAMP,
    field_slew=SLEW,
    resistances=(2.5, 2.0, 1.5),
    inductances=(0.125, 0.055, 0.014),
    supply=24.0,
    max_field=0.015,
    max_rate=6.3,
    max_tilt=math.radians(60.0),
)
_names = (f"field-model-{number}" for number in itertools.count())


class Bench:
    """A board on its line, driven the way the loop drives it."""

    def __init__(self) -> None:
        name = next(_names)
        x, y, z = (Winding(pair.resistance, pair.inductance) for pair in PAPER_PAIRS)
        self.board = TwinBoard(name, (x, y, z), 24.0)
        self.link = Link(f"sim://{name}", 500_000, CONFIGURATION, lambda: self.now)
        self.field = FieldModel(RAMP, SLEW)
        self.allocation = CoilSet().centre_allocation()
        self.link.open()
        while not self.link.is_ready:
            self.pass_time(10)
            self.link.poll()

    @property
    def now(self) -> float:
        return self.board.milliseconds / 1000

    def pass_time(self, milliseconds: int) -> None:
        self.board.advance(milliseconds)
        self.field.advance(self.now)

    def drive(self, pivot: Pivot, rate: float, goal: float, start: float | None = None) -> None:
        if start is not None:
            self.field.start(self.now, start, pivot, TILT, 0.010)
        self.field.command(pivot, TILT, rate, goal)
        self.link.drive(DriveCommand(pivot, rate, goal, TILT, 0.010, self.allocation, 0.15, start))

    def listen(self) -> float:
        """The board's own heading, and the mirror told of it."""
        telemetry = self.link.poll()
        assert telemetry is not None
        self.field.synchronise(telemetry.board_time, telemetry.received_at, telemetry.heading)
        return telemetry.heading

    def difference(self) -> float:
        return wrap(self.board.twin.motion.heading * TURN / 2**32 - self.field.heading)

    def close(self) -> None:
        self.link.close()
        self.board.close()


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.close()


@pytest.mark.parametrize("seed", range(5))
def test_the_mirror_points_where_the_board_points(bench: Bench, seed: int) -> None:
    chance = random.Random(seed)
    bench.drive(PIVOT_A, 0.0, 0.3, start=0.3)
    for _ in range(40):
        bench.pass_time(10)
        bench.link.poll()
        bench.drive(PIVOT_A, 0.0, 0.3)
    pivot: Pivot = PIVOT_A
    for _ in range(120):
        pivot = chance.choice((pivot, pivot, pivot, PIVOT_A, PIVOT_B))
        rate = chance.uniform(-2.0, 2.0)
        bench.drive(pivot, rate, bench.field.heading + chance.uniform(-0.5, 0.5))
        bench.pass_time(chance.choice((16, 17, 34)))
        bench.listen()
        assert abs(bench.difference()) < 2.0 * 0.005, "5 ms of transit and of ramp at 2 rad/s"
        assert bench.field.pivot == (PIVOT_A if bench.board.twin.motion.elevation < 0 else PIVOT_B)


def test_the_mirror_stops_exactly_on_its_goal(bench: Bench) -> None:
    bench.drive(PIVOT_A, 0.0, 0.0, start=0.0)
    for _ in range(40):
        bench.pass_time(10)
        bench.link.poll()
        bench.drive(PIVOT_A, 1.7, 0.35)
    assert bench.field.heading == 0.35
    assert bench.field.is_settled
    assert abs(bench.difference()) < 1e-8


def test_the_heading_is_held_while_the_elevation_ramps() -> None:
    field = FieldModel(RAMP, SLEW)
    field.start(0.0, 1.0, PIVOT_A, TILT, 0.010)
    field.advance(0.4)
    field.command(PIVOT_B, TILT, 2.0, 3.0)
    field.advance(0.4 + RAMP)
    assert field.heading == 1.0
    assert field.elevation == pytest.approx(TILT)
    field.advance(0.4 + RAMP + 0.1)
    assert field.heading == pytest.approx(1.2)


def test_the_pivot_changes_half_way_through_the_ramp() -> None:
    field = FieldModel(RAMP, SLEW)
    field.start(0.0, 0.0, PIVOT_A, TILT, 0.010)
    field.command(PIVOT_B, TILT, 0.0, 0.0)
    field.advance(0.49 * RAMP)
    assert field.pivot == PIVOT_A
    field.advance(0.51 * RAMP)
    assert field.pivot == PIVOT_B


def test_a_piece_of_motion_that_ends_before_the_ramp_has_passed_zero_presses_on_the_old_end() -> None:
    field = FieldModel(RAMP, SLEW)
    field.start(0.0, 0.0, PIVOT_A, TILT, 0.010)
    field.advance(0.4)
    field.command(PIVOT_B, TILT, 0.0, 0.0)
    field.advance(0.4 + RAMP)
    assert {turn.pivot for turn in field.turns(0.3, 0.4 + 0.49 * RAMP)} == {PIVOT_A}
    assert field.turns(0.3, 0.4 + 0.51 * RAMP)[-1].pivot == PIVOT_B


def test_pieces_of_motion_add_up_to_the_whole_whatever_the_interval() -> None:
    field = FieldModel(RAMP, SLEW)
    field.start(0.0, 0.0, PIVOT_A, TILT, 0.010)
    for tick in range(1, 40):
        field.command(PIVOT_A if tick % 20 < 10 else PIVOT_B, TILT, 1.5, 10.0)
        field.advance(tick / 60)
    cuts = [0.1, 0.13, 0.2, 0.34, 0.35, 0.6]
    pieces = [sum(turn.angle for turn in field.turns(*pair)) for pair in itertools.pairwise(cuts)]
    assert sum(pieces) == pytest.approx(field.heading_at(0.6) - field.heading_at(0.1), abs=1e-12)


def test_a_missed_command_shows_in_the_telemetry_and_the_mirror_follows(bench: Bench) -> None:
    bench.drive(PIVOT_A, 0.0, 0.0, start=0.0)
    for _ in range(40):
        bench.pass_time(10)
        bench.drive(PIVOT_A, 0.0, 0.0)
        bench.listen()
    bench.field.command(PIVOT_A, TILT, 2.0, 1.0)
    bench.pass_time(100)
    assert abs(bench.difference()) > 0.15
    bench.listen()
    assert abs(bench.difference()) < 0.03


TRANSIT = 0.0015
"""A report takes at least this long, s; the newest one is up to 10 ms older."""


@pytest.mark.parametrize("drift", [-0.005, -0.001, 0.0, 0.005])
@pytest.mark.parametrize("tick", [1.0 / 60.0, 1.0 / 15.0])
def test_the_time_of_a_report_is_known_although_the_boards_clock_is_no_quartz(
    drift: float, tick: float
) -> None:
    """An UNO's resonator is off by up to 0.5 %: 0.3 s in a minute."""
    field, worst = FieldModel(RAMP, SLEW), 0.0
    for number in range(1, round(120.0 / tick)):
        now = tick * number
        told = math.floor((now - TRANSIT) * 100.0) / 100.0
        field.advance(now)
        field.synchronise(told * (1.0 + drift), now, 0.0)
        if now > 5.0:
            worst = max(worst, abs(field.reported_at - told))
    assert worst < 0.010


def test_a_count_of_milliseconds_that_goes_round_is_followed() -> None:
    field = FieldModel(RAMP, SLEW)
    for number in range(200):
        now = 0.01 * number
        field.advance(now)
        field.synchronise((4_294_966.0 + now) % (2**32 / 1000), now + TRANSIT, 0.0)
        assert field.reported_at == pytest.approx(now + TRANSIT, abs=0.001)


def test_a_board_that_has_restarted_has_told_nothing_yet() -> None:
    field = FieldModel(RAMP, SLEW)
    assert field.reported_at == -math.inf
    field.synchronise(5.0, 7.0, 0.0)
    assert field.reported_at == 7.0
    field.forget_clock()
    assert field.reported_at == -math.inf
