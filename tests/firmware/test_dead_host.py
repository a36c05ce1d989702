"""The compiled firmware has the last word: the host is killed, frozen, or heard only now and then.

Times are the board's own milliseconds.
"""

from __future__ import annotations

import math
import random
import signal
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from board_contact import process_of

from control.link import wire
from control.link.conversion import DriveCommand, LinkError
from control.link.messages import Drive, Hello
from control.link.port import Link
from control.simulation.emulated import EmulatedBoard, prepare
from control.simulation.emulator_port import Consumed, Duty, Event, Tick
from control.simulation.line_faults import LineFaults
from control.simulation.lockstep import RemoteBoard, Sample
from tests.faults.invariants import Electrics, Trace, check_limits, check_stays_zero, check_zero, is_driven
from tests.firmware.driving_host import ALLOCATION, FULL
from tests.paper_board import CONFIGURATION
from tests.processes import poll, served, started
from tests.simulation.board_bench import windings

DEAD_MAN = 200
ON_ITS_WAY = 5
"""Milliseconds for a command that was on the line when the host died."""

ELECTRICS = Electrics(
    currents=CONFIGURATION.current_limits,
    power=8.0**2 * 6.0,
    resistances=CONFIGURATION.resistances,
    time_constants=(0.05, 0.0275, 0.0094),
    dead_man=DEAD_MAN,
)


class Watched:
    """An emulated board in real time, and somebody who watches it."""

    def __init__(self, serial: str, control: str) -> None:
        self.serial, self.control = serial, control
        self._monitor = RemoteBoard(control, realtime=True)

    def samples_for(self, duration: float) -> list[Sample]:
        time.sleep(duration)
        return poll(self._monitor.take, bool)

    def until_driven(self, share: float) -> None:
        """Until a coil carries that share of what it may."""
        poll(lambda: self.samples_for(0.05)[-1], lambda sample: _most(sample) > share * 8.0)

    def expect_zero(self) -> None:
        """The invariants, from now on, of a board whose host has just died."""
        died = self.samples_for(0.0)[-1].milliseconds
        samples = self.samples_for(0.5)
        check_limits(samples, ELECTRICS)
        zero = check_zero(Trace(samples), ELECTRICS, died + ON_ITS_WAY)
        assert zero - died <= DEAD_MAN
        check_stays_zero(Trace(samples), zero)

    def close(self) -> None:
        self._monitor.close()


def _most(sample: Sample) -> float:
    return max(abs(current) for current in sample.currents)


@contextmanager
def watched() -> Iterator[Watched]:
    with process_of("avr", "--linger", "20") as (serial, control), closing(Watched(serial, control)) as board:
        yield board


@pytest.mark.exclusive
def test_a_host_that_is_killed_or_frozen_at_full_current_leaves_zero_within_200_ms(full: bool) -> None:
    """Half of the hosts are killed, half are stopped and never go on."""
    with watched() as board:
        for number in range(50 if full else 5):
            with started("tests.firmware.driving_host", board.serial) as (host, line):
                assert line == "driving"
                board.until_driven(FULL)
                host.send_signal(signal.SIGKILL if number % 2 else signal.SIGSTOP)
                board.expect_zero()


@pytest.mark.exclusive
def test_a_server_that_is_killed_or_frozen_in_a_run_leaves_zero_within_200_ms(
    tmp_path: Path, full: bool
) -> None:
    with watched() as board:
        rig_file = tmp_path / "rig.toml"
        rig_file.write_text(f'[link]\nport = "{board.serial}"\n[simulation]\nboard = "{board.control}"\n')
        for number in range(10 if full else 2):
            with served(tmp_path / "data", "--rig", str(rig_file)) as server:
                server.start_walking()
                board.until_driven(0.5)
                server.process.send_signal(signal.SIGKILL if number % 2 else signal.SIGSTOP)
                board.expect_zero()


# ---- a line that loses messages, stepped


COMMAND = DriveCommand(1, 0.0, 0.0, math.radians(25.0), 0.010, ALLOCATION, 0.15)
FRAME = 16
"""Milliseconds between two commands."""


class LossyRig:
    """The real link, a line that loses frames both ways, the emulated board; host and board in step."""

    def __init__(self, seed: int, lost: float) -> None:
        self.board = EmulatedBoard(prepare(), windings(), 24.0, realtime=False)
        self.board.trace()
        self.now = 0.0
        self.faults = LineFaults(lambda: self.now, seed, lost=lost)
        self.link = Link(self.board.port, 500_000, CONFIGURATION, lambda: self.now, self.faults.wrap)
        self.samples: list[Sample] = []
        self.events: list[Event] = []
        self._dice = random.Random(seed)
        self._is_armed = False

    def tick(self, is_alive: bool) -> None:
        self.samples += self.board.step(FRAME)
        self.events += self.board.traced()
        self.now += FRAME * 1e-3
        if is_alive:
            self._command()

    def _command(self) -> None:
        """Drives all over the plate; arms again when the board has let go."""
        report = self.link.poll()
        if report is not None:
            self._is_armed = report.state == "driving"
        goal = self._dice.uniform(-math.pi, math.pi)
        pivot = self._dice.choice((1, -1))
        command = replace(COMMAND, pivot=pivot, rate=self._dice.uniform(-2.0, 2.0), heading_goal=goal)
        try:
            self.link.drive(command if self._is_armed else replace(command, start_heading=goal))
        except LinkError:
            self._is_armed = False  # not ready: it greets anew by itself

    def close(self) -> None:
        self.link.close()
        self.board.close()


@pytest.mark.parametrize("percent", [0, 10, 20, 30])
def test_with_lost_messages_the_drive_never_outlives_the_last_one_that_was_accepted(
    percent: int, full: bool
) -> None:
    """The host falls silent now and then besides; currents stay within limits all the time."""
    for seed in range(5 if full else 1):
        with closing(LossyRig(seed, 0.01 * percent)) as rig:
            rig.link.open()
            for _ in range(40 if full else 8):
                for _ in range(40):
                    rig.tick(is_alive=True)
                for _ in range(25):
                    rig.tick(is_alive=False)
            assert rig.faults.met["lost"] > 0 or percent == 0
            check_limits(rig.samples, ELECTRICS)
            assert sum(map(is_driven, rig.samples)) > 0.3 * len(rig.samples)
            assert longest_without_command(rig.events) <= DEAD_MAN + 1


def longest_without_command(events: list[Event]) -> int:
    """The longest time for which a PWM was not zero after a drive command was taken, in ticks of the board."""
    decoder = wire.Decoder()
    last_sequence = ticks = accepted_at = longest = 0
    for event in events:
        match event:
            case Consumed(data):
                for packet in decoder.feed(data):
                    distance = wire.sequence_distance(packet.sequence, last_sequence)
                    if isinstance(packet.message, Hello):
                        last_sequence = packet.sequence
                    elif 1 <= distance <= wire.SEQUENCE_WINDOW:
                        last_sequence = packet.sequence
                        accepted_at = ticks if isinstance(packet.message, Drive) else accepted_at
            case Tick():
                ticks += 1
            case Duty(steps) if any(steps):
                longest = max(longest, ticks - accepted_at)
    return longest
