"""The catalogue of faults, and what the documentation promises of each."""

from __future__ import annotations

from pathlib import Path

import pytest
from pydantic import ValidationError

from control.registry import UnknownName
from control.simulation.faults.injection import KINDS, Pattern
from control.snapshot import RigState
from tests.faults.fault_bench import FaultBench
from tests.faults.promises import PROMISES
from tests.faults.table import BEGIN, END, EVENTS, document_rows

SAFETY = Path(__file__).parents[2] / "SAFETY.md"


def test_every_fault_of_the_catalogue_has_a_promise() -> None:
    assert set(PROMISES) == set(KINDS)


def test_the_documented_table_has_the_rows_of_the_catalogue() -> None:
    text = SAFETY.read_text(encoding="utf-8")
    rows = document_rows(text[text.index(BEGIN) : text.index(END)])
    assert [row[0] for row in rows] == [
        *(promise.kind.title for promise in PROMISES.values()),
        *(event.title for event in EVENTS),
    ]
    for row, promise in zip(rows, PROMISES.values(), strict=False):
        assert row[2] == promise.state
        assert row[-1] == promise.go_on


def test_nothing_is_wrong_until_somebody_says_so(bench: FaultBench) -> None:
    bench.walk()
    bench.run_for(1.0)
    assert bench.snapshot.rig is RigState.RUNNING
    assert list(bench.faults) == []


def test_a_fault_is_over_after_its_duration(bench: FaultBench) -> None:
    bench.walk()
    bench.faults.inject("robot_hidden", duration=0.1)
    bench.run_for(0.5)
    assert list(bench.faults) == []
    assert bench.snapshot.rig is RigState.RUNNING, "it was predicted meanwhile"


def test_a_fault_may_come_and_go(bench: FaultBench) -> None:
    bench.walk()
    injection = bench.faults.inject("camera_unplugged", pattern=Pattern(on=0.03, off=0.2))
    seen = set()
    for _ in range(60):
        bench.tick()
        seen.add(injection.is_on)
    assert seen == {True, False}
    assert bench.snapshot.rig is RigState.RUNNING, "no gap was long enough"


def test_a_fault_that_is_put_in_again_takes_its_new_parameters(bench: FaultBench) -> None:
    bench.faults.inject("line_loses", {"share": 0.1})
    bench.faults.inject("line_loses", {"share": 0.5})
    bench.tick()
    (injection,) = bench.faults
    assert injection.parameters.model_dump() == {"share": 0.5}


@pytest.mark.parametrize(("one", "other"), [("supply_low", "supply_off"), ("sense_dead", "sense_wrong")])
def test_taking_one_fault_away_leaves_the_other_one_in(bench: FaultBench, one: str, other: str) -> None:
    """Two faults may spoil the same thing; it is right again when both are gone."""
    bench.faults.inject(one)
    bench.faults.inject(other)
    spoilt = _electrics(bench)
    bench.faults.clear(one)
    bench.tick()
    assert _electrics(bench) == spoilt
    bench.faults.clear(other)
    bench.tick()
    assert _electrics(bench) != spoilt


def _electrics(bench: FaultBench) -> tuple[float, ...]:
    """The supply, and what the three senses show of one ampere."""
    bridges = bench.board.bridges
    return bridges.supply, *bridges._sense


def test_injections_are_lines_of_the_log(bench: FaultBench) -> None:
    bench.faults.inject("supply_off")
    bench.faults.clear("supply_off")
    bench.run_for(0.1)
    messages = [event.message for event in bench.trace.events if event.code == "injected"]
    assert messages == ["injected: Supply off", "no longer injected: Supply off"]


def test_no_parameter_takes_what_is_no_number(bench: FaultBench) -> None:
    for name, kind in KINDS.items():
        for field in kind.parameters.model_fields:
            for value in (float("nan"), float("inf"), "much", None, -1e9):
                with pytest.raises(ValidationError):
                    bench.faults.inject(name, {field: value})
    assert list(bench.faults) == []


def test_an_unknown_fault_is_refused_with_what_there_is(bench: FaultBench) -> None:
    with pytest.raises(UnknownName, match="no fault called 'gremlins'; choose one of: camera_unplugged"):
        bench.faults.inject("gremlins")
