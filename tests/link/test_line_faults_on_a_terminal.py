"""The same promises with a board in a process of its own, on a real terminal and in real time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace

import pytest
from link_bench import COMMAND, CONFIGURATION, board, until

from control.link.conversion import LinkError
from control.link.port import LAST_WORDS, Link
from control.simulation.line_faults import LineFaults
from control.simulation.lockstep import RemoteBoard

PERIOD = 0.016


class Bench:
    """A link at the loop's pace, to a board that lives its own life."""

    def __init__(self, link: Link, monitor: RemoteBoard) -> None:
        self.link = link
        self.monitor = monitor
        self.faults = LineFaults(time.monotonic)
        link.put_before(self.faults.wrap)

    def arm(self) -> None:
        self.link.open()
        assert until(lambda: self.link.poll() is not None)
        self.link.drive(replace(COMMAND, start_heading=0.0))

    def drive_for(self, seconds: float) -> list[float]:
        """What each poll and command took, s."""
        durations = []
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            before = time.monotonic()
            self.link.poll()
            if self.link.is_ready:
                self._attempt()
            durations.append(time.monotonic() - before)
            time.sleep(PERIOD)
        return durations

    def _attempt(self) -> None:
        with suppress(LinkError):
            self.link.drive(COMMAND)

    @property
    def duty(self) -> tuple[int, int, int]:
        return self.monitor.take()[-1].duty


@contextmanager
def driving() -> Iterator[Bench]:
    with board() as (port, monitor):
        bench = Bench(Link(port, 500000, CONFIGURATION, time.monotonic), monitor)
        bench.arm()
        bench.drive_for(0.2)
        try:
            yield bench
        finally:
            bench.link.close()


def test_garbage_on_a_terminal_costs_messages_and_nothing_else() -> None:
    with driving() as bench:
        bench.faults.garbage = 0.3
        bench.drive_for(1.0)
        assert bench.link.is_ready
        assert any(bench.duty)
        assert bench.link.bad_share > 0.05


@pytest.mark.parametrize("fault", ["unplugged", "jammed", "silent"])
def test_a_terminal_that_fails_disarms_and_comes_back_disarmed(fault: str) -> None:
    with driving() as bench:
        setattr(bench.faults, fault, True)
        bench.drive_for(0.8)
        assert bench.duty == (0, 0, 0)
        assert not bench.link.is_ready
        bench.faults.clear()
        assert until(lambda: bench.link.poll() is not None)
        bench.drive_for(0.3)
        assert bench.duty == (0, 0, 0)


@pytest.mark.exclusive
def test_a_board_that_stops_reading_costs_the_loop_one_write_time_out() -> None:
    """Its process stands still, its terminal fills up; a poll or command waits once, and then no more."""
    with driving() as bench:
        for _ in range(200):
            bench.link._serial.write(b"\x05" * 20)  # type: ignore[union-attr]
        bench.monitor._send("step 1")  # it stands still from now on
        durations = bench.drive_for(1.5)
        slow = [duration for duration in durations if duration > 0.015]
        assert len(slow) <= 1 + 2  # the jam, and each attempt to reopen after 0.5 and 1 s
        assert max(durations) < 0.03 + LAST_WORDS + 0.03
