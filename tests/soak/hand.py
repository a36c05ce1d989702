"""The operator of a soak: a script with one name that is heard all the time, and goes on after whatever happens."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import httpx

from tests.soak.broken import InvariantBroken
from tests.soak.schedule import Walk

NAME = "soak operator"
HEARD_EVERY = 0.5
"""Seconds; the lease of an operator is 2 s."""
PATIENCE = 20.0
"""Seconds that an answer may take."""
GOES_ON_WITHIN = 90.0
"""After the last fault was taken away the robot walks again within this time, s; a hot coil has to rest first."""
LOOKS_AGAIN = 0.1
PUT_BACK_AFTER = 8.0
"""A robot that is not found again so long after the last fault is put back by hand, s, as an operator would."""
HOME = {"x_mm": 0.0, "y_mm": -42.0, "heading_deg": 90.0}
"""Where the simulated robot stands at the beginning."""
REFUSED = 409, 422
ENERGISING = "/arm", "/runs", "/runs/current/resume", "/manual"


class Hand:
    """Commands over REST. asked: when it last asked for current, monotonic, s.

    put_back: how often it had to put the robot back by hand.
    """

    def __init__(self, address: str) -> None:
        self._http = httpx.Client(
            base_url=f"{address}/api/v1", headers={"X-Client": NAME}, timeout=PATIENCE, trust_env=False
        )
        self.asked = 0.0
        self.put_back = 0
        self._is_silent = threading.Event()
        self._ended = threading.Event()
        self._pulse = threading.Thread(target=self._stay_heard, name="pulse of the operator")
        self._pulse.start()

    def close(self) -> None:
        self._ended.set()
        self._pulse.join()
        self._http.close()

    def _stay_heard(self) -> None:
        while not self._ended.wait(HEARD_EVERY):
            if not self._is_silent.is_set():
                try:
                    self._http.get("/operator")
                except httpx.TransportError:
                    continue  # what it means is found out by whoever wants something

    @contextmanager
    def silent(self) -> Iterator[None]:
        self._is_silent.set()
        try:
            yield
        finally:
            self._is_silent.clear()

    # Asking --------------------------------------------------------------------------------------

    def call(self, method: str, path: str, **more: Any) -> httpx.Response:
        """Raises `InvariantBroken` for what the server should never answer."""
        if method == "POST" and path in ENERGISING:
            self.asked = time.monotonic()
        answer = self._http.request(method, path, **more)
        if answer.status_code >= 500 and answer.status_code != 503:
            raise InvariantBroken(f"{method} {path}: {answer.status_code} {answer.text[:400]}")
        return answer

    def get(self, path: str) -> Any:
        return self.call("GET", path).raise_for_status().json()

    def post(self, path: str, body: dict[str, Any] | None = None) -> httpx.Response:
        return self.call("POST", path, json=body) if body is not None else self.call("POST", path)

    @property
    def state(self) -> dict[str, Any]:
        return self.get("/state")

    def must(self, method: str, path: str, **more: Any) -> Any:
        """What always succeeds."""
        answer = self.call(method, path, **more)
        if not answer.is_success:
            raise InvariantBroken(f"{method} {path}: {answer.status_code} {answer.text[:400]}")
        return answer.json() if answer.content else None

    # As an operator does -------------------------------------------------------------------------

    def inject(self, body: dict[str, Any]) -> dict[str, Any]:
        return self.must("POST", "/simulation/faults", json=body)

    def clear(self) -> None:
        self.must("DELETE", "/simulation/faults")

    def until(self, rig: str, walk: Walk) -> dict[str, Any]:
        """On to `armed` or `running` from wherever the rig is; the state."""
        began = time.monotonic()
        give_up, put_back = began + GOES_ON_WITHIN, began + PUT_BACK_AFTER
        while (state := self.state)["rig"] != rig:
            if time.monotonic() > give_up:
                faults = [fault["message"] for fault in state["faults"]]
                raise InvariantBroken(f"it does not go on: {state['rig']}, {state['reason']}; {faults}")
            if state["tracking"] != "locked" and time.monotonic() > put_back:
                put_back = math.inf
                self.put_back += 1
                self.inject({"name": "robot_put", "parameters": HOME})
            if not self._step(state, rig, walk):
                time.sleep(LOOKS_AGAIN)
        return state

    def _step(self, state: dict[str, Any], rig: str, walk: Walk) -> bool:
        """Whether it has helped."""
        now = state["rig"]
        if now == "fault":
            return self._try("/reset")
        if now == "disarmed":
            return state["tracking"] == "locked" and self._try("/arm")
        if now == "held":
            return self._try("/runs/current/resume" if rig == "running" else "/disarm")
        if now == "running":
            return self._try("/runs/current/stop")
        return self._try("/runs", request_of(walk))

    def _try(self, path: str, body: dict[str, Any] | None = None) -> bool:
        answer = self.post(path, body)
        if not answer.is_success and answer.status_code not in (*REFUSED, 503):
            raise InvariantBroken(f"POST {path}: {answer.status_code} {answer.text[:400]}")
        return answer.is_success


def request_of(walk: Walk) -> dict[str, Any]:
    return {
        "controller": {"name": walk.controller},
        "trajectory": {"name": walk.trajectory},
        "gait": {"sweep_deg": 10.0},
        "passes": 20.0,
        "unattended": not walk.attended,
        "label": f"soak {walk.controller}",
        "tags": ["soak"],
    }
