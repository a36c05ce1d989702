"""Plants that walk in perfect fields: the paper's gait without slip, the fitted one with it."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from control.coils import command_field
from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, opposite, pivot_point
from control.simulation.plant import SlipPlant
from control.simulation.slip import NO_SLIP, SLIP_TABLE, Slip, SlipParameters

MILLISECOND = 1e-3
STRENGTH = 10e-3
RATE = 2.0
LENGTH = 0.01
START = Pose(0.012, -0.034, math.radians(70.0))
TILT = math.radians(24.5)
AHEAD = np.array([math.cos(START.heading), math.sin(START.heading)])


def stand(plant: SlipPlant, pivot: Pivot, heading: float, tilt: float, seconds: float = 0.1) -> None:
    for _ in range(round(seconds / MILLISECOND)):
        plant.step(command_field(pivot, heading, tilt, STRENGTH), MILLISECOND)


def switch(plant: SlipPlant, pivot: Pivot, heading: float, tilt: float) -> None:
    """From the other pivot to `pivot`: the elevation ramps for 50 ms while the heading holds."""
    for step in range(1, 51):
        field = command_field(pivot, heading, tilt * (step / 25.0 - 1.0), STRENGTH)
        plant.step(field, MILLISECOND)


def turn(plant: SlipPlant, pivot: Pivot, start: float, goal: float, tilt: float) -> None:
    for heading in ramp(start, goal):
        plant.step(command_field(pivot, heading, tilt, STRENGTH), MILLISECOND)


def ramp(start: float, goal: float) -> Iterator[float]:
    """Headings at RATE from `start`, stopping exactly on `goal`."""
    count = math.ceil(abs(goal - start) / (RATE * MILLISECOND))
    yield from (start + math.copysign(RATE * MILLISECOND, goal - start) * step for step in range(1, count))
    yield goal


def walk(plant: SlipPlant, sweeps: int, sweep: float, tilt: float = TILT, lead: float = 0.0) -> list[Pose]:
    """A straight walk along the start's heading: the pose after the half first sweep and each full one.

    The field's heading runs `lead` (rad) beyond half a sweep to each side.
    """
    ahead = plant.pose.heading
    reach = 0.5 * sweep + lead
    pivot: Pivot = PIVOT_A
    stand(plant, pivot, ahead, tilt)
    turn(plant, pivot, ahead, ahead + reach, tilt)
    poses = [plant.pose]
    for _ in range(sweeps):
        start = ahead + pivot * reach
        pivot = opposite(pivot)
        switch(plant, pivot, start, tilt)
        turn(plant, pivot, start, ahead + pivot * reach, tilt)
        poses.append(plant.pose)
    return poses


def advances(poses: list[Pose]) -> np.ndarray:
    """How far each sweep took the centre along the walking direction, m."""
    return np.diff([(pose.x, pose.y) for pose in poses], axis=0) @ AHEAD


def without_scatter(tilt: float) -> SlipParameters:
    mean = SLIP_TABLE.at(tilt, LENGTH)
    return SlipParameters(rows=(replace(mean, play_sd=0.0, out_sd=0.0, forward_sd=0.0),))


def sweep_advance(slip: Slip, sweep: float) -> float:
    """The closed form: the gait's, and the landing's share along the walk, m."""
    forward = slip.forward_base + slip.forward_per_sweep * sweep
    half = 0.5 * sweep
    return LENGTH * math.sin(half) + forward * math.cos(half) + slip.out * math.sin(half)


@pytest.mark.parametrize("sweep_deg", [3.0, 10.0, 30.0, 90.0, 180.0])
def test_without_slip_a_sweep_advances_the_centre_by_the_closed_form(sweep_deg):
    sweep = math.radians(sweep_deg)
    poses = walk(SlipPlant(NO_SLIP, LENGTH, START), 8, sweep)
    assert advances(poses) == pytest.approx([LENGTH * math.sin(0.5 * sweep)] * 8, rel=1e-9)


def test_without_slip_the_first_half_sweep_advances_half_of_a_full_one():
    sweep = math.radians(30.0)
    first = walk(SlipPlant(NO_SLIP, LENGTH, START), 0, sweep)[0]
    step = (first.x - START.x) * AHEAD[0] + (first.y - START.y) * AHEAD[1]
    assert step == pytest.approx(0.5 * LENGTH * math.sin(0.5 * sweep), rel=1e-9)


def test_without_slip_the_walk_stays_on_its_line():
    poses = walk(SlipPlant(NO_SLIP, LENGTH, START), 40, math.radians(30.0))
    aside = [(pose.x - START.x) * AHEAD[1] - (pose.y - START.y) * AHEAD[0] for pose in poses]
    assert max(aside) - min(aside) < 1e-12


@pytest.mark.parametrize("parameters", [NO_SLIP, SLIP_TABLE])
def test_while_it_turns_the_pivot_stays_in_place(parameters):
    plant = SlipPlant(parameters, LENGTH, START, seed=3)
    stand(plant, PIVOT_B, START.heading, TILT)
    fixed = pivot_point(plant.pose, PIVOT_B, LENGTH)
    for heading in ramp(START.heading, START.heading + 20.0):
        plant.step(command_field(PIVOT_B, heading, TILT, STRENGTH), MILLISECOND)
        assert math.dist(fixed, pivot_point(plant.pose, PIVOT_B, LENGTH)) < 1e-15


@pytest.mark.parametrize("tilt_deg", [15.0, 20.0, 24.5, 30.0])
@pytest.mark.parametrize("sweep_deg", [15.0, 30.0])
def test_with_slip_a_sweep_advances_by_the_gait_and_the_landing(tilt_deg, sweep_deg):
    tilt, sweep = math.radians(tilt_deg), math.radians(sweep_deg)
    parameters = without_scatter(tilt)
    slip = parameters.rows[0]
    poses = walk(SlipPlant(parameters, LENGTH, START), 6, sweep, tilt, lead=0.5 * slip.play)
    # The first switch follows the half sweep, so its landing is another one.
    assert advances(poses)[1:] == pytest.approx([sweep_advance(slip, sweep)] * 5, rel=1e-9)


def test_the_scatter_of_friction_leaves_the_mean_advance_as_it_is():
    sweep, slip = math.radians(30.0), SLIP_TABLE.at(TILT, LENGTH)
    plant = SlipPlant(SLIP_TABLE, LENGTH, START, seed=11)
    steps = advances(walk(plant, 600, sweep, lead=0.5 * slip.play))[1:]
    standard_error = steps.std() / math.sqrt(len(steps))
    assert steps.std() > 0.5 * slip.forward_sd
    assert abs(steps.mean() - sweep_advance(slip, sweep)) < 4.0 * standard_error


def test_walking_backwards_slips_backwards():
    sweep = math.radians(20.0)
    parameters = without_scatter(TILT)
    lead = 0.5 * parameters.rows[0].play
    forwards = advances(walk(SlipPlant(parameters, LENGTH, START), 5, sweep, lead=lead))[1:]
    backwards = advances(walk(SlipPlant(parameters, LENGTH, START), 5, -sweep, lead=-lead))[1:]
    out = 2.0 * parameters.rows[0].out * math.sin(0.5 * sweep)
    assert np.allclose(backwards, -forwards, atol=abs(out))
    assert (backwards < 0.0).all()


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_the_body_lags_the_field_by_half_the_play(direction):
    plant = SlipPlant(without_scatter(TILT), LENGTH, START)
    half = 0.5 * plant.parameters.rows[0].play
    stand(plant, PIVOT_A, START.heading, TILT)
    goal = START.heading + direction
    turn(plant, PIVOT_A, START.heading, goal, TILT)
    assert plant.pose.heading == pytest.approx(goal - direction * half, abs=1e-12)
    turn(plant, PIVOT_A, goal, goal - direction * 1.9 * half, TILT)
    assert plant.pose.heading == pytest.approx(goal - direction * half, abs=1e-12)


def test_a_new_pivot_lands_beside_its_place_by_the_tabulated_slip():
    parameters = without_scatter(TILT)
    slip, sweep = parameters.rows[0], math.radians(30.0)
    plant = SlipPlant(parameters, LENGTH, START)
    stand(plant, PIVOT_A, START.heading, TILT)
    turn(plant, PIVOT_A, START.heading, START.heading + sweep + 0.5 * slip.play, TILT)
    due = pivot_point(plant.pose, PIVOT_B, LENGTH)
    switch(plant, PIVOT_B, START.heading + sweep + 0.5 * slip.play, TILT)
    landed = pivot_point(plant.pose, PIVOT_B, LENGTH)
    moved = np.subtract(landed, due)
    forward = np.array([math.cos(plant.pose.heading), math.sin(plant.pose.heading)])
    assert moved @ forward == pytest.approx(slip.forward_base + slip.forward_per_sweep * sweep, rel=1e-9)
    assert moved @ (forward[1], -forward[0]) == pytest.approx(slip.out, rel=1e-9)
    assert plant.counters.slipped == pytest.approx(float(np.hypot(*moved)), rel=1e-9)


def test_the_slip_follows_the_tilt_that_had_settled_before_the_switch():
    nothing = NO_SLIP.rows[0]
    rows = (replace(nothing, tilt=0.1, out=1e-4), replace(nothing, tilt=0.7, out=7e-4))
    plant = SlipPlant(SlipParameters(rows), LENGTH, START)
    stand(plant, PIVOT_A, START.heading, 0.2)
    stand(plant, PIVOT_A, START.heading, 0.5)
    switch(plant, PIVOT_B, START.heading, 0.5)
    assert plant.counters.slipped == pytest.approx(5e-4, rel=0.01)


def test_a_longer_robot_slips_further_in_proportion():
    small, large = (SLIP_TABLE.at(TILT, length) for length in (0.01, 0.02))
    assert (large.out, large.forward_sd) == pytest.approx((2.0 * small.out, 2.0 * small.forward_sd))
    assert large.play == small.play


def test_equal_seeds_walk_alike_and_others_do_not():
    def end(seed: int) -> Pose:
        return walk(SlipPlant(SLIP_TABLE, LENGTH, START, seed), 6, 0.5)[-1]

    assert end(5) == end(5)
    assert end(5) != end(6)


def test_the_plant_counts_its_switches_and_turns():
    plant = SlipPlant(NO_SLIP, LENGTH, START)
    walk(plant, 4, 0.5)
    assert plant.counters.switches == 4
    assert plant.counters.turned == pytest.approx(0.25 + 4 * 0.5)
    assert plant.counters.slipped == 0.0
