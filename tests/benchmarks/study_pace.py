"""How many runs of the paper's study a batch does per second, against the plain loop of one run in the same process."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from itertools import islice

from control.metrics import Metrics
from control.studies.batch import Failed, plain_walk, simulate
from control.studies.definition import StudyDefinition
from control.studies.examples import examples
from control.studies.plan import Plan, PlannedRun
from control.studies.workers import hired

COMPARED = 6
"""Runs that the plain loop is asked for; a run of 42 to 126 s each."""


def report() -> None:
    print("\nbatches: the paper's 63 sets of one eight each on the slip plant (77 s a run on average)")
    _against_the_plain_loop()
    _over_runs()
    _over_workers()


def _plan(controller: str) -> Plan:
    definition = StudyDefinition.from_toml(examples()["paper-section-6"])
    section = definition.controller.model_copy(update={"name": controller, "parameters": {}})
    return definition.model_copy(update={"controller": section}).plan()


def _runs(controller: str, count: int) -> list[PlannedRun]:
    plan = _plan(controller)
    return [plan.run(index) for index in islice(plan.next({}), count)]


def _seconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def _against_the_plain_loop() -> None:
    print(f"{'controller':12} {'plain':>12} {'compiled':>14} {'times':>8}   results")
    for controller in ("geometric", "gradient"):
        runs = _runs(controller, 63)
        simulate(runs)
        plain: list[Metrics] = []
        slow = _seconds(
            lambda runs=runs, plain=plain: plain.extend(plain_walk(run) for run in runs[:COMPARED])
        )
        fast = _seconds(lambda runs=runs: simulate(10 * list(runs[:COMPARED]))) / 10
        same = "equal" if simulate(runs[:COMPARED]) == plain else "not equal"
        print(
            f"{controller:12} {COMPARED / slow:8.2f} /s {COMPARED / fast:10.0f} /s {slow / fast:8.0f}   {same}"
        )
    planner = _runs("planner", 1)
    print(f"{'planner':12} {1.0 / _seconds(lambda: simulate(planner)):8.2f} /s   (plain loop only)")


def _over_runs() -> None:
    print(f"{'runs':>12} {'time':>12} {'per run':>12}")
    for count in (63, 126, 252, 504):
        runs = _runs("geometric", count)
        seconds = _seconds(lambda runs=runs: simulate(runs))
        print(f"{count:12} {seconds:10.2f} s {1e3 * seconds / count:9.2f} ms")


def _over_workers() -> None:
    """A worker is a process of its own: its start costs more than 630 runs, and is shown beside them."""
    print(f"{'workers':>12} {'start':>12} {'630 runs':>12}   (wall time)")
    runs = _runs("geometric", 630)
    tables: list[Sequence[tuple[int, Metrics | Failed]]] = []
    for workers in (1, 2):
        with hired(workers) as crew:
            start = time.perf_counter()
            list(crew.carry_out(runs[:63]))
            ready = time.perf_counter()
            tables.append(list(crew.carry_out(runs)))
            print(f"{workers:12} {ready - start:10.2f} s {time.perf_counter() - ready:10.2f} s")
    print(f"{'':12} {'tables equal' if tables[0] == tables[1] else 'TABLES DIFFER':>14}")
