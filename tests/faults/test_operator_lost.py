"""Rows 25 and 26: the operator's browser is lost, asleep, hidden, or does not read; another operator takes over."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import socket
import subprocess
from collections.abc import AsyncIterator, Callable
from contextlib import ExitStack, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest

from control.simulation.board import TwinBoard
from control.snapshot import RigState, Snapshot
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.lease.lease import LEASE
from server.rig import Rig
from server.settings import RigFile
from tests.faults.fault_bench import RecordedBoard, electrics_of
from tests.faults.invariants import (
    Trace,
    check_announced,
    check_limits,
    check_recording,
    check_stays_zero,
    check_zero,
    nothing_left_behind,
)
from tests.processes import started
from tests.server.conftest import served
from tests.server.rig_visit import TIMEOUT, act, arm, until, until_gone

pytestmark = [pytest.mark.anyio, pytest.mark.exclusive]

PAGE = "a-page"
HEARTBEAT = 1.0
LATE = 0.5
"""A busy computer may find the silence so much later, s."""


@pytest.fixture(scope="session")
def anyio_backend() -> str:
    return "asyncio"


@dataclass
class Bench:
    """A served rig in real time whose board and ticks are written down.

    noticeable: the board's time (ms) before which the operator was still heard.
    """

    at: Any
    rig: Rig
    archive: Archive
    api: httpx.AsyncClient
    trace: Trace
    board: TwinBoard
    noticeable: int = 0
    absent_at: float | None = None

    def see(self, snapshot: Snapshot) -> None:
        """On the rig's thread, after each tick."""
        self.trace.snapshots.append(snapshot)
        if self.absent_at is None and not self.rig.attendance.absence(walking=True):
            self.noticeable = self.board.milliseconds
        elif self.absent_at is None:
            self.absent_at = snapshot.time

    async def held(self) -> Snapshot:
        async with asyncio.timeout(TIMEOUT), self.rig.updates.subscribe() as ticks:
            while (snapshot := await ticks.get()).rig is not RigState.HELD:
                assert snapshot.rig is RigState.RUNNING, snapshot.reason
            return snapshot

    async def check(self) -> None:
        """All invariants, after some time in which nobody resumes."""
        await asyncio.sleep(0.5)
        run = self.rig.runs[0].id
        await act(self.api, "/runs/current/stop")
        while not self.rig.is_recorded(run):
            await asyncio.sleep(0.02)
        self.trace.events = [event.line for event in self.rig.events]
        electrics = electrics_of(self.rig.machine)
        assert self.absent_at is not None
        check_limits(self.trace.samples, electrics)
        zero = check_zero(self.trace, electrics, self.noticeable)
        check_stays_zero(self.trace, zero)
        check_announced(self.trace, "operator", self.absent_at - LATE)
        check_recording(self.archive.path_of(run), self.absent_at)


@asynccontextmanager
async def bench(folder: Path) -> AsyncIterator[Bench]:
    """The commands come from the page, whose heartbeats a process of its own sends."""
    archive = Archive.open(folder)
    machine = build_machine(RigFile().with_simulation(seed=3), realtime=True)
    trace = Trace()
    assert machine.world is not None
    board = machine.world.board
    assert isinstance(board, TwinBoard)
    machine.world.board = RecordedBoard(board, trace)
    rig = Rig(machine, recorder=archive.recorder)
    async with served(create_app(rig, archive)) as at:
        headers = {"X-Client": PAGE, "Origin": at.url}
        async with httpx.AsyncClient(base_url=f"{at.url}/api/v1", headers=headers, timeout=TIMEOUT) as api:
            made = Bench(at, rig, archive, api, trace, board)
            with rig.watched(made.see):
                yield made


