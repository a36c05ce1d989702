"""A third-party controller that hangs: the coils go to zero, the page says why, and the program can be ended."""

import asyncio
import json
import re
import signal
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import connect
from websockets.sync.connection import Connection

from control.simulation.lockstep import RemoteBoard
from server.watchdog import Watchdog
from tests.processes import Server, ServerRefused, poll, served, started

HANGS = """
import time
from pathlib import Path
from control.controllers import Decision, controllers
from control.registry import Parameters

MARK = Path({mark!r})

def for_ever():
    while True:
        pass

def for_two_seconds():
    time.sleep(2.0)

class Hanging:
    summary, Parameters = "hangs after a second", Parameters
    def __init__(self, parameters):
        self.left = 60
    def step(self, situation):
        self.left -= 1
        if self.left == 0:
            MARK.touch()
            self.hang()
        return Decision(situation.pivot, 0.5)

@controllers.register
class ForEver(Hanging):
    name = title = "busy for ever"
    hang = staticmethod(for_ever)

@controllers.register
class ForAWhile(Hanging):
    name = title = "asleep for a while"
    hang = staticmethod(for_two_seconds)
"""


@pytest.fixture
def mark(tmp_path: Path) -> Path:
    """Comes into being at the instant at which the controller hangs."""
    return tmp_path / "hanging"


@pytest.fixture
def plugin(tmp_path: Path, mark: Path) -> Path:
    path = tmp_path / "hang.py"
    path.write_text(HANGS.format(mark=str(mark)))
    return path


@pytest.fixture
def board(tmp_path: Path) -> Iterator[tuple[RemoteBoard, Path]]:
    """A board in a process of its own, as in a real rig, and the rig file that leads to it."""
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "20") as (_, line):
        found = re.fullmatch(r"board: serial=(\S+) control=(\S+)", line)
        assert found is not None, line
        port, control = found.groups()
        rig_file = tmp_path / "rig.toml"
        rig_file.write_text(f'[link]\nport = "{port}"\n[simulation]\nboard = "{control}"\n')
        monitor = RemoteBoard(control, realtime=True)
        yield monitor, rig_file
        monitor.close()


def walk_until_it_hangs(server: Server, controller: str, mark: Path) -> float:
    """When the controller began to hang."""
    server.until(lambda state: state["tracking"] == "locked" and not state["faults"])
    server.post("/arm")
    server.post("/runs", {"controller": {"name": controller}})
    poll(mark.exists, bool)
    return time.monotonic()


@pytest.mark.exclusive
def test_a_controller_that_never_answers_loses_the_coils_and_is_named(
    board: tuple[RemoteBoard, Path], plugin: Path, mark: Path, tmp_path: Path
) -> None:
    monitor, rig_file = board
    with served(tmp_path / "data", "--rig", str(rig_file), "--plugin", str(plugin)) as server:
        began = walk_until_it_hangs(server, "busy for ever", mark)
        state = server.until(lambda state: state["rig"] == "fault")
        assert time.monotonic() - began <= 1.0
        assert "controller 'busy for ever' hangs" in state["reason"]
        assert state["faults"][0]["code"] == "controller"
        assert (state["run"], state["currents_A"]) == (None, [0.0, 0.0, 0.0])
        time.sleep(0.2)
        assert not any(monitor.take()[-1].duty)
        assert server.get("/runs")["runs"][0]["state"] == "aborted"
        assert server.post("/estop")["rig"] == "fault"
        with pytest.raises(ServerRefused, match=r"409.*restart pivotrig"):
            server.post("/reset")
        asked = time.monotonic()
        server.process.send_signal(signal.SIGTERM)
        server.process.wait(10)
        assert time.monotonic() - asked <= 5.0


def test_a_controller_that_comes_back_finds_the_way_to_the_coils_closed(
    plugin: Path, mark: Path, tmp_path: Path
) -> None:
    with served(tmp_path / "data", "--sim", "--plugin", str(plugin)) as server:
        walk_until_it_hangs(server, "asleep for a while", mark)
        server.until(lambda state: state["rig"] == "fault")
        time.sleep(2.0)
        state = server.until(lambda state: max(map(abs, state["measured_currents_A"])) < 0.4)
        assert state["rig"] == "fault"
        assert "controller 'asleep for a while' hangs" in state["reason"]
        assert server.post("/reset")["rig"] == "disarmed"
        run = server.get("/runs")["runs"][0]
        assert (run["state"], run["metrics"]["ticks"] > 0) == ("aborted", True)


def test_a_rig_that_was_seen_at_fault_is_never_shown_walking_when_its_controller_comes_back(
    plugin: Path, mark: Path, tmp_path: Path
) -> None:
    with served(tmp_path / "data", "--sim", "--plugin", str(plugin)) as server:
        address = f"{server.address.replace('http', 'ws')}/api/v1/telemetry"
        with connect(address, proxy=None, max_size=None) as line:
            walk_until_it_hangs(server, "asleep for a while", mark)
            rigs = [tick["rig"] for tick in ticks_until_it_ticks_again(line)]
    assert set(rigs[rigs.index("fault") :]) == {"fault"}


def ticks_until_it_ticks_again(line: Connection) -> Iterator[dict[str, Any]]:
    """Of a rig that comes to its fault and stays there for ten ticks of its loop."""
    stopped_at = None
    while True:
        message = json.loads(line.recv(timeout=10.0))
        if message["type"] != "tick":
            continue
        yield message
        if stopped_at is None and message["rig"] == "fault":
            stopped_at = message["tick"]
        if stopped_at is not None and message["tick"] > stopped_at + 10:
            return


@pytest.mark.anyio
async def test_a_tick_that_is_only_slow_is_waited_for() -> None:
    with ThreadPoolExecutor(1) as thread:
        tick = asyncio.get_running_loop().run_in_executor(thread, lambda: time.sleep(0.3) or "done")
        assert await Watchdog(lambda: "").wait(tick) is None
        assert tick.result() == "done"


@pytest.mark.anyio
async def test_a_loop_that_stands_still_outside_a_controller_is_noticed_too() -> None:
    tick = asyncio.get_running_loop().create_future()
    hang = await Watchdog(lambda: "").wait(tick)
    assert hang is not None
    assert hang.code == "stall"
