"""The open-loop survey of pivot switches: it finds what the plants were given, and what Lambda explains."""

import math
from itertools import islice

import pytest

from control.simulation.gait_survey import Stride, SwitchFigures, survey
from control.simulation.plants import PlantChoice
from control.simulation.rigid.parameters import RigidParameters
from control.simulation.rigid.tilt_study import LENGTH, TiltPoint, beside_the_table, rigid_with, tilt_study
from control.simulation.slip import SLIP_TABLE

SWEEP = math.radians(30.0)
EVEN = RigidParameters(friction_scatter_percent=0.0)


def figures_of(choice: PlantChoice, tilt_deg: float, ramp: float = 0.05, switches: int = 1) -> SwitchFigures:
    return survey(choice, LENGTH, Stride(math.radians(tilt_deg), SWEEP, ramp=ramp), switches, (1,))


def test_without_slip_there_is_nothing_to_find() -> None:
    found = figures_of(PlantChoice("noslip"), 25.0)
    for spread in (found.play, found.out, found.forward, found.hop, found.displacement):
        assert (spread.mean, spread.deviation) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert found.advance == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("row", [SLIP_TABLE.rows[2], SLIP_TABLE.rows[5]])
def test_the_survey_of_the_slip_plant_gives_its_table_back(row) -> None:
    choice = PlantChoice("slip", {"scatter_scale": 0.0})
    found = survey(choice, LENGTH, Stride(row.tilt, SWEEP), 8, (1,))
    # The plant itself smooths the tilt that it looks the table up by.
    assert found.play.mean == pytest.approx(row.play, rel=0.02)
    assert found.out.mean == pytest.approx(row.out, rel=0.02)
    # The body turns less than the field by the play.
    forward = row.forward_base + row.forward_per_sweep * (SWEEP - row.play)
    assert found.forward.mean == pytest.approx(forward, abs=10e-6)
    assert found.hop.deviation < 1e-6


def test_a_scattering_plant_scatters_in_the_survey() -> None:
    row = SLIP_TABLE.rows[4]
    found = survey(PlantChoice("slip"), LENGTH, Stride(row.tilt, SWEEP), 25, (1, 2, 3))
    assert found.out.deviation == pytest.approx(row.out_sd, rel=0.25)
    assert found.play.deviation == pytest.approx(row.play_sd, rel=0.25)


def test_below_lambda_sin_alpha_of_one_the_rigid_robot_sticks_and_does_not_lift() -> None:
    choice = rigid_with(EVEN, 2.6)
    sticking, lifted = figures_of(choice, 15.0), figures_of(choice, 25.0)
    assert sticking.tilt.mean < math.radians(0.1) < math.radians(5.0) < lifted.tilt.mean
    assert sticking.play.mean > 2.5 * lifted.play.mean
    assert sticking.advance < lifted.advance


def test_a_strong_magnet_hops_outward_at_a_quick_switch_and_hardly_at_a_slow_one() -> None:
    choice = rigid_with(EVEN, 7.0)
    low, high = figures_of(choice, 10.0), figures_of(choice, 22.0)
    gentle = figures_of(choice, 22.0, ramp=0.15)
    assert abs(low.hop.mean) < 0.1e-3
    assert high.hop.mean > 0.5e-3
    assert abs(gentle.hop.mean) < 0.2 * high.hop.mean


def test_the_study_of_the_tilt_goes_from_lambda_to_lambda_and_knows_its_lift() -> None:
    tilts = (math.radians(20.0), math.radians(30.0))
    points = list(islice(tilt_study((2.6, 7.0), (0.05,), tilts, switches=1, seeds=(1,)), 3))
    assert [(point.ratio, point.tilt) for point in points] == [
        (2.6, tilts[0]),
        (2.6, tilts[1]),
        (7.0, tilts[0]),
    ]
    assert all(isinstance(point, TiltPoint) for point in points)
    assert points[0].lift == pytest.approx(2.6 * math.sin(tilts[0]))
    assert points[2].figures.tilt.mean > points[0].figures.tilt.mean


def test_at_the_tables_lambda_the_rigid_robots_play_is_the_tables(full) -> None:
    """The play follows from friction and torque alone; nothing is fitted. The displacements are another matter."""
    rows = SLIP_TABLE.rows if full else SLIP_TABLE.rows[::4]
    for row in beside_the_table(rows, 10 if full else 2, (1,)):
        # Within two of the table's deviations.
        assert row.rigid.play.mean == pytest.approx(row.table.play, abs=2.0 * row.table.play_sd)
