"""The planner's parts against the kinematics, the plant and exhaustive search."""

import cmath
import math
import random

import numpy as np
import pytest

from control.controllers.planner.future import Ahead, Horizon, features
from control.controllers.planner.moves import LONGEST, Moves, MoveSettings, slot_for
from control.controllers.planner.search import Root, Search
from control.controllers.planner.slip import Sighting, SlipWatch, SwitchSlip
from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, opposite, swing
from control.simulation.plant import SlipPlant
from control.simulation.slip import Slip, SlipParameters

LENGTH = 0.010
SWEEP = math.radians(30.0)
SETTINGS = MoveSettings(LENGTH, 2.0, 0.131, 0.05, (SWEEP,), 1e-8, 2e-8, 3e-8)
MOVES = Moves(SETTINGS)
NO_SLIP = SwitchSlip()
SLIP = SwitchSlip(out=-1.5e-4, forward_base=0.8e-4, forward_per_turn=4.5e-4)
FAR = math.inf


def path_ahead(slots: int, speed: float = 0.004) -> Ahead:
    times = SETTINGS.slot * np.arange(1, slots + LONGEST)
    points = speed * times * np.exp(0.15j * times) + 0.001j
    return Ahead(points.astype(np.complex128))


def as_complex(pose: Pose) -> complex:
    return complex(pose.x, pose.y)


def test_every_move_is_an_exact_arc() -> None:
    pose = Pose(0.02, -0.01, 0.7)
    for pivot in (PIVOT_A, PIVOT_B):
        for index, move in enumerate(MOVES.all):
            about = opposite(pivot) if move.switches else pivot
            facing = pivot * cmath.exp(1j * pose.heading)
            there = as_complex(pose) + facing * MOVES.ends[index]
            assert there == pytest.approx(as_complex(swing(pose, about, move.turn, LENGTH)), abs=1e-12)


def test_a_robot_stands_still_while_it_switches_pivots() -> None:
    switching = [index for index, move in enumerate(MOVES.all) if move.switches]
    share = SETTINGS.switch_time / SETTINGS.slot
    for index in switching:
        first = abs(MOVES.turned[index, 0]) / abs(MOVES.turns[index])
        assert first == pytest.approx((1.0 - share) / (MOVES.durations[index] - share))


def test_no_move_is_faster_than_the_robot() -> None:
    assert all(abs(MOVES.rate(move)) <= SETTINGS.max_rate + 1e-9 for move in MOVES.all)


@pytest.mark.parametrize("switch_time", [0.0, 0.05, 0.5])
@pytest.mark.parametrize("sweep_deg", [1.0, 10.0, 40.0, 180.0])
def test_both_pivots_can_be_used_whatever_the_gait(sweep_deg: float, switch_time: float) -> None:
    turn = math.radians(sweep_deg)
    slot = slot_for(turn, 2.0, switch_time, 0.0)
    moves = Moves(MoveSettings(LENGTH, 2.0, slot, switch_time, (turn,), 0.0, 0.0, 0.0))
    assert {(move.switches, math.copysign(1.0, move.turn)) for move in moves.all if move.turn} == {
        (switches, sign) for switches in (False, True) for sign in (1.0, -1.0)
    }


def direct_cost(root: Root, index: int, ahead: Ahead, slots: int) -> float:
    """The cost of one move from the root, slot by slot."""
    move = MOVES.all[index]
    place = root.place
    if move.switches:
        place += complex(SLIP.at(np.array(root.facing), np.array(root.pivot), np.array(root.turned)))
    total = 0.0
    for slot in range(min(move.duration, slots)):
        there = place + root.pivot * root.facing * MOVES.arcs[index, slot]
        total += abs(there - ahead.points[slot]) ** 2
        if ahead.headings is not None:
            facing = root.facing * cmath.exp(1j * MOVES.turned[index, slot])
            total += ahead.weight * abs(facing - ahead.headings[slot]) ** 2
    return SETTINGS.slot * total + float(MOVES.price[index])


@pytest.mark.parametrize("weight", [None, 2e-5])
@pytest.mark.parametrize("slots", [4, 12])
def test_the_tables_give_the_sum_over_the_slots(slots: int, weight: float | None) -> None:
    ahead = path_ahead(slots)
    if weight is not None:
        headings = np.exp(1j * np.linspace(0.3, 2.0, len(ahead.points)))
        ahead = Ahead(ahead.points, headings, weight)
    table = Horizon(MOVES, slots).costs(ahead)
    for pivot in (1.0, -1.0):
        root = Root(0.003 - 0.002j, cmath.exp(0.4j), pivot, 0.5, FAR)
        place, facing, turned = np.array(root.place), np.array(root.facing), np.array(root.turned)
        slid = place + SLIP.at(facing, np.array(pivot), turned)
        costs = features(place, slid, facing, np.array(pivot)) @ table[0]
        expected = [direct_cost(root, index, ahead, slots) for index in range(len(MOVES.all))]
        assert costs == pytest.approx(expected, rel=1e-9, abs=1e-15)


