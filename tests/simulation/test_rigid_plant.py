"""The rigid robot obeys mechanics: lifting, sticking, standing, turning."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from control.coils import command_field
from control.model import PIVOT_A, PIVOT_B, Pivot, Pose, body_tilt, pivot_point
from control.simulation.rigid.engine import Engine
from control.simulation.rigid.model import PER_METRE, TORQUE_UNIT
from control.simulation.rigid.parameters import RigidParameters
from control.simulation.rigid.plant import Diverged, RigidPlant
from control.simulation.rigid.plate import SLIPPERIEST, Plate

LENGTH = 0.010
MILLISECOND = 1e-3
FIELD = 10e-3
START = Pose(0.004, -0.003, 0.3)
EVEN = RigidParameters(friction_scatter_percent=0.0)
BARE = EVEN.model_copy(update={"adhesion_mN": 0.0, "moment_mA_m2": 1.24, "friction": 0.5})
"""Lambda = 3.2 by weight alone, friction 0.5: as the slip table's robot."""


def hold(plant: RigidPlant, pivot: Pivot, heading: float, tilt: float, seconds: float) -> None:
    field = command_field(pivot, heading, tilt, FIELD)
    for _ in range(round(seconds / MILLISECOND)):
        plant.step(field, MILLISECOND)


def taken_up(parameters: RigidParameters, tilt: float, pivot: Pivot = PIVOT_B, seed: int = 1) -> RigidPlant:
    """A robot at `START` on one end, after the field has risen slowly."""
    plant = RigidPlant(parameters, LENGTH, START, seed)
    for step in range(1, 301):
        plant.step(command_field(pivot, START.heading, tilt, FIELD * step / 300), MILLISECOND)
    return plant


def foot(plant: RigidPlant) -> tuple[float, float]:
    return pivot_point(plant.pose, plant.pivot, LENGTH)


def moved(before: tuple[float, float], after: tuple[float, float]) -> float:
    return math.hypot(after[0] - before[0], after[1] - before[1])


@pytest.mark.parametrize("parameters", [EVEN, BARE, EVEN.model_copy(update={"mass_mg": 150.0})])
@pytest.mark.parametrize("pivot", [PIVOT_A, PIVOT_B])
def test_the_free_end_lifts_once_lambda_sin_alpha_exceeds_one(
    parameters: RigidParameters, pivot: Pivot
) -> None:
    threshold = parameters.lifting_elevation(LENGTH)
    assert taken_up(parameters, threshold - math.radians(0.5), pivot).body_tilt < math.radians(0.1)
    lifted = taken_up(parameters, threshold + math.radians(0.5), pivot)
    hold(lifted, pivot, START.heading, threshold + math.radians(0.5), 0.05)
    assert lifted.body_tilt > math.radians(0.1)
    assert lifted.pivot == pivot


@pytest.mark.parametrize("tilt_deg", [25.0, 35.0])
def test_a_lifted_body_comes_to_rest_where_the_torques_balance(tilt_deg: float) -> None:
    tilt = math.radians(tilt_deg)
    plant = taken_up(BARE, tilt)
    hold(plant, PIVOT_B, START.heading, tilt, 1.2)
    ratio = BARE.magnetic_ratio(LENGTH)
    # Lambda sin(a - b) = cos b - (2 h / L) sin b, since the weight acts h = 0.4 mm above the middle of the balls.
    high = 2.0 * 0.4e-3 / LENGTH
    balance = math.atan2(ratio * math.sin(tilt) - 1.0, ratio * math.cos(tilt) - high)
    assert plant.body_tilt == pytest.approx(balance, rel=0.005)
    assert body_tilt(tilt, ratio) == pytest.approx(balance, rel=0.04)


@pytest.mark.parametrize("tilt_deg", [10.0, 30.0])
def test_at_rest_nothing_drifts(tilt_deg: float) -> None:
    tilt = math.radians(tilt_deg)
    plant = taken_up(RigidParameters(), tilt)
    hold(plant, PIVOT_B, START.heading, tilt, 1.0)
    before = plant.pose
    hold(plant, PIVOT_B, START.heading, tilt, 0.5)
    assert moved((before.x, before.y), plant.position) < 1e-6
    assert abs(plant.pose.heading - before.heading) < math.radians(0.05)


