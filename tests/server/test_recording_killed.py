"""A program that is killed while it records loses at most 1.25 s (faults.md, row 24), and nothing after that."""

import contextlib
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
from server.recording.reading.listing import listed
from server.recording.reading.recording import Recording
from server.recording.recovery.recover import recover
from tests.processes import poll, served

pytestmark = pytest.mark.exclusive

LOST_AT_MOST = 1.25
"""s of rig time between the last tick that was walked and the last one that is in the file."""
WALKS_FOR = 1.5
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
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._to, self._from = self._process.stdin, self._process.stdout

    def walk_until_killed(self, id, after):
        """Rig times of the first and the last tick that it told, s.  after: the first one, s."""
        self._to.write(f"{id}\n".encode())
        self._to.flush()
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
        ready, _, _ = select.select([self._from], [], [], PATIENCE)
        assert ready, "it says nothing any more"
        return self._from.readline().decode().strip()

    def close(self):
        self._to.close()
        self._from.close()
        self._process.wait(PATIENCE)


@pytest.fixture
def mortal(tmp_path):
    program = Mortal(tmp_path)
    yield program
    program.close()


@pytest.mark.timeout(1200)
def test_a_run_killed_at_any_moment_loses_at_most_a_second_and_a_quarter(mortal, tmp_path, full):
    chance, folder = random.Random(), tmp_path / "recordings"
    lost, ticks = [], {}
    for attempt in range(50 if full else 5):
        id = f"killed-{attempt}"
        first, last = mortal.walk_until_killed(id, chance.uniform(0.0, WALKS_FOR))
        path = folder / f"{id}.mcap"
        ticks[id] = read_all(path)
        lost.append(last - (ticks[id][-1]["/state"]["time_s"] if ticks[id] else first))
        assert not path.exists() or ticks_by_public_reader(path) == len(ticks[id])
    print(f"lost: at most {max(lost):.3f} s, on average {sum(lost) / len(lost):.3f} s of {len(lost)} runs")
    assert max(lost) <= LOST_AT_MOST
    check_recovered(tmp_path, ticks)


def check_recovered(data, ticks):
    """Every file is whole, holds what it held, and its run is listed as interrupted.

    A run that was killed before anything of it was written leaves no file, or one with nothing but its settings.
    """
    with contextlib.closing(Catalogue.open(data)) as catalogue:
        recovered = {each.id for each in recover(data / "recordings", catalogue) if each.is_recovered}
        assert recovered >= {id for id, known in ticks.items() if known}
        for id in recovered:
            path = data / "recordings" / f"{id}.mcap"
            assert examine(path).message_count >= len(ticks[id])
            assert read_all(path) == ticks[id]
            record = catalogue.get(id)
            assert (record.state, record.recording_state) == ("interrupted", "recovered")
            assert record.metrics is not None or not ticks[id]


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
