"""A run's start does not hold the rig up: the board and the camera's pictures are attended to all the while.

The board is in a process of its own, as on a real rig, so that it does not wait for a server that stands still.
"""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from control.arbiter import FRAME_TOO_LATE
from server.catalogue.shelf import RECORDINGS, file_of
from server.recording.reading.recording import Recording
from tests.processes import Server, poll, served, started

SEARCHES = """
import gc
from pathlib import Path
from control.controllers import Decision, controllers
from control.registry import Parameters

@controllers.register
class Searching:
    name = "searching"
    title = "Looks for garbage"
    summary = "lets Python search for garbage when the robot begins to walk, as it may happen at any time"
    Parameters = Parameters
    def __init__(self, parameters):
        self.is_done = False
    def step(self, situation):
        if not self.is_done:
            gc.collect()
            Path({mark!r}).touch()
        self.is_done = True
        return Decision(situation.pivot, 0.5)
"""
STARTS = (
    ("geometric", "eight"),
    ("planner", "eight"),
    ("gradient", "circle"),
    ("planner", "letter"),
    ("geometric", "line"),
    ("planner", "lissajous"),
    ("gradient", "polygon"),
    ("planner", "spiral"),
    ("straight", "eight"),
    ("searching", "circle"),
)
"""Controller and path of each run; the first one also is the first that this server carries out."""
BEGUN = 0.6
"""So long after its start a run has begun, s: the field is up after 0.25 s, then the robot is on its way."""
LATE = {"stall", "clock", "camera", "late", "expired", "telemetry"}
"""What the event log calls it when pictures or the board have waited for the loop."""


@dataclass(frozen=True, slots=True)
class Beginning:
    """What a recording tells of it. oldest_picture: age of the picture that a tick went by, s.

    late: lines of the event log on what came too late.
    """

    oldest_picture: float
    late: list[str]


@pytest.fixture
def rig_file(tmp_path: Path) -> Iterator[Path]:
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "20") as (_, line):
        found = re.fullmatch(r"board: serial=(\S+) control=(\S+)", line)
        assert found is not None, line
        path = tmp_path / "rig.toml"
        path.write_text(f'[link]\nport = "{found[1]}"\n[simulation]\nboard = "{found[2]}"\n')
        yield path


def begin(server: Server, controller: str, path: str) -> str:
    """Start a run on a rig that was disarmed, let it begin, and disarm again; its id."""
    server.until(lambda state: state["tracking"] == "locked" and not state["faults"])
    server.post("/arm")
    run = server.post("/runs", {"controller": {"name": controller}, "trajectory": {"name": path}})
    time.sleep(BEGUN)
    server.post("/disarm")
    return run["id"]


def all_are_kept(server: Server) -> bool:
    return all(run["recording"]["state"] == "complete" for run in server.get("/runs")["runs"])


def beginning(path: Path) -> Beginning:
    with Recording.open(path) as recording:
        ticks = [tick["/state"] for tick in recording.ticks(end=BEGUN, topics=["/state"])]
        events = recording.events()
    return Beginning(
        oldest_picture=max(tick["time_s"] - tick["captured_s"] for tick in ticks),
        late=[event["message"] for event in events if event["code"] in LATE],
    )


@pytest.mark.exclusive
def test_the_start_of_a_run_keeps_neither_board_nor_pictures_waiting(rig_file: Path, tmp_path: Path) -> None:
    data, plugin, mark = tmp_path / "data", tmp_path / "search.py", tmp_path / "searched"
    plugin.write_text(SEARCHES.format(mark=str(mark)))
    with served(data, "--rig", str(rig_file), "--plugin", str(plugin)) as server:
        runs = {begin(server, *start): start for start in STARTS}
        poll(lambda: all_are_kept(server), bool)
    begun = {start: beginning(file_of(data / RECORDINGS, id)) for id, start in runs.items()}
    assert {start: found.late for start, found in begun.items() if found.late} == {}
    assert max(found.oldest_picture for found in begun.values()) <= FRAME_TOO_LATE
    assert mark.exists()
