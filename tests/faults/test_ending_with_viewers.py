"""Row 16: Ctrl-C, SIGTERM or a closed terminal while people watch: zero first, everything else afterwards."""

from __future__ import annotations

import contextlib
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import viser
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from control.link.messages import Stop
from tests.faults.conftest import SeparateBoard
from tests.faults.wire_tap import WireTap
from tests.processes import poll, served

pytestmark = pytest.mark.exclusive

SCENE_PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")
GONE_WITHIN = 5.0
AT_ONCE = 0.25
"""Seconds from the signal to the STOP on the line, on a busy computer."""


@pytest.fixture
def tap(board: SeparateBoard) -> Iterator[WireTap]:
    tap = WireTap(board.port)
    yield tap
    tap.close()


class Viewers:
    """Browsers: each reads until it is sent away, and remembers when that was, s (monotonic)."""

    def __init__(self, address: str) -> None:
        self.left: list[float] = []
        self._host = address.removeprefix("http://")
        self._threads = [
            *(threading.Thread(target=self._watch, args=(self._telemetry,)) for _ in range(3)),
            *(threading.Thread(target=self._watch, args=(self._pictures,)) for _ in range(2)),
            threading.Thread(target=self._watch, args=(self._scene,)),
        ]
        self._deaf = self._asked()
        """Asked for pictures and never reads one."""
        self._seen = threading.Semaphore(0)
        for thread in self._threads:
            thread.start()
        for _ in self._threads:
            assert self._seen.acquire(timeout=20.0), "a viewer sees nothing"

    def _watch(self, look: Callable[[], None]) -> None:
        with contextlib.suppress(ConnectionClosed, OSError):
            look()
        self.left.append(time.monotonic())

    def _telemetry(self) -> None:
        self._listen("/api/v1/telemetry", None)

    def _scene(self) -> None:
        self._listen("/scene", [SCENE_PROTOCOL])

    def _listen(self, path: str, protocols: list[Subprotocol] | None) -> None:
        url = f"ws://{self._host}{path}"
        with connect(url, subprotocols=protocols, compression=None, proxy=None, max_size=None) as line:
            line.recv()
            self._seen.release()
            while True:
                line.recv()

    def _pictures(self) -> None:
        with self._asked() as line:
            line.recv(1024)
            self._seen.release()
            while line.recv(1 << 16):
                pass

    def _asked(self) -> socket.socket:
        host, port = self._host.split(":")
        line = socket.create_connection((host, int(port)), timeout=30.0)
        line.sendall(f"GET /api/v1/camera/stream.mjpg HTTP/1.1\r\nHost: {self._host}\r\n\r\n".encode("ascii"))
        return line

    def join(self) -> None:
        for thread in self._threads:
            thread.join(10.0)
        self._deaf.close()


@pytest.mark.parametrize("last_signal", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_stops_the_coils_before_anybody_is_sent_away(
    board: SeparateBoard, tap: WireTap, tmp_path: Path, last_signal: signal.Signals
) -> None:
    """When you press Ctrl-C while browsers watch, the coils are off at once, before anything is closed, and the
    program is gone within five seconds, however many watch."""
    rig_file = board.rig_file(tmp_path, tap.name)
    with served(tmp_path / "data", "--rig", str(rig_file)) as server:
        viewers = Viewers(server.address)
        server.start_walking()
        began = time.monotonic()
        server.process.send_signal(last_signal)
        assert server.process.wait(10) == 0
        assert time.monotonic() - began <= GONE_WITHIN
        viewers.join()
        stopped = tap.first(Stop, began)
        assert stopped is not None
        assert stopped - began <= AT_ONCE
        assert stopped < min(viewers.left), "zero first, then the viewers"
        assert not any(board.newest.duty)


def test_a_second_ctrl_c_does_not_put_the_coils_on_again(
    board: SeparateBoard, tap: WireTap, tmp_path: Path
) -> None:
    """Whoever presses Ctrl-C twice gets out sooner, with the coils off."""
    with served(tmp_path / "data", "--rig", str(board.rig_file(tmp_path, tap.name))) as server:
        server.start_walking()
        began = time.monotonic()
        server.process.send_signal(signal.SIGINT)
        poll(lambda: tap.first(Stop, began), lambda at: at is not None)
        with contextlib.suppress(ProcessLookupError):
            server.process.send_signal(signal.SIGINT)
        server.process.wait(10)
        assert time.monotonic() - began <= GONE_WITHIN
        time.sleep(0.1)
        assert not any(board.newest.duty)


@pytest.mark.parametrize("last_signal", [signal.SIGINT, signal.SIGTERM])
def test_a_run_from_the_command_line_stops_its_coils_first_too(
    board: SeparateBoard, tap: WireTap, tmp_path: Path, last_signal: signal.Signals
) -> None:
    """When you press Ctrl-C during `pivotrig run`, the coils are off at once."""
    rig_file = board.rig_file(tmp_path, tap.name)
    command = [sys.executable, "-m", "server", "run", "--rig", str(rig_file)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        poll(lambda: board.samples_for(0.1)[-1].duty, any)
        began = time.monotonic()
        process.send_signal(last_signal)
        _, complaint = process.communicate(timeout=10)
    finally:
        process.kill()
        process.wait(10)
    assert process.returncode == 130, complaint
    assert "Traceback" not in complaint
    stopped = tap.first(Stop, began)
    assert stopped is not None
    assert stopped - began <= AT_ONCE
    assert not any(board.newest.duty)
