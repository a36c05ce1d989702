"""A server process with the simulated rig, and a browser tab that remembers what it asked for."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import BrowserContext, ConsoleMessage, Locator, Page, Request

START_TIMEOUT = 90.0
"""A server under load is up within this, s."""
STOP_TIMEOUT = 10.0
READY_LINE = re.compile(r"dashboard: (http://\S+)")
REFUSAL = re.compile(r"responded with a status of (409|422)")
"""The browser itself notes each refused request; what the page makes of it is what is tested."""
LOCAL_SCHEMES = ("blob:", "data:", "about:")
TELLS_OF_REFUSALS = """
document.addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI, sourceFile, lineNumber }) =>
  tellOfRefusal(`${violatedDirective}: ${blockedURI} (${sourceFile}, line ${lineNumber})`));
"""
"""For each document of a tab, frames included: what its policy has kept it from."""

CLIENT = "the person at the rig"
"""What tabs and requests call themselves: they are one person's, who operates by any of them."""

PATIENCE = 15.0
"""What a person would wait for on two cores with software WebGL, s."""


class ServedRig:
    """One `pivotrig serve --sim` process; it can be killed and started again on its port."""

    def __init__(self, data: Path, *options: str, token: str = "") -> None:
        """options: which rig, in place of the simulated one.  token: that requests show."""
        self.data = data
        self._headers = {"X-Client": CLIENT} | ({"Authorization": f"Bearer {token}"} if token else {})
        self._options = options or ("--sim",)
        self._process: subprocess.Popen[str] | None = None
        self._first_selection: dict[str, Any] | None = None
        self.url = ""
        self.log: list[str] = []

    def start(self) -> None:
        port = urlsplit(self.url).port or 0
        script = Path(sys.executable).with_name("pivotrig")
        command = [str(script), "serve", *self._options, "--port", str(port), "--data", str(self.data)]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        ready = threading.Event()
        threading.Thread(target=self._read, args=(self._process, ready), daemon=True).start()
        if not ready.wait(START_TIMEOUT):
            self.stop()
            pytest.fail("the server did not come up:\n" + "\n".join(self.log))

    def _read(self, process: subprocess.Popen[str], ready: threading.Event) -> None:
        assert process.stdout is not None
        with process.stdout:
            for line in process.stdout:
                self.log.append(line.rstrip())
                if found := READY_LINE.search(line):
                    self.url = found[1].rstrip("/")
                    ready.set()

    def kill(self) -> None:
        self._end(signal.SIGKILL)

    def stop(self) -> None:
        self._end(signal.SIGTERM)

    def freeze(self) -> None:
        """It falls silent, with all its connections open, until `thaw`."""
        assert self._process is not None
        self._process.send_signal(signal.SIGSTOP)

    def thaw(self) -> None:
        assert self._process is not None
        self._process.send_signal(signal.SIGCONT)

    def _end(self, how: signal.Signals) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        process.send_signal(how)
        try:
            process.wait(STOP_TIMEOUT)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def ask(self, path: str) -> dict[str, Any]:
        """GET, as JSON."""
        request = urllib.request.Request(f"{self.url}/api/v1{path}", headers=self._headers)
        with urllib.request.urlopen(request, timeout=5) as answer:
            return json.load(answer)

    def send(self, method: str, path: str, body: dict[str, Any] | None = None) -> None:
        request = urllib.request.Request(
            f"{self.url}/api/v1{path}",
            json.dumps(body or {}).encode(),
            {"Content-Type": "application/json", **self._headers},
            method=method,
        )
        with urllib.request.urlopen(request, timeout=5):
            pass

    def story(self) -> str:
        """How the rig stands and what it has said last: why something did not come to be."""
        state = self.ask("/state")
        said = [event["message"] for event in self.ask("/events?limit=8")["events"]]
        return f"({state['rig']}, {state['tracking']}: {state['reason']}; {said})"

    def rest(self) -> None:
        """Disarmed and with the selection of a first visit, whatever the test before has left."""
        self.send("POST", "/estop")
        self.send("POST", "/reset")
        self._first_selection = self._first_selection or self.ask("/selection")
        self.send("PUT", "/selection", self._first_selection)


@dataclass
class Visit:
    """One tab: the page, and what it asked for, complained about, and was refused by its own policy."""

    page: Page
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)

    def watch(self, context: BrowserContext) -> None:
        context.expose_function("tellOfRefusal", lambda refusal: self.refused.append(refusal))
        context.add_init_script(TELLS_OF_REFUSALS)
        context.on("request", lambda request: self.requests.append(request.url))
        context.on("requestfailed", self._stayed)
        self.page.on("websocket", lambda socket: self.requests.append(socket.url))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", self._heard)

    def _stayed(self, request: Request) -> None:
        """What the page's policy has refused was told of and never sent."""
        if request.failure == "csp":
            self.requests.remove(request.url)

    def _heard(self, message: ConsoleMessage) -> None:
        if message.type == "error" and not REFUSAL.search(message.text):
            self.complaints.append(f"{message.text} ({message.location.get('url', '')})")

    def foreign(self, url: str) -> list[str]:
        """Requests that went anywhere else than to the server itself."""
        home = urlsplit(url).netloc
        return [seen for seen in self._sent() if urlsplit(seen).netloc != home]

    def elsewhere(self) -> list[str]:
        """Requests to another server than the first one."""
        return self.foreign(self._sent()[0]) if self._sent() else []

    def _sent(self) -> list[str]:
        return [seen for seen in self.requests if not seen.startswith(LOCAL_SCHEMES)]


def rig_state(page: Page) -> Locator:
    """What the bar says of the rig; a list that is loading is a status too."""
    return page.get_by_role("banner").get_by_role("status")


OpenTab = Callable[..., Visit]
"""open_tab(url, width, height) -> Visit"""


def becomes_true(holds: Callable[[], bool], timeout: float = PATIENCE) -> bool:
    """Look again and again; whether it came to be so within `timeout`, s."""
    deadline = time.monotonic() + timeout
    while not holds():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.1)
    return True


def eventually(
    holds: Callable[[], bool], what: str, timeout: float = PATIENCE, told: Callable[[], str] = str
) -> None:
    if not becomes_true(holds, timeout):
        pytest.fail(f"after {timeout:g} s still not: {what} {told()}")
