"""The examples for scripts, each run as it stands against a real server."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import server as server_package
from tests.processes import served

pytestmark = pytest.mark.exclusive  # a robot that walks on a busy machine is held

SCRIPTS = Path(server_package.__file__).parent / "examples" / "scripts"
LONGEST = 60
"""Lines of an example: a page that one reads at a glance."""

SAYS = {
    "01_watch": "loop: ",
    "02_walk": "eight.csv: ",
    "03_own_path": "chosen: my bow",
    "04_jog": "turned by ",
    "05_telemetry": "heard: server",
    "06_study": "study.csv: 12 rows",
    "07_overnight": "sweep 30°: finished",
    "08_camera_fault": "held: ",
}


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    with served(tmp_path_factory.mktemp("data"), "--sim", "--demand-token") as server:
        assert server.process.stderr is not None
        token = server.process.stderr.readline().split(": ")[1].strip()
        yield server, token


def run(script, address, token, folder):
    return subprocess.run(
        [sys.executable, str(SCRIPTS / f"{script}.py"), address],
        cwd=folder, env={**os.environ, "PIVOTRIG_TOKEN": token}, capture_output=True, text=True, timeout=180,
    )  # fmt: skip


def test_every_example_is_tried_and_short():
    found = {path.stem: path for path in SCRIPTS.glob("[0-9]*.py")}
    assert set(found) == set(SAYS)
    assert all(len(path.read_text().splitlines()) <= LONGEST for path in found.values())


@pytest.mark.parametrize("script", SAYS)
def test_an_example_does_what_it_says(rig, tmp_path, script):
    server, token = rig
    done = run(script, server.address, token, tmp_path)
    assert done.returncode == 0, done.stderr + done.stdout
    assert SAYS[script] in done.stdout


def test_an_example_that_is_refused_says_why_and_fails(rig, tmp_path):
    server, _ = rig
    done = run("01_watch", server.address, "wrong", tmp_path)
    assert done.returncode == 1
    assert "no token of this rig" in done.stderr