def test_without_a_field_a_placed_robot_is_exactly_where_it_was_put() -> None:
    plant = taken_up(RigidParameters(), math.radians(30.0))
    there = Pose(-0.02, 0.03, 7.1)
    plant.place(there)
    for field in ((0.0, 0.0, 0.0), (math.nan, 0.0, 0.01), (0.0, 0.0, 1e-9)):
        plant.step(field, 1.0)
    assert moved((there.x, there.y), plant.position) < 1e-15
    assert plant.pose.heading == pytest.approx(there.heading, abs=1e-12)
    assert plant.body_tilt < math.radians(0.01)


def test_a_robot_whose_field_is_gone_falls_flat_and_is_computed_no_further() -> None:
    plant = taken_up(RigidParameters(), math.radians(30.0))
    assert plant.body_tilt > math.radians(5.0)
    plant.step((0.0, 0.0, 0.0), 1.0)
    assert plant.body_tilt < math.radians(0.05)
    fallen, time = plant.pose, plant.engine.data.time
    plant.step((0.0, 0.0, 0.0), 10.0)
    assert (plant.pose, plant.engine.data.time) == (fallen, time)


@pytest.mark.parametrize("parameters", [EVEN, BARE])
def test_a_turning_body_stays_on_its_foot_below_the_hop(parameters: RigidParameters) -> None:
    tilt = parameters.lifting_elevation(LENGTH) + math.radians(3.0)
    plant = taken_up(parameters, tilt)
    hold(plant, PIVOT_B, START.heading, tilt, 0.3)
    before, heading, turns = foot(plant), plant.pose.heading, 500
    for step in range(turns):
        plant.step(command_field(PIVOT_B, START.heading + 1e-3 * step, tilt, FIELD), MILLISECOND)
    # Two balls of equal friction leave open about which point between them the foot turns; no other one.
    reach = 2.0 * 1.0e-3 * math.sin(0.5 * (plant.pose.heading - heading))
    assert moved(before, foot(plant)) < reach + 0.03e-3
    lag = START.heading + 1e-3 * turns - plant.pose.heading
    assert 0.0 < lag < math.radians(3.0)


def test_a_sticking_body_lags_by_more_than_a_lifted_one() -> None:
    lags = []
    for above in (-6.0, 3.0):
        tilt = EVEN.lifting_elevation(LENGTH) + math.radians(above)
        plant = taken_up(EVEN, tilt)
        for step in range(500):
            plant.step(command_field(PIVOT_B, START.heading + 1e-3 * step, tilt, FIELD), MILLISECOND)
        lags.append(START.heading + 0.5 - plant.pose.heading)
    assert lags[0] > 2.0 * lags[1]


def test_the_load_of_the_field_is_m_cross_b_and_no_force() -> None:
    engine = Engine(RigidParameters(), LENGTH)
    generator = np.random.default_rng(5)
    for _ in range(20):
        engine.reset()
        attitude = generator.normal(size=4)
        engine.state[:3] = 0.0, 0.0, 50.0
        engine.state[3:] = attitude / np.linalg.norm(attitude)
        field = generator.normal(size=3) * FIELD
        engine.set_field((float(field[0]), float(field[1]), float(field[2])))
        load = engine.magnetic_load()
        turn = np.array(engine.data.xmat[1]).reshape(3, 3)
        moment = 1.8e-3 * turn[:, 1]
        expected = turn.T @ np.cross(moment, field) * TORQUE_UNIT
        assert np.allclose(load[:3], 0.0, atol=1e-9 * np.abs(expected).max())
        assert np.allclose(load[3:], expected, rtol=1e-9, atol=1e-6)


def test_a_free_magnet_swings_about_the_field_with_the_damping_that_is_asked_for() -> None:
    """In the air, without weight: I th'' + c th' + m B sin th = 0, with c = 2 zeta sqrt(I m B)."""
    engine = Engine(RigidParameters(), LENGTH)
    engine.reset()
    engine.model.opt.gravity[:] = 0.0
    angle = 0.02
    engine.state[:] = 0.0, 0.0, 50.0, math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle)
    engine.set_field((0.0, FIELD, 0.0))
    peaks, before, rising = [angle], angle, False
    while len(peaks) < 4:
        engine.advance(1)
        now = 2.0 * math.atan2(float(engine.state[6]), float(engine.state[3]))
        if rising and now < before:
            peaks.append(before)
        rising, before = now > before, now
    ratios = [after / earlier for earlier, after in pairwise(peaks)]
    assert ratios == pytest.approx([math.exp(-2.0 * math.pi * 0.1 / math.sqrt(0.99))] * 3, rel=0.03)


