"""The board as a process of its own: a pseudo-terminal, a lock-step port, and the death of its world."""

from __future__ import annotations

import json
import math
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import pytest
from board_bench import CONFIGURATION

from control.link.conversion import DriveCommand
from control.link.port import Link
from control.simulation.lockstep import RemoteBoard

ALLOCATION = ((800.0, 0.0, 0.0), (0.0, 800.0, 0.0), (0.0, 0.0, 800.0))
COMMAND = DriveCommand(1, 0.0, 0.0, math.radians(25.0), 0.010, ALLOCATION, 0.2)


@dataclass
class Started:
    process: subprocess.Popen[str]
    serial: str
    control: str


@pytest.fixture
def started() -> Iterator[Started]:
    arguments = [sys.executable, "-m", "control.simulation.board_process", "--linger", "0.5"]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        line = process.stdout.readline()
        found = re.fullmatch(r"board: serial=(\S+) control=(tcp://127\.0\.0\.1:\d+)\n", line)
        assert found, line
        try:
            yield Started(process, found[1], found[2])
        finally:
            process.terminate()
            process.wait(10)


WALK = """
import sys, time
from control.simulation.lockstep import RemoteBoard
board = RemoteBoard(sys.argv[1], realtime=False)
while True:
    board.advance(10)
    time.sleep(0.005)
"""


def drive_until(link: Link, monitor: RemoteBoard, seconds: float) -> None:
    """Greets, arms and keeps driving."""
    end = time.monotonic() + seconds
    armed = False
    while time.monotonic() < end:
        link.poll()
        if link.is_ready:
            link.drive(COMMAND if armed else replace(COMMAND, start_heading=0.0))
            armed = True
        time.sleep(0.02)
    assert monitor.state()["state"] == "driving", link.reason


def test_a_killed_world_leaves_the_drive_at_zero_within_the_time_to_live(started: Started) -> None:
    monitor = RemoteBoard(started.control, realtime=False)
    world = subprocess.Popen([sys.executable, "-c", WALK, started.control])
    link = Link(started.serial, 500000, CONFIGURATION, time.monotonic)
    try:
        link.open()
        drive_until(link, monitor, 1.0)
        last_drive = monitor.take()[-1].milliseconds
        world.send_signal(signal.SIGKILL)
        world.wait(5)
        while monitor.state()["state"] != "expired":
            time.sleep(0.005)
        lived = [sample for sample in monitor.take() if sample.duty != (0, 0, 0)]
        assert lived[-1].milliseconds - last_drive <= 200 + 20  # bytes on their way when it died
        assert monitor.state()["mode"] == "run"
        assert monitor.state()["drive_is_zero"] is True
    finally:
        world.kill()
        world.wait(5)
        link.close()
        monitor.close()


def test_a_free_running_board_answers_on_its_terminal_and_stops_with_the_link(started: Started) -> None:
    monitor = RemoteBoard(started.control, realtime=True)
    link = Link(started.serial, 500000, CONFIGURATION, time.monotonic)
    try:
        link.open()
        drive_until(link, monitor, 0.6)
        assert link.status.round_trip is not None
        assert 0.0 < link.status.round_trip < 0.2
        link.close()
        deadline = time.monotonic() + 2.0
        while monitor.state()["state"] != "stopped" and time.monotonic() < deadline:
            time.sleep(0.005)
        assert monitor.state()["drive_is_zero"] is True
        assert monitor.state()["state"] == "stopped"
    finally:
        link.close()
        monitor.close()


def test_a_board_process_ends_soon_after_its_last_client(started: Started) -> None:
    client = RemoteBoard(started.control, realtime=False)
    assert json.dumps(client.state())
    client.close()
    assert started.process.wait(5) == 0


def test_a_board_process_ends_on_sigterm(started: Started) -> None:
    client = RemoteBoard(started.control, realtime=False)
    started.process.terminate()
    assert started.process.wait(5) == 0
    client.close()
