"""A link and the board that it speaks to, on one simulated clock."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import count

from control.link.conversion import DriveCommand, Telemetry
from control.link.port import Link
from control.simulation.board import TwinBoard, Winding
from control.simulation.lockstep import RemoteBoard
from tests.paper_board import CONFIGURATION
from tests.processes import started

ALLOCATION = ((800.0, 0.0, 0.0), (0.0, 800.0, 0.0), (0.0, 0.0, 800.0))
COMMAND = DriveCommand(1, 0.0, 0.0, math.radians(25.0), 0.010, ALLOCATION, 0.12)
TICK = 16
_names = count()


class Rig:
    """Ticks like the loop: the board runs on for a frame, then the link is polled."""

    def __init__(self) -> None:
        name = f"link-{next(_names)}"
        windings = (Winding(2.5, 0.125), Winding(2.0, 0.055), Winding(1.5, 0.014))
        self.now = 0.0
        self.board = TwinBoard(name, windings, 24.0, boot_id=40)
        self.link = Link(f"sim://{name}", 500000, CONFIGURATION, lambda: self.now)

    def tick(self, times: int = 1) -> Telemetry | None:
        """The last poll's report."""
        report = None
        for _ in range(times):
            self.board.advance(TICK)
            self.now += TICK * 1e-3
            report = self.link.poll()
        return report

    def ready(self) -> Rig:
        self.link.open()
        self.tick(6)
        assert self.link.is_ready, self.link.reason
        return self

    def driving(self) -> Rig:
        self.ready()
        self.link.drive(replace(COMMAND, start_heading=0.0))
        self.drive_on(10)
        return self

    def drive_on(self, times: int) -> None:
        for _ in range(times):
            self.tick()
            self.link.drive(COMMAND)


@contextmanager
def rig() -> Iterator[Rig]:
    bench = Rig()
    try:
        yield bench
    finally:
        bench.link.close()
        bench.board.close()


@contextmanager
def board(*arguments: str) -> Iterator[tuple[str, RemoteBoard]]:
    """A board process that runs freely: its terminal and its lock-step port."""
    with started("control.simulation.board_process", "--linger", "1", *arguments) as (_, line):
        serial, control = (word.partition("=")[2] for word in line.split()[1:])
        monitor = RemoteBoard(control, realtime=True)
        try:
            yield serial, monitor
        finally:
            monitor.close()


def until(condition: Callable[[], bool], patience: float = 10.0) -> bool:
    """Whether it became true."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.005)
    return False


def drive_times(link: Link, times: int) -> None:
    for _ in range(times):
        link.drive(COMMAND)
