"""One fault in a rig that walks, from the fault until the robot walks again, with every invariant checked."""

from __future__ import annotations

from dataclasses import dataclass

from control.snapshot import RigState
from tests.faults.fault_bench import FaultBench, Reaction, fault_bench
from tests.faults.invariants import (
    check_announced,
    check_limits,
    check_period,
    check_recording,
    check_stays_zero,
    check_zero,
    nothing_left_behind,
)
from tests.faults.promises import PROMISES, Promise


@dataclass(frozen=True, slots=True)
class Trial:
    """largest: of the currents, as a share of its limit, %."""

    promise: Promise
    reaction: Reaction
    largest: float


def try_out(promise: Promise) -> Trial:
    """Raises AssertionError with the invariant that does not hold, or the promise that is not kept."""
    with nothing_left_behind(), fault_bench() as bench:
        bench.walk()
        reaction = bench.react(promise.name, promise.watch, **promise.parameters)
        check_promise(promise, reaction)
        mended = _mend(bench, promise)
        check_invariants(bench, promise, reaction, mended)
        bench.go_on(promise.tries)
        check_limits(bench.trace.samples, bench.electrics, promise.overshoot)
        check_recording(bench.recording_at_the_end(), reaction.fault * 1e-3)
        return Trial(promise, reaction, _largest(bench))


def check_promise(promise: Promise, reaction: Reaction) -> None:
    said = f"{reaction.code}: {reaction.reason}"
    allowed = promise.outcomes
    assert (reaction.after, reaction.code) in allowed, f"{allowed} was promised, not {reaction.after}; {said}"
    for due, taken in ((promise.noticed, reaction.noticed), (promise.zero, reaction.zero)):
        if due is not None:
            assert taken is not None
            assert taken <= due, f"{due} ms were promised, not {taken}; {said}"


def _mend(bench: FaultBench, promise: Promise) -> int:
    """The board's time when the operator may act again, ms."""
    bench.mend(promise.name)
    return bench.board.milliseconds


def check_invariants(bench: FaultBench, promise: Promise, reaction: Reaction, mended: int) -> None:
    trace, electrics = bench.trace, bench.electrics
    check_limits(trace.samples, electrics, promise.overshoot)
    since = reaction.fault * 1e-3
    check_period(trace.snapshots, lambda at: since <= at <= since + (promise.asleep + 100) * 1e-3)
    if promise.after is RigState.RUNNING:
        return
    assert reaction.noticed is not None
    noticeable = reaction.fault if promise.asleep else reaction.fault + reaction.noticed
    zero = check_zero(trace, electrics, noticeable, promise.overshoot)
    check_stays_zero(trace, zero, mended)
    check_announced(trace, reaction.code, (reaction.fault + promise.asleep) * 1e-3 - 0.1)


def _largest(bench: FaultBench) -> float:
    limits = bench.electrics.currents
    return 100.0 * max(
        abs(current) / limit
        for sample in bench.trace.samples
        for current, limit in zip(sample.currents, limits, strict=True)
    )


def keeps_its_promise(name: str) -> None:
    """Try one fault of the catalogue out."""
    try_out(PROMISES[name])
