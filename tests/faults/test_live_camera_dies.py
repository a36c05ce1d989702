"""Row 1 on the clock: a rig with a real serial line, whose camera is the picture stream of another pivotrig."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from control.gait import Gait
from control.model import Frame
from control.snapshot import RigState, Snapshot
from server.assembly import Machine, build_machine
from server.rig_life import FRAME_TIMEOUT
from server.settings import RigFile
from tests.processes import Server, served, started

HELD_WITHIN = 0.150
"""After the last frame, s: 102 ms by the rig's pace, and what a busy computer adds."""


@pytest.fixture
def neighbour(tmp_path: Path) -> Iterator[Server]:
    """A simulated rig, with a robot in its picture."""
    with served(tmp_path / "neighbour") as server:
        yield server


@pytest.fixture
def machine(tmp_path: Path, neighbour: Server) -> Iterator[Machine]:
    uri = f"{neighbour.address.rstrip('/')}/api/v1/camera/stream.mjpg"
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "60") as (_, line):
        port = line.split()[1].removeprefix("serial=")
        settings = RigFile.model_validate({"camera": {"uri": uri, "rate_Hz": 30.0}, "link": {"port": port}})
        machine = build_machine(settings, realtime=True, data=tmp_path / "data")
        yield machine
        machine.close()


def ticks(machine: Machine, duration: float) -> Iterator[tuple[Frame | None, Snapshot]]:
    until = time.monotonic() + duration
    while time.monotonic() < until:
        frame = machine.camera.read(FRAME_TIMEOUT)
        yield frame, machine.loop.tick(frame, machine.camera.now())


@pytest.mark.exclusive
def test_a_stream_whose_server_is_killed_holds_an_armed_rig_within_a_tenth_of_a_second(
    machine: Machine, neighbour: Server
) -> None:
    machine.open()
    assert any(not machine.loop.obstacle for _ in ticks(machine, 20.0)), machine.loop.obstacle
    machine.loop.arm(Gait(), consent=True)
    assert [snapshot.rig for _, snapshot in ticks(machine, 1.0)][-1] is RigState.ARMED
    neighbour.process.kill()
    last = time.monotonic()
    for frame, snapshot in ticks(machine, 3.0):
        if frame is not None:
            last = time.monotonic()
        if snapshot.rig is RigState.HELD:
            break
    assert machine.loop.state is RigState.HELD
    assert time.monotonic() - last <= HELD_WITHIN
    later = [snapshot for _, snapshot in ticks(machine, 1.0)][-1]
    assert later.rig is RigState.HELD
    assert "camera" in [fault.code for fault in later.faults]