def exhaustive(root: Root, ahead: Ahead, slot: int, slots: int) -> float:
    """The least cost of all plans, by trying every one."""
    best = math.inf
    left = Ahead(ahead.points[slot:])
    for index, move in enumerate(MOVES.all):
        cost = direct_cost(root, index, left, slots - slot)
        if slot + move.duration < slots:
            cost += exhaustive(after(root, index), ahead, slot + move.duration, slots)
        best = min(best, cost)
    return best


def after(root: Root, index: int) -> Root:
    move = MOVES.all[index]
    place, pivot, turned = root.place, root.pivot, root.turned
    if move.switches:
        place += complex(SLIP.at(np.array(root.facing), np.array(pivot), np.array(turned)))
        turned = 0.0
    place += pivot * root.facing * complex(MOVES.ends[index])
    facing = root.facing * complex(MOVES.spins[index])
    return Root(place, facing, -pivot if move.switches else pivot, turned + move.turn, root.edge)


@pytest.mark.parametrize("heading", [0.0, 1.2])
def test_a_wide_beam_finds_what_exhaustive_search_finds(heading: float) -> None:
    slots = 6
    root = Root(0.001j, cmath.exp(1j * heading), 1.0, 0.4, FAR)
    ahead = path_ahead(slots)
    plan = Search(MOVES, slots, 200).best(root, ahead, SLIP)
    assert plan is not None
    assert plan.cost == pytest.approx(exhaustive(root, ahead, 0, slots), rel=1e-9)


def test_a_wider_beam_is_never_worse_on_average() -> None:
    rng = random.Random(3)
    costs = dict.fromkeys((4, 24, 96), 0.0)
    for _ in range(12):
        place = complex(rng.gauss(0.0, 2e-3), rng.gauss(0.0, 2e-3))
        root = Root(place, cmath.exp(1j * rng.uniform(-3, 3)), rng.choice([1.0, -1.0]), 0.0, FAR)
        for width in costs:
            plan = Search(MOVES, 24, width).best(root, path_ahead(24), NO_SLIP)
            assert plan is not None
            costs[width] += plan.cost
    assert costs[96] <= costs[24] <= costs[4]


def test_a_robot_walled_in_has_no_plan() -> None:
    root = Root(0j, 1.0 + 0j, 1.0, 0.0, -1.0)
    assert Search(MOVES, 12, 24).best(root, path_ahead(12), NO_SLIP) is None


def table_of(slip: SwitchSlip) -> SlipParameters:
    row = Slip(0.0, 0.0, 0.0, slip.out, 0.0, slip.forward_base, slip.forward_per_turn, 0.0)
    return SlipParameters((row,))


def field_of(heading: float, pivot: Pivot) -> tuple[float, float, float]:
    """10 mT that holds a robot at `heading` and presses on `pivot`, T."""
    level, up = 0.01 * math.cos(0.43), -pivot * 0.01 * math.sin(0.43)
    return -level * math.sin(heading), level * math.cos(heading), up


def turn_plant(plant: SlipPlant, pivot: Pivot, turn: float) -> None:
    start = plant.pose.heading
    for index in range(1, 61):
        plant.step(field_of(start + turn * index / 60, pivot), 0.01)


@pytest.mark.parametrize("pivot", [PIVOT_A, PIVOT_B])
@pytest.mark.parametrize("turn", [SWEEP, -SWEEP])
def test_the_expected_slip_is_the_plants(pivot: Pivot, turn: float) -> None:
    plant = SlipPlant(table_of(SLIP), LENGTH, Pose(0.01, 0.02, 0.9))
    turn_plant(plant, pivot, turn)
    before = plant.pose
    plant.step(field_of(before.heading, opposite(pivot)), 0.01)
    facing = np.array(cmath.exp(1j * before.heading))
    expected = SLIP.at(facing, np.array(float(pivot)), np.array(turn))
    assert as_complex(plant.pose) - as_complex(before) == pytest.approx(complex(expected), abs=1e-12)


def test_the_slip_is_learned_from_where_sweeps_end() -> None:
    plant = SlipPlant(table_of(SLIP), LENGTH, Pose(0.0, 0.0, 0.2))
    watch = SlipWatch(NO_SLIP)
    turn_plant(plant, PIVOT_A, SWEEP)
    pivot, turned = PIVOT_A, SWEEP
    for _ in range(120):
        before = plant.pose
        turn_plant(plant, opposite(pivot), -turned)
        watch.see(Sighting(before, pivot, turned, plant.pose), LENGTH)
        pivot, turned = opposite(pivot), -turned
    assert watch.slip.out == pytest.approx(SLIP.out, abs=5e-6)
    forward = SLIP.forward_base + SLIP.forward_per_turn * SWEEP
    assert watch.slip.forward_base == pytest.approx(forward, abs=1e-5)


def test_a_robot_that_was_pushed_teaches_nothing() -> None:
    watch = SlipWatch(SLIP)
    watch.see(Sighting(Pose(0.0, 0.0, 0.0), PIVOT_A, SWEEP, Pose(0.02, 0.0, -SWEEP)), LENGTH)
    assert watch.slip == SLIP
