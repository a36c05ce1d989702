"""What a supervisor sees: health over HTTP, and systemd's own way, by the unit that we give."""

import configparser
import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest

import server
from server.watching.health import SILENT, Pulse
from server.watching.tally import RigTally
from tests.processes import poll

EXAMPLES = Path(server.__file__).parent / "examples"
ROOT = Path(server.__file__).parents[1]


class Heard:
    """A socket as systemd's, and what has come over it."""

    def __init__(self, folder):
        self.place = folder / "notify"
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.bind(str(self.place))
        self._socket.settimeout(0.1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._socket.close()

    def next(self, within=30.0):
        end = time.monotonic() + within
        while time.monotonic() < end:
            try:
                return self._socket.recv(4096).decode()
            except TimeoutError:
                continue
        return ""

    def until(self, word):
        while heard := self.next():
            if word in heard:
                return heard
        raise AssertionError(f"{word} was not heard")


def unit():
    parser = configparser.ConfigParser(strict=False, interpolation=None)
    parser.optionxform = str  # type: ignore[assignment, method-assign]
    parser.read(EXAMPLES / "pivotrig.service")
    return parser["Service"]


def command_of_the_unit(data, port):
    """The unit's own command, with this program, folder and port in the place of the installed ones."""
    words = shlex.split(unit()["ExecStart"])
    assert words[0].endswith("/pivotrig")
    words[words.index("--data") + 1] = str(data)
    words[words.index("--port") + 1] = str(port)
    return [sys.executable, "-m", "server", *words[1:], "--sim"]


def test_the_unit_is_ready_alive_while_it_ticks_and_says_when_it_stops(tmp_path):
    with Heard(tmp_path) as systemd:
        environment = {**os.environ, "NOTIFY_SOCKET": str(systemd.place), "WATCHDOG_USEC": "400000"}
        program = subprocess.Popen(
            command_of_the_unit(tmp_path / "data", 0), env=environment,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            assert "READY=1" in systemd.until("READY=1")
            for _ in range(3):
                assert systemd.next(5.0) == "WATCHDOG=1"
            program.send_signal(signal.SIGSTOP)
            while systemd.next(1.0):
                pass  # what was on its way
            program.send_signal(signal.SIGCONT)
            systemd.until("WATCHDOG=1")
            program.terminate()
            systemd.until("STOPPING=1")
            assert program.wait(10) == 0
        finally:
            program.kill()
            program.wait()


def test_the_unit_asks_for_what_the_program_does():
    service = unit()
    assert service["Type"] == "notify"
    assert int(service["WatchdogSec"]) > 2 * SILENT
    assert service["KillSignal"] == "SIGTERM"
    assert {"ProtectSystem", "NoNewPrivileges", "DevicePolicy"} <= set(service)


def test_the_images_files_exist_and_its_command_is_one_of_ours(tmp_path):
    recipe = (EXAMPLES / "Dockerfile").read_text()
    for sources in re.findall(r"^COPY (?!--from)(.+) \S+$", recipe, re.MULTILINE):
        assert all((ROOT / source).exists() for source in sources.split())
    [arguments] = re.findall(r"^CMD \[(.+)\]$", recipe, re.MULTILINE)
    words = [word.strip().strip('"') for word in arguments.split(",")]
    words[words.index("--data") + 1], words[words.index("--port") + 1] = str(tmp_path), "0"
    program = subprocess.Popen(
        [sys.executable, "-m", "server", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        assert program.stdout is not None
        address = (
            program.stdout.readline().strip().removeprefix("dashboard: ").replace("0.0.0.0", "127.0.0.1")
        )
        assert httpx.get(f"{address}/api/v1/health").json()["status"] == "ok"
        assert httpx.get(f"{address}/api/v1/state").status_code == 401
    finally:
        program.terminate()
        _, said = program.communicate(timeout=10)
    assert len(re.findall(r"^admin token", said, re.MULTILINE)) == 1


class Stub:
    """A rig of which nothing is known but whether it has failed."""

    failure = None
    hangs = False


def test_a_loop_that_does_not_tick_is_not_healthy():
    now, ticks, rig = [100.0], RigTally(), Stub()
    pulse = Pulse(rig, ticks, lambda: now[0])  # type: ignore[arg-type]
    assert pulse.failing == ""
    ticks.last_at = now[0]
    now[0] += SILENT + 0.5
    assert "has not ticked for 2 s" in pulse.failing
    ticks.last_at = now[0]
    assert pulse.failing == ""
    rig.hangs = True
    assert "does not come back" in pulse.failing


@pytest.mark.anyio
async def test_health_answers_503_with_the_reason_when_the_loop_stands_still(at, api):
    assert (await api.get("/health")).json()["status"] == "ok"
    pulse = at.server.config.app.state.pulse
    clock = pulse._clock
    pulse._clock = lambda: clock() + 10.0
    try:
        answer = await api.get("/health")
    finally:
        pulse._clock = clock
    assert answer.status_code == 503
    assert answer.json()["status"] == "failing"
    assert "ticked" in answer.json()["reason"]
    poll(lambda: pulse.failing, lambda failing: failing == "")
