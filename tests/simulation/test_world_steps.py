"""The world moves in whole milliseconds, and only the currents that the board gives move the robot."""

import math

import pytest

from control.coils import CoilSet, command_field, currents_for
from control.model import PIVOT_A, PIVOT_B, Pivot, Pose
from control.simulation.plants import PlantChoice, build_plant
from control.simulation.world import LONGEST_ADVANCE, World
from control.snapshot import ZERO, Vector

COILS = CoilSet()
START = Pose(0.03, -0.02, 0.4)
TILT = math.radians(25.0)


def walking_currents(milliseconds: int) -> list[Vector]:
    """Currents of a walk with sweeps of 0.3 rad, a switch each 200 ms, by the centre's allocation."""
    currents = []
    for index in range(milliseconds):
        number, within = divmod(index, 200)
        pivot: Pivot = PIVOT_A if number % 2 == 0 else PIVOT_B
        share = min(within / 150.0, 1.0)
        heading = START.heading + pivot * 0.15 * (2.0 * share - 1.0)
        currents.append(currents_for(COILS.centre_allocation(), command_field(pivot, heading, TILT, 0.01)))
    return currents


class ScriptedBoard:
    """A board that has its currents written down, one triple a millisecond, and zero after them."""

    def __init__(self, script: list[Vector]):
        self.script = script
        self.asked: list[int] = []
        self.closed = False

    def advance(self, milliseconds: int) -> list[Vector]:
        done = sum(self.asked)
        self.asked.append(milliseconds)
        part = self.script[done : done + milliseconds]
        return part + [ZERO] * (milliseconds - len(part))

    def set_condition(self, name: str, value: int, coil: int | None = None) -> None:
        raise AssertionError(f"a script has no electrics: {name}={value} {coil}")

    def reset(self) -> None:
        raise AssertionError("a script does not boot")

    def close(self) -> None:
        self.closed = True


class ShortBoard(ScriptedBoard):
    """A board that loses a millisecond."""

    def advance(self, milliseconds: int) -> list[Vector]:
        return super().advance(milliseconds)[1:]


def world_of(script: list[Vector], plant: str = "slip", start_time: float = 0.0) -> World:
    return World(
        ScriptedBoard(script), build_plant(PlantChoice(plant), 0.01, START, seed=2), COILS, start_time
    )


def test_time_passes_in_whole_milliseconds():
    world = world_of([])
    for time in (0.0, 0.0004, 0.0099, 0.029, 1.0 / 60.0, 0.35, 0.3):
        before = world.now
        world.advance_to(time)
        assert world.now == max(before, math.floor(time * 1000 + 1e-6) / 1000)


def test_a_world_may_start_at_any_time():
    world = world_of([], start_time=98765.4321)
    world.advance_to(98765.4321 + 0.25)
    assert world.now == pytest.approx(98765.6821, abs=1e-9)
    world.advance_to(0.0)
    assert world.now == pytest.approx(98765.6821, abs=1e-9)


@pytest.mark.parametrize("time", [math.nan, math.inf, -math.inf])
def test_a_time_that_is_not_finite_is_refused(time):
    with pytest.raises(ValueError, match="finite time"):
        world_of([]).advance_to(time)
    with pytest.raises(ValueError, match="finite time"):
        world_of([], start_time=time)


def test_the_board_is_asked_for_all_due_milliseconds_at_once():
    board = ScriptedBoard([])
    world = World(board, build_plant(PlantChoice("noslip"), 0.01, START), COILS)
    for frame in range(1, 7):
        world.advance_to(frame / 60.0)
    assert board.asked == [16, 17, 17, 16, 17, 17]
    world.advance_to(2.6)
    assert board.asked[6:] == [LONGEST_ADVANCE, LONGEST_ADVANCE, 500]


def test_the_walk_is_the_same_however_the_time_is_cut():
    script = walking_currents(3000)
    coarse, fine = world_of(script), world_of(script)
    coarse.advance_to(3.0)
    for frame in range(1, 432):
        fine.advance_to(frame / 144.0)
    fine.advance_to(3.0)
    assert coarse.body() == fine.body()
    assert coarse.body().pose.distance_to(START.x, START.y) > 0.005


@pytest.mark.parametrize("plant", ["slip", "noslip"])
def test_without_current_nothing_moves(plant):
    world = world_of([], plant)
    world.advance_to(1.0)
    assert world.body().pose == START
    assert world.currents == ZERO
    assert world.field == ZERO


def test_the_robot_turns_into_the_local_field_not_into_the_commanded_one():
    heading = 1.3
    here = Pose(0.055, 0.055, heading)
    wanted = command_field(PIVOT_A, heading, TILT, 0.01)
    headings = []
    for allocation in (COILS.centre_allocation(), COILS.local_allocation(here.x, here.y)):
        world = world_of([currents_for(allocation, wanted)] * 400, "noslip")
        world.nudge(here)
        world.advance_to(0.4)
        headings.append(world.body().pose.heading)
    assert abs(headings[0] - heading) > math.radians(0.5)
    assert headings[1] == pytest.approx(heading, abs=1e-9)


def test_currents_and_field_are_those_of_the_last_millisecond():
    world = world_of([(1.0, 2.0, 3.0), (4.0, -5.0, 0.0)])
    world.advance_to(0.002)
    assert world.currents == (4.0, -5.0, 0.0)
    place = world.body().pose
    assert world.field == COILS.local_field(place.x, place.y, world.currents)


def test_the_body_shows_the_pressed_end_and_the_lift():
    currents = currents_for(
        COILS.local_allocation(START.x, START.y), command_field(PIVOT_B, START.heading, TILT, 0.01)
    )
    world = world_of([currents] * 50)
    world.advance_to(0.05)
    body = world.body()
    assert body.pivot == PIVOT_B
    assert math.degrees(body.tilt) == pytest.approx(6.9, abs=0.1)


def test_a_nudged_robot_lies_where_it_was_put():
    world = world_of([])
    world.nudge(Pose(0.01, 0.02, 3.0))
    assert world.body().pose == Pose(0.01, 0.02, 3.0)


def test_a_board_that_loses_time_is_an_error():
    world = World(ShortBoard([]), build_plant(PlantChoice("noslip"), 0.01, START), COILS)
    with pytest.raises(ValueError, match="10 ms and gave 9"):
        world.advance_to(0.01)


def test_closing_the_world_closes_the_board():
    board = ScriptedBoard([])
    World(board, build_plant(PlantChoice("noslip"), 0.01, START), COILS).close()
    assert board.closed
