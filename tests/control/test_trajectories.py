"""Reference paths."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from control.registry import UnknownName
from control.trajectories import OutsideWorkspace, check_inside, trajectories
from control.trajectories.custom import save_path
from control.trajectories.trajectory import length_of, points_of

SHIPPED = ("eight", "line", "circle", "waypoints")


@pytest.mark.parametrize("name", SHIPPED)
def test_the_default_path_stays_on_the_plate(name: str) -> None:
    check_inside(trajectories.build(name, {}), 0.06)


@pytest.mark.parametrize("name", SHIPPED)
def test_every_parameter_has_a_title_and_a_default(name: str) -> None:
    for field in trajectories[name].Parameters.model_json_schema()["properties"].values():
        assert field["title"]
        assert "default" in field


@pytest.mark.parametrize("name", ["line", "circle", "waypoints"])
def test_constant_speed_paths_keep_their_speed(name: str) -> None:
    trajectory = trajectories.build(name, {"speed_mm_s": 2.0})
    assert length_of(trajectory) / trajectory.duration == pytest.approx(0.002, rel=1e-3)


def test_the_eight_is_the_papers() -> None:
    eight = trajectories.build("eight", {})
    for t in (0.0, 17.0, 63.0, 125.0):
        expected = -0.04 * math.sin(0.1 * t), -0.04 * math.cos(0.05 * t)
        assert eight.point(t) == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("name", ["eight", "circle", "waypoints"])
def test_a_closed_path_goes_round_again(name: str) -> None:
    trajectory = trajectories.build(name, {})
    for share in (0.0, 0.3, 0.9):
        t = share * trajectory.duration
        assert trajectory.point(t + trajectory.duration) == pytest.approx(trajectory.point(t), abs=1e-9)


def test_an_open_path_waits_at_its_end() -> None:
    line = trajectories.build("line", {"end_x_mm": 10.0, "end_y_mm": 0.0})
    assert line.point(1e6) == pytest.approx((0.010, 0.0))


def test_waypoints_are_all_visited() -> None:
    corners = [(-0.035, -0.035), (-0.035, 0.035), (0.035, 0.035), (0.035, -0.035)]
    points = points_of(trajectories.build("waypoints", {}), 2000)
    for corner in corners:
        assert np.hypot(*(points - corner).T).min() < 1e-4


def test_a_path_that_leaves_the_workspace_says_where() -> None:
    with pytest.raises(OutsideWorkspace, match=r"70\.0.*±60 mm"):
        check_inside(trajectories.build("line", {"end_x_mm": 70.0}), 0.06)


@pytest.mark.parametrize(
    "parameters",
    [
        {"speed_mm_s": math.nan},
        {"speed_mm_s": 0.0},
        {"speed_mm_s": math.inf},
        {"colour": "red"},
        {"start_x_mm": 0, "start_y_mm": 1, "end_x_mm": 0, "end_y_mm": 1},
    ],
)
def test_bad_parameters_are_refused(parameters: dict[str, float]) -> None:
    with pytest.raises(ValidationError):
        trajectories.build("line", parameters)


def test_an_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(UnknownName, match=r"no trajectory called 'nine'.*eight"):
        trajectories.build("nine", {})


def test_a_saved_path_becomes_a_trajectory_with_a_speed_to_choose() -> None:
    save_path("test bow", np.array([(0.0, 0.0), (0.01, 0.0), (0.01, 0.02)]), closed=False, speed=0.002)
    bow = trajectories.build("test bow", {"speed_mm_s": 6.0})
    assert bow.duration == pytest.approx(5.0)
    assert bow.point(1e3) == pytest.approx((0.01, 0.02))
    with pytest.raises(ValueError, match="registered already"):
        save_path("test bow", np.array([(0.0, 0.0), (0.01, 0.0)]), closed=False, speed=0.002)


def test_no_single_corner_slips_out_of_the_workspace() -> None:
    points = [(30.0 * math.cos(i / 100), 30.0 * math.sin(i / 100)) for i in range(1999)]
    points.insert(1000, (0.0, 60.5))
    with pytest.raises(OutsideWorkspace, match=r"60\.5"):
        check_inside(trajectories.build("waypoints", {"points_mm": points, "speed_mm_s": 50.0}), 0.06)
