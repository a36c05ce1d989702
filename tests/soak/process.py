"""The served rig as the operating system sees it: its start and end, its memory, threads, files and children."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.soak.broken import InvariantBroken

READY_WITHIN = 60.0
"""Seconds."""
GONE_WITHIN = 5.0
"""After SIGTERM, s (faults.md row 16)."""
KB = 1024
NANO = 1e-9


@dataclass(frozen=True, slots=True)
class Memory:
    """Bytes. held: in RAM or swapped out, libraries included.  anonymous: what the program itself has asked for."""

    held: int
    anonymous: int


@dataclass(frozen=True, slots=True)
class Belongings:
    """What a process may leave behind while it goes on."""

    threads: int
    files: int
    children: int


@dataclass(slots=True)
class Served:
    """A running `pivotrig serve --sim`."""

    process: subprocess.Popen[str]
    address: str
    data: Path

    @property
    def _proc(self) -> Path:
        return Path(f"/proc/{self.process.pid}")

    def memory(self) -> Memory:
        """RSS and swap, not PSS or USS: those two fall and rise when a load client or an export's process maps the
        same libraries, which says nothing about the server; and what is swapped out has not been given back."""
        fields = dict(
            line.split(":", 1) for line in (self._proc / "smaps_rollup").read_text().splitlines()[1:]
        )
        kilobytes = {name: int(value.split()[0]) for name, value in fields.items()}
        swapped = kilobytes["Swap"]
        return Memory((kilobytes["Rss"] + swapped) * KB, (kilobytes["Anonymous"] + swapped) * KB)

    def belongings(self) -> Belongings:
        tasks = os.listdir(self._proc / "task")
        files = os.listdir(self._proc / "fd")
        return Belongings(len(tasks), len(files), len(self.children()))

    def children(self) -> list[int]:
        found: list[int] = []
        for task in (self._proc / "task").iterdir():
            with contextlib.suppress(OSError):
                found += map(int, (task / "children").read_text().split())
        return found

    def waits(self) -> Mapping[int, float]:
        """How long each thread has had to wait for a processor since it began, s."""
        waits: dict[int, float] = {}
        for task in (self._proc / "task").iterdir():
            with contextlib.suppress(OSError):
                waits[int(task.name)] = int((task / "schedstat").read_text().split()[1]) * NANO
        return waits

    def end(self) -> float:
        """SIGTERM; how long it took, s. Raises `InvariantBroken` where the process does not end as it should."""
        children = self.children()
        began = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        try:
            status = self.process.wait(2.0 * GONE_WITHIN)
        except subprocess.TimeoutExpired:
            raise InvariantBroken(f"I7: still there {2.0 * GONE_WITHIN:g} s after SIGTERM") from None
        took = time.monotonic() - began
        if status != 0 or took > GONE_WITHIN:
            raise InvariantBroken(f"I7: ended with status {status} {took:.1f} s after SIGTERM")
        left = [child for child in children if Path(f"/proc/{child}").exists()]
        if left:
            raise InvariantBroken(f"I7: processes left behind: {left}")
        return took


def starved(before: Mapping[int, float], after: Mapping[int, float]) -> float:
    """How long the thread that was kept from the processor most had to wait between the two looks, s."""
    return max((wait - before.get(task, 0.0) for task, wait in after.items()), default=0.0)


@contextmanager
def served(data: Path, log: Path, seed: int) -> Iterator[Served]:
    """A server of the simulated rig on a free port; what it says goes to `log`.

    It knows no rig file but its own defaults. Killed at the end if it still runs."""
    command = [sys.executable, "-m", "server", "serve", "--sim", "--port", "0", "--data", str(data)]
    own = {"PYTHONHASHSEED": str(seed % 2**32), "XDG_DATA_HOME": str(data.parent)}
    with (
        log.open("w") as words,
        subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=words, text=True, env={**os.environ, **own}
        ) as process,
    ):
        try:
            yield Served(process, _address(process, log), data)
        finally:
            if process.poll() is None:
                process.kill()


def _address(process: subprocess.Popen[str], log: Path) -> str:
    assert process.stdout is not None
    line = process.stdout.readline().strip()
    if not line:
        raise RuntimeError(f"the server did not start:\n{log.read_text()}")
    return line.removeprefix("dashboard: ")
