"""How much faster than real time the simulated robots are, each alone in the same field."""

from __future__ import annotations

import math
import time

from control.coils import command_field
from control.model import PIVOT_B, Pose
from control.simulation.plants import PlantChoice, build_plant

SECONDS = 2.0
TRIES = 5
STEP = 1e-3


def report() -> None:
    print(f"\nplants alone, {SECONDS:g} s of turning on one end; best of {TRIES}")
    print(f"{'plant':8} {'wall':>10} {'times real time':>16}")
    for name in ("noslip", "slip", "rigid"):
        wall = min(_turn(name) for _ in range(TRIES))
        print(f"{name:8} {1e3 * wall:7.1f} ms {SECONDS / wall:16.0f}")


def _turn(name: str) -> float:
    """Wall time, s."""
    plant = build_plant(PlantChoice(name), 0.01, Pose(0.0, 0.0, 0.0), seed=1)
    fields = [
        command_field(PIVOT_B, k * STEP, math.radians(25.0), 0.01) for k in range(round(SECONDS / STEP))
    ]
    begin = time.perf_counter()
    for field in fields:
        plant.step(field, STEP)
    return time.perf_counter() - begin