def walk(plant: RigidPlant, chunk: int) -> Pose:
    """Two sweeps and a switch, with the same field for `chunk` ms each."""
    tilt = math.radians(30.0)
    for pivot in (PIVOT_A, PIVOT_B):
        for step in range(10):
            field = command_field(pivot, START.heading + pivot * 0.02 * step, tilt, FIELD)
            for _ in range(20 // chunk):
                plant.step(field, chunk * MILLISECOND)
    return plant.pose


def test_equal_fields_give_equal_walks_however_the_time_is_cut() -> None:
    poses = {chunk: walk(RigidPlant(RigidParameters(), LENGTH, START, 7), chunk) for chunk in (1, 5, 20)}
    assert poses[1] == poses[5] == poses[20]


def test_a_walk_depends_on_its_seed_alone() -> None:
    plant = RigidPlant(RigidParameters(), LENGTH, START, 7)
    first = walk(plant, 20)
    plant.place(START)
    assert walk(plant, 20) == first
    assert walk(RigidPlant(RigidParameters(), LENGTH, START, 8), 20) != first


def test_an_even_plate_is_the_same_for_every_seed() -> None:
    assert len({walk(RigidPlant(EVEN, LENGTH, START, seed), 20) for seed in (1, 2)}) == 1


def test_the_plates_friction_scatters_as_asked_and_stays_with_its_place() -> None:
    parameters = RigidParameters(friction=0.5, friction_scatter_percent=20.0, patch_mm=2.0)
    plate, again = Plate(parameters, 3), Plate(parameters, 3)
    drawn = [plate.friction_at(2.0 * x + 1.0, 2.0 * y + 1.0) for x in range(-20, 20) for y in range(-20, 20)]
    assert np.mean(drawn) == pytest.approx(0.5, abs=0.01)
    assert np.std(drawn) == pytest.approx(0.1, abs=0.01)
    assert again.friction_at(-0.1, 1.9) == plate.friction_at(-1.9, 0.1)
    wild = Plate(parameters.model_copy(update={"friction_scatter_percent": 100.0}), 3)
    assert min(wild.friction_at(2.0 * x, 0.0) for x in range(100)) >= SLIPPERIEST * 0.5


def test_a_motion_that_cannot_be_computed_is_told_of_and_leaves_no_file(tmp_path, monkeypatch) -> None:
    """MuJoCo by itself would put the robot to the origin, write a log where it was started, and go on."""
    monkeypatch.chdir(tmp_path)
    plant = taken_up(RigidParameters(), math.radians(30.0))
    plant.engine.speed[3] = math.nan
    with pytest.raises(Diverged, match="cannot be computed"):
        hold(plant, PIVOT_B, START.heading, math.radians(30.0), 0.01)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "parameters",
    [
        RigidParameters(moment_mA_m2=100.0, mass_mg=1.0, damping_percent=0.001),
        RigidParameters(adhesion_mN=100.0, mass_mg=1.0),
    ],
    ids=["flung away", "torn through the plate"],
)
def test_a_robot_that_leaves_its_plate_is_told_of(parameters: RigidParameters) -> None:
    with pytest.raises(Diverged, match=r"flew off its plate \(moment_mA_m2=.*choose a weaker magnet"):
        walk(taken_up(parameters, math.radians(30.0)), 20)


@pytest.mark.parametrize("length", [0.0, -0.01, math.nan, math.inf])
def test_a_rigid_robot_needs_a_length(length: float) -> None:
    with pytest.raises(ValueError, match="length"):
        RigidPlant(RigidParameters(), length, START)


def test_a_rigid_robot_cannot_be_placed_nowhere() -> None:
    with pytest.raises(ValueError, match="finite pose"):
        RigidPlant(RigidParameters(), LENGTH, replace(START, x=math.nan))


def test_the_feet_are_as_far_apart_as_the_robot_is_long() -> None:
    engine = Engine(RigidParameters(), 0.008)
    engine.reset()
    engine.advance(0)
    engine.magnetic_load()
    ends = [np.array(engine.data.geom(name).xpos) for name in ("a_front", "b_front")]
    assert np.linalg.norm(ends[0] - ends[1]) == pytest.approx(0.008 * PER_METRE)
