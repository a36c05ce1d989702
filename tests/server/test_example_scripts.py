"""The examples for scripts, each run as it stands against a real server."""

import os
import socket
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

import server as server_package
from tests.processes import served
from tests.real_rig import real_rig

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


def test_a_night_that_is_refused_a_run_ends_disarmed(rig, tmp_path):
    server, token = rig
    for name in ("rig.py", "07_overnight.py"):
        (tmp_path / name).write_text((SCRIPTS / name).read_text().replace("(20, 30)", "(20, 900)"))
    done = run(tmp_path / "07_overnight", server.address, token, tmp_path)
    assert done.returncode == 1
    assert "sweep 20°: finished" in done.stdout
    assert "not 900" in done.stderr
    with httpx.Client(headers={"Authorization": f"Bearer {token}"}) as client:
        assert client.get(f"{server.address}/api/v1/state").json()["rig"] == "disarmed"


def test_a_real_rig_is_left_alone_by_the_fault_example(tmp_path):
    with real_rig(tmp_path) as rig_file, served(tmp_path / "data", "--rig", str(rig_file)) as server:
        done = run("08_camera_fault", server.address, "", tmp_path)
        assert done.returncode == 1
        assert "This rig is real" in done.stderr
        assert server.get("/runs")["total"] == 0


def test_an_example_without_a_server_says_so(tmp_path):
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        done = run("01_watch", f"http://127.0.0.1:{nobody.getsockname()[1]}", "", tmp_path)
    assert done.returncode == 1
    assert "does its server run?" in done.stderr
    assert "Traceback" not in done.stderr
