"""A program that is killed while it records loses at most 1.25 s (faults.md, row 24), and nothing after that."""

import os
import random
import select
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from mcap_doctor import examine
from recordings_bench import RecordingsBench
from torn_files import newest_tick, read_all, ticks_by_public_reader

from server.catalogue.catalogue import Catalogue
from server.recording.listing import listed
from server.recording.reading import Recording
from server.recording.recovery import recover
from tests.processes import poll, served

pytestmark = pytest.mark.exclusive

LOST_AT_MOST = 1.25
"""s of rig time between the last tick that was walked and the last one that is in the file."""
WALKS_FOR = 2.5
"""At most so long, s, before it is killed."""
PATIENCE = 60.0


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    data = tmp_path_factory.mktemp("recorded")
    return data / "recordings" / f"{RecordingsBench().record(data)}.mcap"


class Mortal:
    """The program in `mortal.py`."""

    def __init__(self, data):
        script = Path(__file__).with_name("mortal.py")
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        self._process = subprocess.Popen(
            [sys.executable, script, data], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
        )

    def walk_until_killed(self, id, after):
        """Rig times of the first and the last tick that it told, s.  after: the first one, s."""
        self._process.stdin.write(f"{id}\n".encode())
        self._process.stdin.flush()
        pid = int(self._line())
        first = last = float(self._line())
        until = time.monotonic() + after
        while time.monotonic() < until:
            last = float(self._line())
        os.kill(pid, signal.SIGKILL)
        while (line := self._line()) != "dead":
            last = float(line)
        return first, last

    def _line(self):
        ready, _, _ = select.select([self._process.stdout], [], [], PATIENCE)
        assert ready, "it says nothing any more"
        return self._process.stdout.readline().decode().strip()

    def close(self):
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait(PATIENCE)


@pytest.fixture
def mortal(tmp_path):
    program = Mortal(tmp_path)
    yield program
    program.close()


def test_a_run_killed_at_any_moment_loses_at_most_a_second_and_a_quarter(mortal, tmp_path, full):
    chance, folder = random.Random(), tmp_path / "recordings"
    lost, ticks = [], {}
    for attempt in range(50 if full else 5):
        id = f"killed-{attempt}"
        first, last = mortal.walk_until_killed(id, chance.uniform(0.0, WALKS_FOR))
        path = folder / f"{id}.mcap"
        ticks[id] = read_all(path) or []
        lost.append(last - (ticks[id][-1]["/state"]["time_s"] if ticks[id] else first))
        assert ticks_by_public_reader(path) == len(ticks[id])
    print(f"lost: at most {max(lost):.3f} s, on average {sum(lost) / len(lost):.3f} s of {len(lost)} runs")
    assert max(lost) <= LOST_AT_MOST
    check_recovered(tmp_path, ticks)


def check_recovered(data, ticks):
    """Every file is whole, holds what it held, and its run is listed as interrupted."""
    catalogue = Catalogue.open(data)
    try:
        assert {each.id for each in recover(data / "recordings", catalogue)} == set(ticks)
        for id, known in ticks.items():
            path = data / "recordings" / f"{id}.mcap"
            assert examine(path).message_count >= len(known)
            assert read_all(path) == known
            record = catalogue.get(id)
            assert (record.state, record.recording_state) == ("interrupted", "recovered")
            assert record.metrics is not None or not known
    finally:
        catalogue.close()


def test_a_server_lists_what_the_last_one_left_behind_and_leaves_as_little_itself(recorded, tmp_path):
    left = torn_copy(recorded, tmp_path)
    with served(tmp_path) as server:
        run = poll(lambda: server.get(f"/runs/{left.stem}"), lambda run: run["state"] != "running")
        assert (run["state"], run["recording"]["state"]) == ("interrupted", "recovered")
        assert run["metrics"]["ticks"] > 0
        server.start_walking()
        state = server.until(lambda state: state["run"]["elapsed_s"] > 1.5)
        server.process.kill()
        server.process.wait()
    path = left.with_name(f"{state['run']['id']}.mcap")
    assert newest_tick(path)["/state"]["time_s"] > state["time_s"] - LOST_AT_MOST


def torn_copy(recorded, data):
    """As a program leaves it that is killed when three quarters are written."""
    path = data / "recordings" / recorded.name
    path.parent.mkdir()
    path.write_bytes(recorded.read_bytes()[: recorded.stat().st_size * 3 // 4])
    catalogue = Catalogue.open(data)
    with Recording.open(path) as recording:
        catalogue.add(replace(listed(path.stem, recording), state="running", recording_state="writing"))
    catalogue.close()
    return path
