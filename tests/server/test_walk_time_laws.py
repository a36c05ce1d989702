"""Approach and time laws in a run on the simulated rig, and waypoints from a file on the command line."""

import math
from pathlib import Path

import pytest
from typer.testing import CliRunner

from control.gait import Gait, TimeLaw
from control.news import Ended
from control.runs import Choice, RunRequest, Selection
from control.snapshot import Snapshot
from server.assembly import build_machine
from server.cli import app
from server.headless import run_headless
from server.settings import RigFile

LINE = Choice("line", {"start_x_mm": 0.0, "start_y_mm": -30.0, "end_x_mm": 10.0, "end_y_mm": -30.0})
"""The simulated robot starts at (0, -42) mm, 12 mm below its start."""


def walked(gait: Gait) -> tuple[Ended, list[Snapshot]]:
    seen: list[Snapshot] = []
    selection = Selection(Choice("geometric"), LINE, gait)
    done = run_headless(
        build_machine(RigFile(), realtime=False), "one", RunRequest(selection, duration=12.0), seen.append
    )
    return done.ended, [snapshot for snapshot in seen if snapshot.run is not None]


def test_a_run_walks_to_its_path_before_errors_and_passes_count() -> None:
    gait = Gait(math.radians(15.0), time_law=TimeLaw.CONSTANT_SPEED, speed=0.004, approach=True)
    ended, seen = walked(gait)
    approach, path = 0.012 / 0.004, 0.010 / 0.004
    assert ended.metrics.duration == pytest.approx(approach + path, abs=0.1)
    assert ended.metrics.ticks == pytest.approx(60 * path, abs=5)
    assert ended.metrics.max_error < 0.006
    approaching = [snapshot for snapshot in seen if snapshot.run and snapshot.run.elapsed < 0.95 * approach]
    assert {snapshot.run.passes_done for snapshot in approaching if snapshot.run} == {0.0}
    assert all(snapshot.reference and abs(snapshot.reference[0]) < 1e-3 for snapshot in approaching)


def test_a_run_ends_when_a_waiting_reference_has_been_followed_to_the_end() -> None:
    gait = Gait(math.radians(15.0), time_law=TimeLaw.WAIT, speed=0.02, wait_distance=0.002, approach=True)
    ended, seen = walked(gait)
    at_full_speed = 0.022 / 0.02
    assert 2.0 * at_full_speed < ended.metrics.duration < 12.0
    last = seen[-1]
    assert last.pose is not None
    assert last.pose.distance_to(0.010, -0.030) < 0.005


@pytest.mark.parametrize(
    ("content", "arguments", "complaint"),
    [
        ("x_mm,y_mm\n0,0\n0,oops", [], "line 3 is '0,oops'; allowed: two numbers in mm"),
        ("0,0\n70,0", [], "the workspace ends at ±60 mm"),
        ("0,0\n0,0", [], "points 1 and 2 are the same"),
        ("0,0\n9,0", ["--set", "trajectory.points_mm=[[0,0],[1,1]]"], "drop one"),
        ("0,0\n9,0", ["--trajectory", "eight"], "the points of --trajectory waypoints, not of 'eight'"),
    ],
)
def test_a_file_that_is_no_path_is_explained(
    tmp_path: Path, content: str, arguments: list[str], complaint: str
) -> None:
    file = tmp_path / "points.csv"
    file.write_text(content, encoding="utf-8")
    answer = run_with_file(file, *arguments)
    assert answer.exit_code == 2
    assert complaint in answer.stderr


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    answer = run_with_file(tmp_path / "none.csv")
    assert answer.exit_code == 2
    assert "none.csv: No such file" in answer.stderr


def test_a_picture_is_not_a_path(tmp_path: Path) -> None:
    (tmp_path / "photo.csv").write_bytes(b"\x89PNG\xff\xfe")
    answer = run_with_file(tmp_path / "photo.csv")
    assert answer.exit_code == 2
    assert "is not a text file" in answer.stderr


def test_waypoints_from_a_file_are_walked(tmp_path: Path) -> None:
    file = tmp_path / "points.json"
    file.write_text("[[0, -42], [0, -30], [10, -30]]", encoding="utf-8")
    answer = run_with_file(file, "--set", "trajectory.kind=spline", "--duration", "1")
    assert answer.exit_code == 0
    assert '"state": "finished"' in answer.stdout


def run_with_file(file: Path, *arguments: str):
    walk = ["run", "--json", "--trajectory", "waypoints", "--set", f"trajectory.file={file}"]
    return CliRunner().invoke(app, [*walk, *arguments])
