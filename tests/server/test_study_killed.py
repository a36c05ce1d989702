"""A study that is killed, stopped or ended at any moment loses no finished run, repeats none, leaves nobody behind."""

import contextlib
import json
import os
import random
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from study_bench import carried_out, definition, table_of

from server.studies.store import StudyStore

PATIENCE = 60.0
MOMENT = 0.05
"""Longest wait for the random moment in a piece of work, s."""
STUDY = definition(40, duration_s=0.2)
RUNS = STUDY.plan().total
PROCESSES = Path("/proc")


class Mortal:
    """The program in `mortal_study.py`."""

    def __init__(self):
        script = Path(__file__).with_name("mortal_study.py")
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        read, write = os.pipe()
        self._process = subprocess.Popen(
            [sys.executable, script, str(write)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
            env=environment,
            pass_fds=(write,),
        )
        os.close(write)
        assert self._process.stdin is not None
        self._orders, self._answers = self._process.stdin, os.fdopen(read)

    def start(self, *arguments):
        """Number of the process that carries out a command."""
        print(json.dumps(list(map(str, arguments))), file=self._orders, flush=True)
        return int(self._line())

    def exit_code(self):
        """How it ended; negative for a signal."""
        return int(self._line())

    def _line(self):
        ready, _, _ = select.select([self._answers], [], [], PATIENCE)
        assert ready, "it says nothing any more"
        return self._answers.readline()

    def close(self):
        self._orders.close()
        self._process.wait(PATIENCE)
        self._answers.close()


@pytest.fixture(scope="module")
def mortal():
    program = Mortal()
    yield program
    program.close()


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """The table when nothing comes between."""
    return table_of(tmp_path_factory.mktemp("uninterrupted"), STUDY)


def begun(data):
    return StudyStore(data).create(STUDY)


def written(study):
    """Rows on the disk."""
    file = study.folder / "results.jsonl"
    return file.read_bytes().count(b"\n") if file.exists() else 0


def until(condition):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def session_of(leader):
    """All processes, but zombies, of the session that a command was started in."""
    found = []
    for folder in PROCESSES.iterdir():
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if fields[3] == str(leader) and fields[0] != "Z":
            found.append(int(folder.name))
    return found


@pytest.mark.timeout(600)
def test_a_study_killed_at_any_moment_gives_the_same_table_to_the_byte(mortal, expected, tmp_path, full):
    chance = random.Random()
    for attempt in range(20 if full else 3):
        data = tmp_path / str(attempt)
        study = begun(data)
        jobs = 1 + (attempt % 2 if full else 0)
        process = mortal.start("studies", "resume", study.id, "--data", data, "--jobs", jobs)
        wanted = chance.randrange(RUNS)
        until(lambda study=study, wanted=wanted: written(study) >= wanted)
        time.sleep(chance.uniform(0.0, MOMENT))
        with contextlib.suppress(ProcessLookupError):  # it was as quick as that
            os.kill(process, signal.SIGKILL)
        mortal.exit_code()
        file = study.folder / "results.jsonl"
        left = file.read_bytes() if file.exists() else b""
        finished = left[: left.rfind(b"\n") + 1]
        carried_out(study)
        assert study.table().csv() == expected
        assert file.read_bytes().startswith(finished)
        assert len(file.read_bytes().splitlines()) == RUNS


def test_no_worker_outlives_a_command_that_is_killed(mortal, tmp_path):
    study = begun(tmp_path)
    process = mortal.start("studies", "resume", study.id, "--data", tmp_path, "--jobs", 2)
    until(lambda: len(session_of(process)) > 2)
    os.kill(process, signal.SIGKILL)
    mortal.exit_code()
    until(lambda: not session_of(process))
    assert json.loads((study.folder / "state.json").read_bytes())["state"] == "running"  # as it was killed
    assert (study.state, study.reason) == ("interrupted", "the program that carried it out was ended")


def test_ctrl_c_leaves_a_study_that_goes_on_with_other_workers(mortal, expected, tmp_path):
    study = begun(tmp_path)
    process = mortal.start("studies", "resume", study.id, "--data", tmp_path, "--jobs", 2)
    until(lambda: written(study))
    os.killpg(process, signal.SIGINT)
    assert mortal.exit_code() == 1
    until(lambda: not session_of(process))
    assert (study.state, study.reason) == ("stopped", "stopped by the operator")
    carried_out(study)
    assert study.table().csv() == expected


@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGHUP])
def test_a_polite_end_interrupts_a_study_in_order(mortal, tmp_path, sent):
    study = begun(tmp_path)
    process = mortal.start("studies", "resume", study.id, "--data", tmp_path, "--jobs", 1)
    until(lambda: written(study))
    os.kill(process, sent)
    assert mortal.exit_code() == 1
    assert json.loads((study.folder / "state.json").read_bytes())["state"] == study.state == "interrupted"
