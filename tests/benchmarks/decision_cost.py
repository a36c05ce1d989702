"""What one decision of each controller costs, in processor time on one core, and how it grows with the horizon."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from control.controllers import Decision, Situation, controllers
from control.gait import Gait
from control.simulation.kinematic import TICK, KinematicWalker
from control.simulation.trade_off import PAPER_LENGTH, PAPER_START
from control.trajectories import trajectories

DECISIONS = 400
HORIZONS = (12, 24, 48)
WIDTHS = (12, 24, 48)
LOOK_AHEADS = (0.5, 1.0, 2.0)


class Timed:
    """Another controller under a stopwatch; only decisions at completed sweeps count: those are the dear ones."""

    def __init__(self, name: str, parameters: Mapping[str, Any]) -> None:
        self.name = name
        self._inner = controllers.build(name, parameters)
        self.times: list[float] = []

    def step(self, situation: Situation) -> Decision:
        begin = time.thread_time()
        decision = self._inner.step(situation)
        taken = time.thread_time() - begin
        if situation.may_switch:
            self.times.append(taken)
        return decision


def decision_times(name: str, parameters: Mapping[str, Any]) -> np.ndarray:
    """Seconds, (n,): on the paper's eight with sweeps of 30 degrees; the first one, which makes tables, included."""
    timed = Timed(name, parameters)
    gait = Gait(sweep=math.radians(30.0))
    eight = trajectories.build("eight", {})
    walker = KinematicWalker(timed, eight, gait, PAPER_START, PAPER_LENGTH)  # type: ignore[arg-type]
    tick = 0
    while len(timed.times) < DECISIONS:
        walker.advance(tick * TICK, TICK)
        tick += 1
    return np.array(timed.times)


def report() -> None:
    print("decision of a controller at a completed sweep, processor time on one core")
    _line("geometric", {}, "")
    for look_ahead in LOOK_AHEADS:
        _line("gradient", {"look_ahead_s": look_ahead}, f"look-ahead {look_ahead:.1f} s")
    for horizon in HORIZONS:
        _line("planner", {"horizon_slots": horizon}, f"horizon {horizon} slots")
    for width in WIDTHS:
        _line("planner", {"beam_width": width}, f"beam of {width}")
    _line("planner", {"early_end": True}, "sweeps may end early")


def _line(name: str, parameters: Mapping[str, Any], what: str) -> None:
    half, most = np.percentile(decision_times(name, parameters), [50, 99]) * 1e3
    print(f"{name:10} {what:22} p50 {half:6.3f} ms   p99 {most:6.3f} ms")
