"""What single fields do to the robot: rest, alignment, pressing, lifting; and the table's arithmetic."""

import math
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.coils import command_field
from control.model import PIVOT_A, PIVOT_B, Pose, wrap
from control.simulation.plant import ALIGNMENT_RATE, REST_FIELD, SlipPlant
from control.simulation.slip import NO_SLIP, SLIP_TABLE, SlipParameters

MILLISECOND = 1e-3
START = Pose(0.0, 0.0, 0.3)
TILT = math.radians(25.0)


def plant_at(heading: float = START.heading, parameters: SlipParameters = NO_SLIP) -> SlipPlant:
    return SlipPlant(parameters, 0.01, Pose(0.0, 0.0, heading))


@pytest.mark.parametrize(
    "field",
    [
        (0.0, 0.0, 0.0),
        (0.99 * REST_FIELD, 0.0, 0.0),
        (0.0, 0.0, 0.02),
        (math.nan, 0.01, 0.0),
        (0.01, 0.0, math.nan),
        (math.inf, 0.0, 0.0),
    ],
)
def test_a_field_too_weak_or_not_a_number_moves_nothing(field):
    plant = plant_at(parameters=SLIP_TABLE)
    plant.step(command_field(PIVOT_B, START.heading, TILT, 0.01), MILLISECOND)
    before = plant.pose
    plant.step(field, MILLISECOND)
    assert plant.pose == before
    assert plant.body_tilt == 0.0


@given(st.floats(-50.0, 50.0), st.floats(-3.0, 3.0))
def test_the_body_turns_into_the_field_the_short_way_and_never_faster_than_allowed(start, away):
    plant = plant_at(start)
    field = command_field(PIVOT_A, start + away, TILT, 0.01)
    for _ in range(120):
        before = plant.pose.heading
        plant.step(field, MILLISECOND)
        assert abs(plant.pose.heading - before) <= ALIGNMENT_RATE * MILLISECOND + 1e-12
    assert plant.pose.heading == pytest.approx(start + away, abs=1e-9)


@pytest.mark.parametrize("pivot", [PIVOT_A, PIVOT_B])
def test_the_field_presses_the_commanded_end_down(pivot):
    plant = plant_at()
    plant.step(command_field(pivot, START.heading, TILT, 0.01), MILLISECOND)
    assert plant.pivot == pivot


@pytest.mark.parametrize("first", [PIVOT_A, PIVOT_B])
def test_a_field_along_the_plate_leaves_the_pivot_as_it_is(first):
    plant = plant_at()
    plant.step(command_field(first, START.heading, TILT, 0.01), MILLISECOND)
    for elevation in (0.0, 1e-9, -1e-9, 0.015, -0.015):
        plant.step(command_field(PIVOT_A, START.heading, elevation, 0.01), MILLISECOND)
        assert plant.pivot == first
    assert plant.counters.switches == 0


def test_out_of_rest_a_pivot_is_taken_without_slip():
    plant = plant_at(parameters=SLIP_TABLE)
    for pivot in (PIVOT_A, PIVOT_B):
        plant.step((0.0, 0.0, 0.0), MILLISECOND)
        plant.step(command_field(pivot, START.heading, TILT, 0.01), MILLISECOND)
    assert plant.pivot == PIVOT_B
    assert plant.pose == START
    assert plant.counters == (SlipPlant(SLIP_TABLE, 0.01, START).counters)


@given(st.floats(0.0, math.pi / 3), st.floats(0.001, 0.02))
def test_the_body_tilt_solves_the_balance_of_the_free_end(tilt, strength):
    plant = plant_at()
    plant.step(command_field(PIVOT_A, START.heading, tilt, strength), MILLISECOND)
    ratio = SLIP_TABLE.magnetic_ratio * strength / SLIP_TABLE.reference_field
    body = plant.body_tilt
    if ratio * math.sin(tilt) > 1.0 + 1e-9:
        assert ratio * math.sin(tilt - body) == pytest.approx(math.cos(body), rel=1e-9)
    else:
        assert body == pytest.approx(0.0, abs=1e-8)


def test_at_twenty_five_degrees_of_field_the_body_rises_by_almost_seven():
    plant = plant_at()
    plant.step(command_field(PIVOT_A, START.heading, TILT, 0.01), MILLISECOND)
    assert math.degrees(plant.body_tilt) == pytest.approx(6.9, abs=0.05)


def test_a_placed_robot_lies_flat_and_at_rest_where_it_was_put():
    plant = plant_at(parameters=SLIP_TABLE)
    plant.step(command_field(PIVOT_B, START.heading, TILT, 0.01), MILLISECOND)
    there = Pose(0.02, -0.03, -2.0)
    plant.place(there)
    assert (plant.pose, plant.position, plant.body_tilt) == (there, (0.02, -0.03), 0.0)
    plant.step(command_field(PIVOT_A, there.heading, TILT, 0.01), MILLISECOND)
    assert plant.pose == there


@pytest.mark.parametrize("pose", [Pose(math.nan, 0.0, 0.0), Pose(0.0, 0.0, math.inf)])
def test_a_robot_cannot_be_placed_nowhere(pose):
    with pytest.raises(ValueError, match="finite pose"):
        plant_at().place(pose)


@pytest.mark.parametrize("length", [0.0, -0.01, math.nan, math.inf])
def test_a_robot_needs_a_length(length):
    with pytest.raises(ValueError, match="length"):
        SlipPlant(NO_SLIP, length, START)


@pytest.mark.parametrize("row", SLIP_TABLE.rows)
def test_the_table_is_met_at_its_rows(row):
    assert SLIP_TABLE.at(row.tilt, SLIP_TABLE.reference_length) == row


def test_between_rows_the_table_is_linear_and_beyond_them_it_is_the_last_row():
    low, high = SLIP_TABLE.rows[0], SLIP_TABLE.rows[1]
    middle = SLIP_TABLE.at(0.5 * (low.tilt + high.tilt), 0.01)
    assert middle.play == pytest.approx(0.5 * (low.play + high.play))
    assert middle.forward_sd == pytest.approx(0.5 * (low.forward_sd + high.forward_sd))
    assert SLIP_TABLE.at(0.0, 0.01) == low
    assert SLIP_TABLE.at(1.5, 0.01) == SLIP_TABLE.rows[-1]


@pytest.mark.parametrize("rows", [(), SLIP_TABLE.rows[::-1], (NO_SLIP.rows[0], NO_SLIP.rows[0])])
def test_a_table_without_rising_tilts_is_refused(rows):
    with pytest.raises(ValueError, match="rows by rising tilt"):
        SlipParameters(rows)


def test_a_step_takes_a_few_microseconds():
    plant = plant_at(parameters=SLIP_TABLE)
    fields = [command_field(PIVOT_A, START.heading + 0.002 * step, TILT, 0.01) for step in range(1000)]

    def run() -> float:
        begin = time.perf_counter()
        for field in fields:
            plant.step(field, MILLISECOND)
        return (time.perf_counter() - begin) / len(fields)

    assert min(run() for _ in range(20)) < 20e-6
    assert abs(wrap(plant.pose.heading - (START.heading + 1.998))) < 0.1
