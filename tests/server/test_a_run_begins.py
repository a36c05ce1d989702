"""Nothing that a server does once keeps it busy while a robot walks, as no command reaches the board meanwhile.

What it costs is counted in processor time, which a busy computer does not stretch: 0.15 s and more before it was
mended, and the board waits for no longer than that.
"""

from __future__ import annotations

import contextlib
import gc
import os
import statistics
import urllib.request
from pathlib import Path

from server.assembly import build_machine
from server.rig_file import load_rig_file
from tests.processes import Server, ServerRefused, poll, served
from tests.real_rig import real_rig

SEARCHES = """
import gc
import time
from pathlib import Path
from control.controllers import Decision, controllers
from control.registry import Parameters

MARK = Path({mark!r})

@controllers.register
class Searching:
    name = "searching"
    title = "Looks for garbage"
    summary = "lets Python search for garbage when the robot begins to walk, as it may happen at any time"
    Parameters = Parameters
    def __init__(self, parameters):
        pass
    def step(self, situation):
        if not MARK.exists():
            began = time.thread_time()
            gc.collect()
            took = time.thread_time() - began
            part = MARK.with_suffix(".part")
            part.write_text(str(took))
            part.rename(MARK)
        return Decision(situation.pivot, 0.5)
"""
BRIEF = 0.06
"""Processor time that a tick can spare once, s: a third of the time that a command lives for is left."""


def cost_of_reading_about_the_api(server: Server) -> float:
    """Processor time of the whole server meanwhile, s; its loop goes on, too."""
    began = used_by(server.process.pid)
    with urllib.request.urlopen(f"{server.address}/openapi.json", timeout=30) as answer:
        assert b"/api/v1/runs" in answer.read()
    return used_by(server.process.pid) - began


def used_by(process: int) -> float:
    """Processor time so far, s."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def walk_until(server: Server, mark: Path) -> None:
    """As a person would: once more when a busy computer has made the rig let go."""

    def is_there() -> bool:
        state = server.get("/state")
        with contextlib.suppress(ServerRefused):
            if state["rig"] == "fault":
                server.post("/reset")
            elif state["rig"] == "held":
                server.post("/disarm")
            elif state["rig"] == "disarmed" and state["tracking"] == "locked":
                server.post("/arm")
                server.post("/runs", {"controller": {"name": "searching"}})
        return mark.exists()

    poll(is_there, bool)


def test_neither_a_search_for_garbage_nor_a_reader_of_the_api_keeps_a_walking_robot_waiting(
    tmp_path: Path,
) -> None:
    plugin, mark = tmp_path / "search.py", tmp_path / "searched"
    plugin.write_text(SEARCHES.format(mark=str(mark)))
    with served(tmp_path / "data", "--sim", "--plugin", str(plugin)) as server:
        first, *others = [cost_of_reading_about_the_api(server) for _ in range(6)]
        walk_until(server, mark)
    assert first - statistics.median(others) <= 0.15
    assert float(mark.read_text()) <= BRIEF


def test_a_real_rig_that_is_opened_without_a_server_is_not_searched_for_garbage_either(
    tmp_path: Path,
) -> None:
    with real_rig(tmp_path) as rig_file:
        machine = build_machine(load_rig_file(rig_file), realtime=True)
        gc.unfreeze()
        try:
            machine.open()
            assert gc.get_freeze_count() > 100_000
        finally:
            gc.unfreeze()
            machine.close()
