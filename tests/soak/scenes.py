"""How each act of the schedule is played on the served rig, and what must come of it."""

from __future__ import annotations

import json
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import httpx
from websockets.sync.client import connect

from server.fault_watch import LOOK
from tests.soak.broken import InvariantBroken
from tests.soak.hand import HOME, Hand
from tests.soak.process import Served, starved
from tests.soak.reactions import Reactions
from tests.soak.recordings import Window
from tests.soak.schedule import Act, What
from tests.soak.watcher import Watcher

WALKS_FOR = 1.0
"""Before a fault, s: the field is up."""
MENDED = 0.6
"""After a fault was taken away the line and the camera are opened again, s."""
JOG_EVERY = 0.1
SILENT_FOR = 3.0
"""The lease of an operator is 2 s."""
KEPT_RUNS = 6
"""Of the runs that are over, when some are deleted."""
INSTANTS = 8
"""Of a recording that are asked for in a replay."""
BY_HAND = {"robot_put": HOME, "coil_hot": {"heat_percent": 0.0}}
"""What mends those faults that happen once and stay: the robot is put back, the coil has cooled down."""
FORMATS = "samples.csv", "samples.parquet", "plot.png", "recording.mcap"

REFUSALS: tuple[tuple[str, str, str, tuple[int, ...]], ...] = (
    ("POST", "/runs", '{"nonsense": 1}', (422,)),
    ("POST", "/runs", '{"duration_s": NaN}', (400, 422)),
    ("POST", "/manual", '{"pivot": 3, "rate_deg_s": 1e9}', (422,)),
    ("PATCH", "/rig", '{"limits": {"current_A": [1e6, 0, 0]}}', (409, 422)),
    ("POST", "/simulation/faults", '{"name": "gremlin"}', (404, 422)),
    ("DELETE", "/simulation/faults/gremlin", "", (404,)),
    ("PUT", "/selection", "[[[[", (400, 422)),
    ("DELETE", "/runs/none", "", (404,)),
    ("POST", "/vision/pick", '{"u": -5, "v": 1e300}', (409, 422)),
)
"""Method, path, body, and what they may be answered with."""