@asynccontextmanager
async def page_of(made: Bench) -> AsyncIterator[subprocess.Popen[str]]:
    """Its socket is open; the server, which is in this process, answers meanwhile."""
    stack = ExitStack()
    process = started("tests.faults.heartbeats", made.at.url, PAGE)
    try:
        yield (await asyncio.to_thread(stack.enter_context, process))[0]
    finally:
        await asyncio.to_thread(stack.close)


async def walk(made: Bench) -> None:
    await arm(made.api)
    await act(made.api, "/runs", 201)
    await until_gone(made.api, 1.0)
    made.absent_at = None


def lost(page: subprocess.Popen[str]) -> None:
    page.kill()


def asleep(page: subprocess.Popen[str]) -> None:
    os.kill(page.pid, signal.SIGSTOP)


def hidden(page: subprocess.Popen[str]) -> None:
    os.kill(page.pid, signal.SIGUSR1)


@pytest.mark.parametrize("fail", [lost, asleep, hidden])
async def test_a_run_whose_page_is_lost_asleep_or_hidden_is_held(
    tmp_path: Path, fail: Callable[[subprocess.Popen[str]], None]
) -> None:
    with nothing_left_behind():
        async with bench(tmp_path) as made, page_of(made) as page:
            await walk(made)
            await asyncio.sleep(2.0 * LEASE)
            assert made.rig.snapshot.rig is RigState.RUNNING, made.rig.snapshot.reason
            failed = made.rig.snapshot.time
            fail(page)
            snapshot = await made.held()
            assert LEASE - HEARTBEAT < snapshot.time - failed < LEASE + HEARTBEAT + LATE
            assert "Dashboard at 127.0.0.1 operates and has not been heard for 2 s" in snapshot.reason
            await made.check()


async def test_a_page_that_does_not_read_is_dropped_and_its_run_held(tmp_path: Path) -> None:
    """It goes on saying that it is seen; the line that nothing gets through is ended all the same."""
    with nothing_left_behind():
        async with bench(tmp_path) as made, page_of(made) as page:
            await walk(made)
            with deaf(made.at) as line:
                page.kill()
                work = [asyncio.create_task(beat(line)), asyncio.create_task(stuff(made))]
                await made.held()
                for task in work:
                    task.cancel()
                await asyncio.gather(*work, return_exceptions=True)
            await made.check()


def deaf(at: Any) -> socket.socket:
    line = socket.create_connection(("127.0.0.1", at.port))
    line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    line.sendall(
        f"GET /api/v1/telemetry?client={PAGE} HTTP/1.1\r\nHost: {at.host}\r\nOrigin: {at.url}\r\n"
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
        "Sec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    line.setblocking(False)
    return line


async def beat(line: socket.socket) -> None:
    """Heartbeats as a page sends them, more often, as long as the line takes them."""
    text = json.dumps({"type": "heartbeat", "visible": True}).encode()
    frame = bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text
    with contextlib.suppress(OSError):
        while True:
            line.send(frame)
            await asyncio.sleep(0.2)


async def stuff(made: Bench) -> None:
    """News for everybody, which fill the line of the one who does not read."""
    while True:
        made.rig.announcements.publish({"type": "test", "text": "x" * 100_000})
        await asyncio.sleep(0.02)


async def test_a_late_operator_drives_nothing_after_another_one_has_taken_over(tmp_path: Path) -> None:
    """Row 26: the page sleeps, somebody else takes over and stops; the page's commands switch nothing on again."""
    with nothing_left_behind():
        async with bench(tmp_path) as made, page_of(made) as page:
            await walk(made)
            asleep(page)
            await made.held()
            bob = httpx.AsyncClient(base_url=f"{made.at.url}/api/v1", headers={"X-Client": "Bob"})
            async with bob:
                assert (await act(bob, "/operator"))["holder"]["name"] == "Bob"
                await until(bob, tracking="locked")
            for path in ("/runs/current/resume", "/arm", "/runs"):
                late = await made.api.post(path)
                assert late.json()["title"] == "Somebody else operates"
            await made.check()
