"""What the trials of the rig's promises need beyond the promises themselves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from control.simulation.faults import promises as made
from tests.faults.invariants import OVERSHOOT, OVERSHOOT_UNSENSED


@dataclass(frozen=True, slots=True)
class Promise(made.Promise):
    """watch: how long the trial looks, s.  asleep: the loop itself stands still, ms.

    overshoot: share by which a current may pass its limit.  tries: of the operator to go on.
    watchdog: the test of the server's watchdog, which finds it while the loop alone still waits, "" for none.
    """

    watch: float = 1.0
    asleep: int = 0
    overshoot: float = OVERSHOOT
    tries: int = 1
    watchdog: str = ""


TRIALS: Mapping[str, Mapping[str, Any]] = {
    "camera_mirrored": {"tries": 2},
    "line_slow": {"watch": 1.5},
    "sense_dead": {"overshoot": OVERSHOOT_UNSENSED},
    "coil_resistance": {"watch": 2.0},
    "coil_swapped": {"tries": 2},
    "loop_stalls": {"asleep": 400},
    "computer_sleeps": {"asleep": 2000, "watch": 3.0},
    "controller_hangs": {"asleep": 3034, "watch": 5.0, "watchdog": "test_hanging_controller"},
}


def _tried(promise: made.Promise) -> Promise:
    given = {field.name: getattr(promise, field.name) for field in fields(promise)}
    return Promise(**given, **TRIALS.get(promise.name, {}))


PROMISES = {name: _tried(promise) for name, promise in made.PROMISES.items()}
