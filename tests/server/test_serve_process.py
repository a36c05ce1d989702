"""`pivotrig serve` as a process: killed, stopped, told to end, refused."""

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest

from control.simulation.lockstep import RemoteBoard, Sample
from tests.listening_ear import listening
from tests.processes import Server, served, started

TIME_TO_LIVE = 150
"""Of one drive command, in board milliseconds: the default of the rig file."""
DEAD_MAN = 200
GONE_WITHIN = 5.0
"""The whole server is gone so soon after a signal, s (faults.md, row 16)."""
LINE_AND_TICK = 5
"""Milliseconds for a command that was on its way, and for the tick that notices."""


@dataclass(slots=True)
class SeparateBoard:
    """The board in a process of its own, and somebody who watches it."""

    monitor: RemoteBoard
    rig_file: Path

    def samples_after(self, duration: float) -> list[Sample]:
        """What the board has done up to `duration` seconds from now."""
        time.sleep(duration)
        return self.monitor.take()


@pytest.fixture
def board(tmp_path: Path) -> Iterator[SeparateBoard]:
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "20") as (_, line):
        found = re.fullmatch(r"board: serial=(\S+) control=(\S+)", line)
        assert found is not None, line
        port, control = found.groups()
        rig_file = tmp_path / "rig.toml"
        rig_file.write_text(
            f'name = "two processes"\n[link]\nport = "{port}"\n[simulation]\nboard = "{control}"\n'
        )
        monitor = RemoteBoard(control, realtime=True)
        yield SeparateBoard(monitor, rig_file)
        monitor.close()


@pytest.mark.exclusive
@pytest.mark.parametrize("last_signal", [signal.SIGKILL, signal.SIGSTOP])
def test_the_board_zeroes_its_drive_when_the_server_dies_in_the_middle_of_a_run(
    board: SeparateBoard, tmp_path: Path, last_signal: signal.Signals
) -> None:
    with served(tmp_path / "data", "--rig", str(board.rig_file)) as server:
        server.start_walking()
        before = board.samples_after(0.1)
        assert any(before[-1].duty), "it walks"
        os.kill(server.process.pid, last_signal)
        last_alive = (board.monitor.take() or before)[-1].milliseconds
        after = board.samples_after(0.5)
    first_zero = next(sample.milliseconds for sample in after if not any(sample.duty))
    assert first_zero - last_alive <= TIME_TO_LIVE + LINE_AND_TICK
    assert all(not any(sample.duty) for sample in after if sample.milliseconds >= first_zero)


@pytest.mark.exclusive
def test_a_signal_zeroes_the_coils_first_and_the_server_is_gone_within_5_seconds(
    board: SeparateBoard, tmp_path: Path
) -> None:
    with served(tmp_path / "data", "--rig", str(board.rig_file)) as server:
        server.start_walking()
        board.monitor.take()
        began = time.monotonic()
        server.process.send_signal(signal.SIGTERM)
        assert server.process.wait(10) == 0
        assert time.monotonic() - began <= 5.0
        assert not any(board.monitor.take()[-1].duty)


@pytest.fixture
def simulated(tmp_path: Path) -> Iterator[Server]:
    with served(tmp_path / "data", "--sim") as server:
        yield server


def test_the_server_listens_on_loopback_only(simulated: Server) -> None:
    pid = simulated.process.pid
    own = {os.readlink(f"/proc/{pid}/fd/{fd}") for fd in os.listdir(f"/proc/{pid}/fd")}
    addresses = set()
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/{pid}/net/{table}").read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == "0A" and f"socket:[{fields[9]}]" in own:
                addresses.add(fields[1].split(":")[0])
    assert addresses == {"0100007F"}


def test_a_port_in_use_is_named_and_nothing_starts(simulated: Server, tmp_path: Path) -> None:
    port = simulated.address.rsplit(":", 1)[1]
    answer = serve("--sim", "--port", port, "--data", str(tmp_path))
    assert answer.returncode == 1
    assert f"port {port} on 127.0.0.1 is in use" in answer.stderr
    assert simulated.get("/health")["status"] == "ok"


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("[robot\n", "is not TOML"),
        ("[robot]\nlength_mm = -1\n", "robot.length_mm"),
        ("[robot]\nlenght_mm = 10\n", "robot.lenght_mm: Extra inputs are not permitted"),
        ("[limits]\ncurrent_A = [8, 8, nan]\n", "limits.current_A.2"),
        ("[coils.x]\ndiameter_mm = 390\n", "coils.x.turns: Field required"),
    ],
)
def test_a_rig_file_that_cannot_be_used_says_where_and_why(tmp_path: Path, text: str, complaint: str) -> None:
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text(text)
    answer = serve("--rig", str(rig_file), "--data", str(tmp_path))
    assert answer.returncode == 2
    assert complaint in answer.stderr
    assert "Traceback" not in answer.stderr


def test_a_webhook_that_does_not_answer_a_test_holds_no_end_up(tmp_path: Path) -> None:
    rig_file = tmp_path / "rig.toml"
    with listening() as ear, ThreadPoolExecutor(1) as visitor:
        ear.mute.set()
        rig_file.write_text(f'[notifications]\nwebhook_url = "{ear.url}"\ntimeout_s = 30.0\n')
        with served(tmp_path / "data", "--rig", str(rig_file)) as server:
            tried = visitor.submit(server.post, "/notifications/test")
            ear.wait_for(1)
            began = time.monotonic()
            server.process.send_signal(signal.SIGTERM)
            server.process.wait(20)
            assert time.monotonic() - began <= GONE_WITHIN
        assert tried.exception() is not None


def test_a_missing_rig_file_is_named(tmp_path: Path) -> None:
    answer = serve("--rig", str(tmp_path / "none.toml"), "--data", str(tmp_path))
    assert answer.returncode == 2
    assert "none.toml: No such file or directory" in answer.stderr


def test_a_rig_without_its_board_says_so(tmp_path: Path) -> None:
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        port = unused.getsockname()[1]
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text(f'[link]\nport = "/dev/null"\n[simulation]\nboard = "tcp://127.0.0.1:{port}"\n')
    answer = serve("--rig", str(rig_file), "--data", str(tmp_path))
    assert answer.returncode == 1
    assert "Traceback" not in answer.stderr


def serve(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "server", "serve", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