@dataclass(slots=True)
class Stage:
    """windows: rig times between which faults held the loop up.  faulted: since when, rig time, by run.

    cut_short: runs whose recording a fault of the disk has ended.
    """

    served: Served
    hand: Hand
    watcher: Watcher
    reactions: Reactions = field(default_factory=Reactions)
    counts: Counter[str] = field(default_factory=Counter)
    windows: list[Window] = field(default_factory=list)
    faulted: dict[str, list[float]] = field(default_factory=dict)
    cut_short: set[str] = field(default_factory=set)
    audited: set[str] = field(default_factory=set)

    def play(self, act: Act) -> None:
        """Raises `InvariantBroken`."""
        self.counts[act.what.value] += 1
        _SCENES[act.what](self, act)
        self.watcher.check()

    # The world's -----------------------------------------------------------------------------------

    def fault(self, act: Act) -> None:
        state = self._walking(act)
        names = frozenset(fault.name for fault in act.faults)
        self._note(state, names)
        self.watcher.begin(names)
        waits = self.served.waits()
        for fault in act.faults:
            self.hand.inject(fault.body)
        self._watch_for(act.seconds)
        waited = starved(waits, self.served.waits())
        entries = self._verdicts(names)
        self._mend(names)
        self.windows.append((state["time_s"] - 0.1, self.hand.state["time_s"] + MENDED))
        if len(act.faults) == 1:
            fault = act.faults[0]
            self.counts[self.reactions.judge(entries[fault.name], waited, fault.is_usual)] += 1
        self.hand.until("running", act.walk)

    def _verdicts(self, names: frozenset[str]) -> dict[str, dict[str, Any]]:
        """The server's entries of these faults, by name, when it has made up its mind."""
        until = time.monotonic() + LOOK + MENDED
        while True:
            faults = self.hand.get("/simulation/faults")["faults"]
            entries = {entry["name"]: entry for entry in faults if entry["name"] in names}
            if all(entry["reaction"]["verdict"] != "watching" for entry in entries.values()):
                return entries
            if time.monotonic() > until:
                raise InvariantBroken(f"{' and '.join(names)}: no verdict {LOOK:g} s later: {entries}")
            self._watch_for(0.2)

    def _mend(self, names: frozenset[str]) -> None:
        self.hand.clear()
        for name in names & BY_HAND.keys():
            self.hand.inject({"name": name, "parameters": BY_HAND[name]})
        self.watcher.end()
        time.sleep(MENDED)

    def _note(self, state: dict[str, Any], names: frozenset[str]) -> None:
        """What the recording of the run that is on must have."""
        run = state["run"]
        if run is not None:
            self.faulted.setdefault(run["id"], []).append(state["time_s"])
            if any(name.startswith("disk") for name in names):
                self.cut_short.add(run["id"])

    # The operator's --------------------------------------------------------------------------------

    def pause(self, act: Act) -> None:
        self._walking(act)
        self.hand.must("POST", "/runs/current/pause")
        self._watch_for(1.0)
        self._is("held")
        self.hand.until("running", act.walk)

    def stop(self, act: Act) -> None:
        self._walking(act)
        self.hand.must("POST", "/runs/current/stop")
        self._is("armed", "held", "disarmed")
        self.hand.must("POST", "/disarm")
        self._watch_for(1.0)
        self._is("disarmed")

    def estop(self, act: Act) -> None:
        self._walking(act)
        self.hand.must("POST", "/estop")
        self._is("fault")
        self._watch_for(1.0)
        self._is("fault")

    def jog(self, act: Act) -> None:
        self.hand.until("armed", act.walk)
        until, pivot = time.monotonic() + act.seconds, 1
        while time.monotonic() < until:
            self.hand.post("/manual", {"pivot": pivot, "rate_deg_s": 20.0 * pivot})
            pivot = -pivot if int((until - time.monotonic()) / 0.7) % 2 else pivot
            time.sleep(JOG_EVERY)

    def select(self, act: Act) -> None:
        selection = self.hand.get("/selection")
        selection["controller"] = {"name": act.walk.controller}
        selection["trajectory"] = {"name": act.walk.trajectory}
        self.hand.must("PUT", "/selection", json=selection)

    def change(self, act: Act) -> None:
        self._walking(act)
        answer = self.hand.call("PATCH", "/runs/current", json={"controller": {"name": act.walk.controller}})
        if answer.status_code not in (200, 409):
            raise InvariantBroken(f"a change on the way: {answer.status_code} {answer.text[:300]}")
        self._watch_for(act.seconds)

    def refused(self, _: Act) -> None:
        before = self.hand.state["rig"]
        for method, path, body, allowed in REFUSALS:
            answer = self.hand.call(method, path, content=body, headers={"Content-Type": "application/json"})
            if answer.status_code not in allowed:
                raise InvariantBroken(
                    f"{method} {path} {body}: {answer.status_code}, not {allowed}: {answer.text[:300]}"
                )
        if before == "disarmed" and self.hand.state["rig"] != before:
            raise InvariantBroken("a refused request has changed the state of the rig")

    def silence(self, act: Act) -> None:
        """An attended run is held when its operator is not heard of any more."""
        if self.hand.state["rig"] == "running":
            self.hand.until("armed", act.walk)
        self.hand.until("running", type(act.walk)(act.walk.controller, act.walk.trajectory, True))
        with self.hand.silent():
            self._watch_for(SILENT_FOR)
            address = f"{self.served.address}/api/v1/state"
            state = httpx.get(
                address, headers={"X-Client": "soak onlooker"}, timeout=20.0, trust_env=False
            ).json()
        if state["rig"] == "running":
            raise InvariantBroken(f"it walks on {SILENT_FOR:g} s after its operator was last heard")

    def walk(self, act: Act) -> None:
        self._walking(act)
        self._watch_for(2.0 * act.seconds)

    # What is asked of the archive ------------------------------------------------------------------

    def finished(self) -> list[dict[str, Any]]:
        """Runs whose recording is whole or as whole as it will be, newest first."""
        runs = self.hand.get("/runs?limit=100")["runs"]
        return [run for run in runs if run["state"] != "running" and run["recording"]["state"] != "writing"]

    def export(self, _: Act) -> None:
        for run in self.finished()[:1]:
            for name in FORMATS:
                answer = self.hand.call("GET", f"/runs/{run['id']}/{name}")
                if not answer.is_success and run["id"] not in self.cut_short:
                    raise InvariantBroken(f"{name} of {run['id']}: {answer.status_code} {answer.text[:300]}")
                self.counts[name] += 1

    def replay(self, _: Act) -> None:
        for run in self.finished()[:1]:
            address = self.served.address.replace("http", "ws", 1)
            with connect(f"{address}/api/v1/replay?run={run['id']}", proxy=None, max_size=None) as line:
                duration = json.loads(line.recv(timeout=20.0))["runs"][0]["duration_s"]
                for number in range(INSTANTS):
                    line.send(json.dumps({"at_s": duration * number / INSTANTS, "frame": True}))
                    while isinstance(answer := line.recv(timeout=20.0), bytes):
                        pass
                    if json.loads(answer)["type"] != "replay":
                        raise InvariantBroken(f"a replay answers {answer[:300]}")

    def delete(self, _: Act) -> None:
        for run in self.finished()[KEPT_RUNS:]:
            if run["id"] in self.audited:
                self.hand.must("DELETE", f"/runs/{run['id']}")
                self.counts["deleted"] += 1

    # Steps -----------------------------------------------------------------------------------------

    def _walking(self, act: Act) -> dict[str, Any]:
        """It has walked for a moment, so that the field is up and the run is recorded."""
        while True:
            self.hand.until("running", act.walk)
            self._watch_for(WALKS_FOR)
            if (state := self.hand.state)["rig"] == "running":
                return state
            self.counts["let go by itself"] += 1

    def _watch_for(self, seconds: float) -> None:
        time.sleep(seconds)
        self.watcher.check()

    def _is(self, *allowed: str) -> None:
        state = self.hand.state
        if state["rig"] not in allowed:
            raise InvariantBroken(
                f"{' or '.join(allowed)} was asked for, not {state['rig']}: {state['reason']}"
            )


_SCENES: dict[What, Callable[[Stage, Act], None]] = {
    What.FAULT: Stage.fault, What.TWO_FAULTS: Stage.fault, What.PAUSE: Stage.pause, What.STOP: Stage.stop,
    What.ESTOP: Stage.estop, What.JOG: Stage.jog, What.SELECT: Stage.select, What.CHANGE: Stage.change,
    What.REFUSED: Stage.refused, What.EXPORT: Stage.export, What.REPLAY: Stage.replay, What.DELETE: Stage.delete,
    What.SILENCE: Stage.silence, What.WALK: Stage.walk,
}  # fmt: skip
