"""Real processes of the program, for tests that start, ask and kill them."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

T = TypeVar("T")

PATIENCE = 30.0
"""Seconds that a process may take to get ready on a busy machine."""


class FirstLineMissing(Exception):
    """A process ended, or said something else than it should."""


class ServerRefused(Exception):
    """The server answered with a problem document."""


@dataclass(slots=True)
class Server:
    """A running `pivotrig serve`."""

    process: subprocess.Popen[str]
    address: str

    def get(self, path: str) -> Any:
        with urllib.request.urlopen(f"{self.address}/api/v1{path}", timeout=10) as answer:
            return json.load(answer)

    def post(self, path: str, body: dict[str, Any] | None = None) -> Any:
        return self.send("POST", path, body)

    def send(self, method: str, path: str, body: dict[str, Any] | None = None) -> Any:
        request = urllib.request.Request(
            f"{self.address}/api/v1{path}",
            data=json.dumps(body or {}).encode(),
            headers={"Content-Type": "application/json"},
            method=method,
        )
        try:
            with urllib.request.urlopen(request, timeout=10) as answer:
                return json.load(answer)
        except urllib.error.HTTPError as refusal:
            raise ServerRefused(f"{path}: {refusal.code} {refusal.read().decode()}") from refusal

    def until(self, condition: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """The first state that fulfils the condition."""
        return poll(lambda: self.get("/state"), condition)

    def start_walking(self) -> None:
        """Unattended: nobody has to be heard meanwhile. Once more when a busy machine has made the rig let go."""
        poll(self._is_walking, bool)

    def _is_walking(self) -> bool:
        state = self.until(lambda state: state["tracking"] == "locked")
        if state["rig"] == "running":
            return state["run"] is not None and state["run"]["elapsed_s"] > 0.5
        with contextlib.suppress(ServerRefused):
            self._start_from(state["rig"])
        return False

    def _start_from(self, rig: str) -> None:
        if rig == "fault":
            self.post("/reset")
        elif rig != "disarmed":
            self.post("/disarm")
        self.post("/arm")
        self.post("/runs", {"gait": {"sweep_deg": 10.0}, "unattended": True})


def poll(ask: Callable[[], T], condition: Callable[[T], bool]) -> T:
    """Ask until the answer fulfils the condition."""
    until = time.monotonic() + PATIENCE
    while not condition(answer := ask()):
        if time.monotonic() > until:
            raise TimeoutError(f"still: {answer}")
        time.sleep(0.02)
    return answer


@contextmanager
def started(module: str, *arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """`python -m module …` and the first line that it prints; killed at the end if it still runs."""
    command = [sys.executable, "-m", module, *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stderr is not None
    try:
        line = process.stdout.readline().strip()
        if not line:
            raise FirstLineMissing(process.stderr.read())
        yield process, line
    finally:
        if process.poll() is None:
            os.kill(process.pid, signal.SIGCONT)
            process.kill()
        process.wait(10)
        process.stdout.close()
        process.stderr.close()


@contextmanager
def served(data: Path, *arguments: str) -> Iterator[Server]:
    """A server of the simulated rig on a free port."""
    with started("server", "serve", "--port", "0", "--data", str(data), *arguments) as (process, line):
        yield Server(process, line.removeprefix("dashboard: "))
