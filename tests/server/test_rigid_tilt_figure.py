"""The rigid robot's figure and tables hold what the study found."""

import math

import pytest

from control.simulation.gait_survey import Spread, SwitchFigures
from control.simulation.rigid.tilt_study import TableRow, TiltPoint
from control.simulation.slip import SLIP_TABLE
from server.reports.rigid_tilt import NOTES, beside_table, rigid_tilt, tilt_table


def point(ratio: float, ramp: float, tilt_deg: float) -> TiltPoint:
    spread = Spread(1e-3 * tilt_deg, 1e-4)
    figures = SwitchFigures(spread, spread, spread, spread, spread, spread, advance=0.9)
    return TiltPoint(ratio, ramp, math.radians(tilt_deg), figures)


POINTS = [point(ratio, ramp, tilt) for ratio in (2.0, 7.0) for ramp in (0.05, 0.15) for tilt in (10.0, 40.0)]


def test_the_figure_has_a_panel_for_each_quantity_and_ramp_and_a_line_for_each_lambda() -> None:
    figure = rigid_tilt(POINTS)
    assert len(figure.axes) == 6
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["Λ = 2", "Λ = 7"]
    assert [axes.get_title(loc="left") for axes in figure.axes[:2]] == [
        "elevation ramp 50 ms",
        "elevation ramp 150 ms",
    ]
    # A dotted line where the free end lifts, for the one whose place lies inside: asin(1/2) = 30 degrees.
    dotted = [line for line in figure.axes[0].get_lines() if line.get_linestyle() == ":"]
    assert [float(line.get_xdata()[0]) for line in dotted] == pytest.approx([30.0])  # type: ignore[index]


def test_the_tables_have_one_row_for_each_point_in_lab_units() -> None:
    header, *rows = tilt_table(POINTS)
    assert len(rows) == len(POINTS)
    first = dict(zip(header, rows[0], strict=True))
    assert (first["lambda"], first["ramp_ms"], first["tilt_deg"]) == (2.0, 50.0, 10.0)
    assert first["hop_mm"] == pytest.approx(10.0)
    assert first["lambda_sin_tilt"] == pytest.approx(2.0 * math.sin(math.radians(10.0)), abs=1e-4)


def test_the_slip_tables_rows_stand_beside_the_rigid_plants() -> None:
    row = SLIP_TABLE.rows[3]
    header, values = beside_table([TableRow(row, POINTS[0].figures)], sweep=0.5)
    found = dict(zip(header, values, strict=True))
    assert found["play_table_deg"] == pytest.approx(math.degrees(row.play), abs=1e-3)
    assert found["forward_table_mm"] == pytest.approx(1e3 * (row.forward_base + 0.5 * row.forward_per_sweep))
    assert found["out_rigid_mm"] == pytest.approx(10.0)


def test_what_is_assumed_is_said_beside_the_figure() -> None:
    said = " ".join(NOTES)
    assert "property of the assumed robot" in said
    assert "fitted at Λ = 3.2" in said
    assert "default is Λ = 2.6" in said
