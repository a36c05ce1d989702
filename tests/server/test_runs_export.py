"""`pivotrig runs export`, and the README's reader, on a fresh recording."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.commands.runs import app
from server.commands.runs_export import FormatName
from tests.server.walked_run import walk

ID = "20261123-093000-a1b2"
NAME = f"{ID}_second-walk"
README = Path(__file__).parents[2] / "README.md"


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    walk(folder, ID, duration=1.5, label="second walk")
    return folder


@pytest.fixture
def export(data, tmp_path, monkeypatch):
    """Runs the command in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return lambda *arguments: CliRunner().invoke(app, ["export", *arguments, "--data", str(data)])


def test_several_formats_at_once_are_named_after_the_run(export, tmp_path):
    answer = export("last", "--format", "csv", "--format", "parquet", "--format", "mcap")
    assert answer.exit_code == 0, answer.output
    names = [f"{NAME}.csv", f"{NAME}.parquet", f"{NAME}.mcap"]
    assert answer.stdout.splitlines() == names
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)


def test_without_a_format_it_is_a_table(export, tmp_path):
    assert export(ID).exit_code == 0
    assert (tmp_path / f"{NAME}.csv").read_text().startswith("time_s,tick,")


def test_a_film_is_made_with_overlay_at_the_place_that_is_named(export, tmp_path):
    answer = export(ID[:12], "--format", "mp4", "--overlay", "--out", "films/walk.mp4", "--json")
    assert answer.exit_code == 0, answer.output
    (made,) = json.loads(answer.stdout)["files"]
    assert made == {
        "format": "mp4",
        "file": "films/walk.mp4",
        "size_bytes": (tmp_path / "films" / "walk.mp4").stat().st_size,
    }


def test_nothing_is_overwritten_unless_it_is_asked_for(export, tmp_path):
    (tmp_path / "walk.csv").write_text("mine")
    answer = export(ID, "--out", "walk.csv")
    assert answer.exit_code == 2
    assert (tmp_path / "walk.csv").read_text() == "mine"
    assert export(ID, "--out", "walk.csv", "--force").exit_code == 0
    assert (tmp_path / "walk.csv").read_text() != "mine"
    assert [path.name for path in tmp_path.iterdir()] == ["walk.csv"], "no half-made file is left"


def test_an_export_that_fails_leaves_nothing_and_says_why(export, data, tmp_path):
    damaged = data / "recordings" / f"{ID}.mcap"
    whole = damaged.read_bytes()
    damaged.write_bytes(b"rubbish")
    try:
        answer = export(ID, "--out", "walk.csv")
    finally:
        damaged.write_bytes(whole)
    assert answer.exit_code == 1
    assert "no recording that can be read" in answer.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("id", ["2019", "nothing"])
def test_a_run_that_is_not_there_is_wrong_usage(export, id):
    assert export(id).exit_code == 2


def example() -> str:
    """The README's program that reads a recording and a table."""
    (found,) = (
        block
        for block in re.findall(r"```python\n(.*?)```", README.read_text("utf-8"), re.S)
        if "make_reader" in block
    )
    return found


def test_the_readme_s_reader_draws_a_fresh_recording(export, tmp_path):
    for format in (FormatName.MCAP, FormatName.PARQUET):
        assert export(ID, "--format", format, "--out", f"run.{format}").exit_code == 0
    program = tmp_path / "example.py"
    program.write_text(example(), "utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", str(program)],
        cwd=tmp_path,
        env={**os.environ, "MPLBACKEND": "agg"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "run.png").read_bytes().startswith(b"\x89PNG")
