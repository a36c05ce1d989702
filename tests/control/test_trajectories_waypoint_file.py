"""Waypoints from the text of a CSV or JSON file."""

import contextlib
import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.trajectories.waypoint_file import WaypointFileError, read_points

TWO = [(1.0, -2.0), (3.5, 4.0)]

coordinates = st.floats(-500.0, 500.0)
paths = st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=20)

patient = settings(max_examples=60, deadline=None)


@pytest.mark.parametrize(
    "text",
    [
        "1,-2\n3.5,4\n",
        "x_mm,y_mm\n1,-2\n3.5,4",
        "\ufeffx_mm;y_mm;label\r\n1;-2;here\r\n\r\n3.5;4;there\r\n",
        "# drawn by hand\n1.0\t-2.0\n3.5\t4.0",
        "x y\n1 -2 0.1\n  3.5   4 0.2",
        "[[1, -2], [3.5, 4]]",
        " \n[[1, -2],\n [3.5, 4.0]]\n",
    ],
)
def test_points_are_read_from_any_usual_table(text: str) -> None:
    assert read_points(text) == TWO


@patient
@given(paths)
def test_what_is_written_is_read_again(points: list[tuple[float, float]]) -> None:
    assert read_points(json.dumps(points)) == points
    assert read_points("x_mm,y_mm\n" + "\n".join(f"{x!r},{y!r}" for x, y in points)) == points


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "no points; allowed: two numbers in mm a line"),
        ("x_mm,y_mm\n", "no points"),
        ("x,y\n1,2\n\n3,four\n", "line 4 is '3,four'; allowed"),
        ("1,2\nx,y\n3,4", "line 2 is 'x,y'"),
        ("1\n2", "line 1 is '1'"),
        ("1,\n2,3", "line 1 is '1,'"),
        ("1,nan", "line 1 is '1,nan'"),
        ("1,2\n1e999,3", "line 2"),
        ("[[1, 2], [3]]", r"point 2 is \[3\]"),
        ("[[1, 2], [true, 3]]", "point 2 is"),
        ("[[1, 2], [Infinity, 3]]", "point 2 is"),
        ("[[1, 2],\n [3, 4]", "line 2"),
        ("[" * 100_000, "cannot be read"),
        ("[1, 2]", "point 1 is 1"),
    ],
)
def test_a_wrong_table_is_refused_with_the_line(text: str, complaint: str) -> None:
    with pytest.raises(WaypointFileError, match=complaint):
        read_points(text)


@patient
@given(st.text(max_size=60))
def test_any_text_gives_points_or_a_reason(text: str) -> None:
    with contextlib.suppress(WaypointFileError):
        assert read_points(text)


def test_an_endless_file_is_refused() -> None:
    with pytest.raises(WaypointFileError, match="at most 10000000 are read"):
        read_points("1,2\n" * 2_500_001)
