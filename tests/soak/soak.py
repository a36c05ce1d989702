"""A soak: the simulated rig is served, a load looks on, the schedule is played, every invariant is on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

from server.settings import RigFile
from tests.faults.fault_bench import electrics_in
from tests.soak.broken import InvariantBroken
from tests.soak.growth import Growth, Look, growth_of
from tests.soak.hand import Hand
from tests.soak.live_rules import LiveRules
from tests.soak.load import Load, load_on
from tests.soak.process import Belongings, Served, served, starved
from tests.soak.recordings import Auditor
from tests.soak.scenes import Stage
from tests.soak.schedule import Act, acts
from tests.soak.watcher import Watcher

MINUTE = 60.0
LOOK_EVERY = 5.0
"""Seconds from one look at the memory to the next; a look keeps the server's memory from changing for some ms."""
WARM_SHARE = 0.4
WARM_BY = 390.0
"""What a process may keep is counted after this share of a soak, at the latest so long after its beginning, s: a round
of the schedule."""
SETTLES_WITHIN = 20.0
"""After the load has gone no process that makes an export is left so soon, s."""
SETTLES_AFTER = 4.0
"""Closed sockets are found out by then, s."""
THREADS = 6
"""Of the pools, which begin them when they are needed: at most as many as a pool of two processors has."""
FILES = 3
"""Connections that the operator's client keeps open or not."""


@dataclass(frozen=True, slots=True)
class Plan:
    """first: number of the act that is played first, for whoever looks for what broke an invariant."""

    seconds: float
    seed: int
    load: str = "light"
    first: int = 1


@dataclass(slots=True)
class Outcome:
    """Of a soak, as far as it came."""

    plan: Plan
    began: float = field(default_factory=time.monotonic)
    act: Act | None = None
    looks: list[Look] = field(default_factory=list)
    stage: Stage | None = None
    auditor: Auditor | None = None
    load: Load | None = None
    belongings: list[Belongings] = field(default_factory=list)
    starved: float = 0.0
    """How long the rig was kept from the processor in all, s."""
    ended_in: float | None = None
    broken: str = ""
    broken_at: float = 0.0
    log: str = ""

    @property
    def elapsed(self) -> float:
        return time.monotonic() - self.began

    @property
    def growth(self) -> Growth | None:
        return growth_of(self.looks) if self.looks else None


class Soak:
    """tell: hears of each act before it is played."""

    def __init__(self, plan: Plan, tell: Callable[[Outcome], None]) -> None:
        self.outcome = Outcome(plan)
        self._tell = tell
        self._ended = threading.Event()

    def run(self) -> Outcome:
        """Until its time is up or an invariant is broken."""
        outcome = self.outcome
        with TemporaryDirectory(prefix="soak-") as folder:
            log = Path(folder) / "server.log"
            try:
                with served(Path(folder) / "data", log, outcome.plan.seed) as server:
                    self._soak(server)
            except AssertionError as broken:
                outcome.broken, outcome.broken_at = str(broken), outcome.elapsed
            outcome.log = log.read_text()[-20_000:]
        return outcome

    def _soak(self, server: Served) -> None:
        outcome, plan = self.outcome, self.outcome.plan
        electrics = electrics_in(RigFile())
        outcome.auditor = Auditor(server.data, electrics)
        with (
            load_on(server.address, plan.load, plan.seed) as outcome.load,
            operated(server, LiveRules(electrics)) as outcome.stage,
            self._looking_at(server),
        ):
            outcome.began = time.monotonic()
            waits = server.waits()
            self._play()
            outcome.starved = starved(waits, server.waits())
            self._end(server)

    def _play(self) -> None:
        outcome, plan = self.outcome, self.outcome.plan
        stage, load = outcome.stage, outcome.load
        assert stage is not None
        assert load is not None
        warm = min(WARM_SHARE * plan.seconds, WARM_BY)
        for outcome.act in islice(acts(plan.seed), plan.first - 1, None):
            if outcome.elapsed > plan.seconds:
                return
            if not outcome.belongings and outcome.elapsed > warm:
                outcome.belongings.append(at_rest(stage, load))
                load.come()
            self._tell(outcome)
            stage.play(outcome.act)
            load.check()
            self._audit()

    def _end(self, server: Served) -> None:
        """Nothing left behind, nothing grown, gone in time while people watch."""
        outcome = self.outcome
        stage, load, auditor = outcome.stage, outcome.load, outcome.auditor
        assert stage is not None
        assert load is not None
        assert auditor is not None
        self._ended.set()
        outcome.belongings.append(at_rest(stage, load))
        self._audit()
        load.come()
        stage.hand.until("armed", outcome.act.walk if outcome.act else next(acts(1)).walk)
        stage.watcher.check()
        stage.watcher.expect_the_end()
        outcome.ended_in = server.end()
        load.leave()
        check_left(*outcome.belongings)
        auditor.pace.check(outcome.starved)
        growth = outcome.growth
        if growth is not None:
            growth.check()

    def _audit(self) -> None:
        """The recordings of the runs that are over."""
        stage, auditor = self.outcome.stage, self.outcome.auditor
        assert stage is not None
        assert auditor is not None
        for run in stage.finished():
            id = run["id"]
            if id not in stage.audited:
                stage.audited.add(id)
                faults = stage.faulted.get(id, ())
                stage.counts["recorded ticks"] += auditor.read(
                    id, faults, stage.windows, is_whole=id not in stage.cut_short
                )
                stage.counts["runs"] += 1

    @contextmanager
    def _looking_at(self, server: Served) -> Iterator[None]:
        """Its memory, every few seconds."""

        def look() -> None:
            while not self._ended.wait(LOOK_EVERY):
                self.outcome.looks.append(Look(self.outcome.elapsed, server.memory()))

        thread = threading.Thread(target=look, name="memory")
        thread.start()
        try:
            yield
        finally:
            self._ended.set()
            thread.join()


@contextmanager
def operated(server: Served, rules: LiveRules) -> Iterator[Stage]:
    hand = Hand(server.address)
    try:
        watcher = Watcher(server.address, rules, lambda: hand.asked)
        try:
            yield Stage(server, hand, watcher)
        finally:
            watcher.close()
    finally:
        hand.close()


def at_rest(stage: Stage, load: Load) -> Belongings:
    """What the server has while nobody but the operator is there and the rig rests: the least within some seconds."""
    load.leave()
    stage.hand.clear()
    stage.hand.must("POST", "/disarm")
    began = time.monotonic()
    least = stage.served.belongings()
    while (rested := time.monotonic() - began) < SETTLES_AFTER or (
        least.children and rested < SETTLES_WITHIN
    ):
        time.sleep(0.5)
        now = stage.served.belongings()
        least = Belongings(
            min(least.threads, now.threads), min(least.files, now.files), min(least.children, now.children)
        )
    return least


def check_left(warm: Belongings, last: Belongings) -> None:
    """I7."""
    if (
        last.threads > warm.threads + THREADS
        or last.files > warm.files + FILES
        or last.children > warm.children
    ):
        raise InvariantBroken(f"I7: at rest it had {warm} when it was warm, and {last} at the end")
