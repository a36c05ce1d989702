"""The shapes of the paths that come with the program: closed, smooth, at constant speed, where they should be."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from pydantic import ValidationError

from control.trajectories import Path, check_inside, trajectories
from control.trajectories.custom import save_path
from control.trajectories.trajectory import MM, length_of, points_of

EIGHT_POINTS = [[-30, -20], [-10, 25], [0, 0], [15, -30], [28, 4], [30, 30], [5, 35], [-45, 20]]
SPLINE = ("waypoints", {"kind": "spline", "points_mm": EIGHT_POINTS})
OPEN_SPLINE = ("waypoints", {"kind": "spline", "points_mm": EIGHT_POINTS, "closed": False})
LETTERS = [("letter", {"letter": letter}) for letter in "SMU"]
SMOOTH = [
    ("lissajous", {}),
    ("circle", {}),
    ("spiral", {}),
    ("polygon", {}),
    *LETTERS,
    SPLINE,
    OPEN_SPLINE,
]
CONSTANT_SPEED = [("line", {}), *SMOOTH[1:], ("spiral", {"way": "out", "inner_radius_mm": 0.0})]
CLOSED = [
    ("eight", {}),
    ("lissajous", {"frequency_x": 5, "frequency_y": 4}),
    ("circle", {}),
    ("polygon", {}),
    ("polygon", {"corners": 7, "corner_radius_mm": 0.0}),
    ("waypoints", {}),
    SPLINE,
]
SHIPPED = ("eight", "line", "circle", "lissajous", "spiral", "polygon", "letter", "waypoints")

quick = settings(max_examples=30, deadline=None)

sizes = st.floats(1.0, 100.0)
speeds = st.floats(0.1, 50.0)


def build(choice: tuple[str, dict[str, Any]], **more: Any) -> Path:
    return trajectories.build(choice[0], {**choice[1], **more})


def speeds_along(path: Path, count: int = 2001) -> NDArray[np.float64]:
    steps = np.diff(points_of(path, count), axis=0)
    return np.hypot(*steps.T) / (path.duration / (count - 1))


def kink(path: Path) -> float:
    """Change of direction where the path turns most, rad, looked at ever more closely: 0 unless it is a corner."""
    first, last = 0.0, path.duration * (1.01 if path.closed else 1.0)
    turn = math.inf
    for _ in range(4):
        times = np.linspace(first, last, 801)
        steps = np.diff([path.point(t) for t in times.tolist()], axis=0)
        turns = np.abs(np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))))
        sharpest = int(turns.argmax()) + 1
        first, last = times[max(0, sharpest - 2)], times[min(800, sharpest + 2)]
        turn = float(turns.max())
    return turn


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shape_stays_on_the_plate_unless_asked_otherwise(name: str) -> None:
    path = trajectories.build(name, {})
    check_inside(path, 0.06)
    assert length_of(path) > 0.05


@pytest.mark.parametrize("name", SHIPPED)
def test_every_number_of_a_shape_has_a_title_a_unit_and_a_default(name: str) -> None:
    for field in trajectories[name].Parameters.model_json_schema()["properties"].values():
        assert field["title"]
        assert "default" in field
        assert field["type"] not in ("number", "integer") or field["unit"]


@pytest.mark.parametrize("choice", CLOSED)
def test_a_closed_path_closes_and_goes_round_again(choice: tuple[str, dict[str, Any]]) -> None:
    path = build(choice)
    assert path.closed
    assert path.point(path.duration * (1.0 - 1e-12)) == pytest.approx(path.point(0.0), abs=1e-9)
    for share in (0.0, 0.3, 0.9):
        t = share * path.duration
        assert path.point(t + path.duration) == pytest.approx(path.point(t), abs=1e-9)


@pytest.mark.parametrize("choice", [("line", {}), ("spiral", {}), *LETTERS, OPEN_SPLINE])
def test_an_open_path_stays_at_its_end(choice: tuple[str, dict[str, Any]]) -> None:
    path = build(choice)
    assert not path.closed
    assert path.point(1e6) == pytest.approx(path.point(path.duration), abs=1e-12)


@pytest.mark.parametrize("choice", CONSTANT_SPEED)
def test_a_path_that_promises_a_constant_speed_keeps_it(choice: tuple[str, dict[str, Any]]) -> None:
    assert speeds_along(build(choice, speed_mm_s=4.0)) == pytest.approx(4e-3, rel=2e-3)


@pytest.mark.parametrize("choice", SMOOTH)
def test_a_smooth_path_has_no_kink(choice: tuple[str, dict[str, Any]]) -> None:
    assert kink(build(choice)) < 1e-4


def test_a_sharp_corner_is_a_kink() -> None:
    assert kink(trajectories.build("polygon", {"corner_radius_mm": 0.0})) >= math.pi / 4


@quick
@given(st.integers(1, 9), st.integers(1, 9), st.floats(-360.0, 360.0), sizes, sizes)
def test_a_lissajous_figure_fills_its_width_and_height(
    across: int, up: int, phase: float, width: float, height: float
) -> None:
    figure = trajectories.build(
        "lissajous",
        {
            "frequency_x": across,
            "frequency_y": up,
            "phase_deg": phase,
            "width_mm": width,
            "height_mm": height,
        },
    )
    low, high = points_of(figure, 2001).min(axis=0), points_of(figure, 2001).max(axis=0)
    assert low / MM == pytest.approx((-0.5 * width, -0.5 * height), rel=1e-3)
    assert high / MM == pytest.approx((0.5 * width, 0.5 * height), rel=1e-3)


def test_a_common_factor_of_the_waves_does_not_repeat_the_figure() -> None:
    plain, doubled = (
        trajectories.build("lissajous", {"frequency_x": 3 * k, "frequency_y": 2 * k}) for k in (1, 2)
    )
    assert points_of(doubled) == pytest.approx(points_of(plain))


@quick
@given(st.floats(0.0, 40.0), st.floats(0.2, 60.0), st.floats(0.1, 20.0), st.booleans(), speeds)
def test_a_spiral_leads_from_one_radius_to_the_other_at_its_speed(
    inner: float, wider: float, turns: float, inwards: bool, speed: float
) -> None:
    spiral = trajectories.build(
        "spiral",
        {
            "inner_radius_mm": inner,
            "outer_radius_mm": inner + wider,
            "turns": turns,
            "way": "in" if inwards else "out",
            "speed_mm_s": speed,
        },
    )
    radii = np.hypot(*points_of(spiral, 401).T) / MM
    ends = (inner + wider, inner) if inwards else (inner, inner + wider)
    assert (radii[0], radii[-1]) == pytest.approx(ends, abs=1e-6)
    assert np.all(np.diff(radii) * (-1.0 if inwards else 1.0) > -1e-9)
    assert length_of(spiral) / spiral.duration == pytest.approx(speed * MM, rel=2e-3)


@quick
@given(st.integers(3, 24), sizes, st.floats(0.0, 1.0), st.floats(-360.0, 360.0), speeds)
def test_a_polygon_lies_between_its_two_circles(
    corners: int, radius: float, share: float, rotation: float, speed: float
) -> None:
    inside = radius * math.cos(math.pi / corners)
    polygon = trajectories.build(
        "polygon",
        {
            "corners": corners,
            "radius_mm": radius,
            "corner_radius_mm": share * inside,
            "rotation_deg": rotation,
            "speed_mm_s": speed,
        },
    )
    radii = np.hypot(*points_of(polygon, 1001).T) / MM
    assert radii.min() >= inside * (1.0 - 1e-9)
    assert radii.max() <= radius * (1.0 + 1e-9)
    straight = 2.0 * corners * (1.0 - share) * inside * math.tan(math.pi / corners)
    assert polygon.duration * speed == pytest.approx(straight + 2.0 * math.pi * share * inside)


@pytest.mark.parametrize(("letter", "width"), [("S", 0.5), ("M", 0.8), ("U", 0.7)])
@quick
@given(sizes, st.floats(-100.0, 100.0), st.floats(-100.0, 100.0))
def test_a_letter_has_its_height_and_its_place(
    letter: str, width: float, height: float, x: float, y: float
) -> None:
    stroke = trajectories.build(
        "letter", {"letter": letter, "height_mm": height, "centre_x_mm": x, "centre_y_mm": y}
    )
    points = points_of(stroke, 2001) / MM
    extent = points.max(axis=0) - points.min(axis=0)
    tolerance = (0.1 if letter == "M" else 1e-3) * height
    assert extent == pytest.approx((width * height, height), abs=tolerance)
    assert 0.5 * (points.max(axis=0) + points.min(axis=0)) == pytest.approx((x, y), abs=0.5 * tolerance)


grid = st.tuples(st.integers(-50, 50), st.integers(-50, 50))


@quick
@given(
    st.lists(grid, min_size=3, max_size=12, unique=True),
    st.booleans(),
    st.sampled_from(["polyline", "spline"]),
)
def test_waypoints_are_passed_in_their_order(points: list[tuple[int, int]], closed: bool, kind: str) -> None:
    path = trajectories.build("waypoints", {"points_mm": points, "closed": closed, "kind": kind})
    walked = points_of(path, 4001) / MM
    reached = 0
    for point in points:
        near = np.hypot(*(walked[reached:] - point).T) < 2.0 * length_of(path) / MM / 4000.0
        assert near.any()
        reached += int(near.argmax())


@quick
@given(st.lists(grid, min_size=3, max_size=12, unique=True), st.booleans())
def test_a_spline_through_any_points_has_no_kink(points: list[tuple[int, int]], closed: bool) -> None:
    path = trajectories.build("waypoints", {"points_mm": points, "closed": closed, "kind": "spline"})
    assert kink(path) < 0.01


def test_thousands_of_waypoints_are_no_trouble() -> None:
    angles = np.linspace(0.0, 40.0, 2_000)
    radii = np.linspace(40.0, 20.0, 2_000)
    points = np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1).tolist()
    path = trajectories.build("waypoints", {"points_mm": points, "kind": "spline", "closed": False})
    assert path.point(0.0) == pytest.approx((0.04, 0.0))
    assert speeds_along(path, 4001) == pytest.approx(3e-3, rel=2e-3)


@pytest.mark.parametrize(
    ("name", "parameters", "complaint"),
    [
        ("polygon", {"corners": 4, "radius_mm": 10.0, "corner_radius_mm": 7.2}, "at most 7.071 mm"),
        ("polygon", {"corners": 2}, "greater than or equal to 3"),
        ("spiral", {"inner_radius_mm": 20.0, "outer_radius_mm": 20.0}, "less than the outer one, 20 mm"),
        ("spiral", {"turns": math.inf}, "finite"),
        ("letter", {"letter": "A"}, "'S', 'M' or 'U'"),
        ("lissajous", {"frequency_x": 2.5}, "integer"),
        ("circle", {"radius_mm": 1e-320}, "greater than or equal to 0.1"),
        ("circle", {"speed_mm_s": 1e-320}, "greater than or equal to 0.001"),
        ("waypoints", {"points_mm": [[0, 0], [1, 1]], "kind": "spline"}, "three different points"),
        ("waypoints", {"points_mm": [[0, 0], [5, 5], [5, 5 + 1e-9]]}, "points 2 and 3 are the same"),
        ("waypoints", {"points_mm": [[0, 0], [1e300, 0]]}, r"point 2 is .*; allowed: -500 to 500 mm"),
        ("waypoints", {"kind": "bezier"}, "'polyline' or 'spline'"),
    ],
)
def test_a_shape_that_cannot_be_drawn_is_refused_with_the_reason(
    name: str, parameters: dict[str, Any], complaint: str
) -> None:
    with pytest.raises(ValidationError, match=complaint):
        trajectories.build(name, parameters)


def test_a_saved_path_can_be_smooth() -> None:
    save_path("smooth bow", np.array([(0.0, 0.0), (0.01, 0.0), (0.01, 0.02)]), False, 0.002, "spline")
    bow = trajectories.build("smooth bow", {})
    assert length_of(bow) > 0.03
    assert kink(bow) < 1e-4
