"""A board in a process of its own, and the rig in simulated time."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from control.simulation.lockstep import RemoteBoard, Sample
from server.assembly import build_machine
from server.settings import RigFile
from tests.faults.fault_bench import FaultBench, electrics_of, fault_bench
from tests.faults.invariants import Electrics, nothing_left_behind
from tests.processes import poll, started


@pytest.fixture
def bench() -> Iterator[FaultBench]:
    """A rig in simulated time; nothing may be left of it."""
    with nothing_left_behind(), fault_bench() as bench:
        yield bench


@pytest.fixture(scope="session")
def electrics() -> Electrics:
    """Of the paper's rig."""
    machine = build_machine(RigFile(), realtime=False)
    try:
        return electrics_of(machine)
    finally:
        machine.close()


@dataclass(slots=True)
class SeparateBoard:
    """The board in a process of its own, and somebody who watches it."""

    monitor: RemoteBoard
    port: str
    control: str

    def rig_file(self, folder: Path, port: str | None = None) -> Path:
        """A rig file that leads to the board, or to what stands before it."""
        path = folder / "rig.toml"
        path.write_text(f'[link]\nport = "{port or self.port}"\n[simulation]\nboard = "{self.control}"\n')
        return path

    def samples_for(self, duration: float) -> list[Sample]:
        """What the board does in the next `duration` seconds, and has done since the last look; at least one sample."""
        time.sleep(duration)
        return self._some()

    @property
    def milliseconds(self) -> int:
        """The board's own time."""
        return self.newest.milliseconds

    @property
    def newest(self) -> Sample:
        return self._some()[-1]

    def _some(self) -> list[Sample]:
        """What has not been taken yet; waits for the board's next millisecond where that is nothing."""
        return poll(self.monitor.take, bool)


@contextmanager
def separate_board() -> Iterator[SeparateBoard]:
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "20") as (_, line):
        found = re.fullmatch(r"board: serial=(\S+) control=(\S+)", line)
        assert found is not None, line
        monitor = RemoteBoard(found.group(2), realtime=True)
        yield SeparateBoard(monitor, *found.groups())
        monitor.close()


@pytest.fixture
def board() -> Iterator[SeparateBoard]:
    with separate_board() as board:
        yield board
