"""The compiled firmware in the complete loop: simulated camera, tracker, filter, link, emulated board, plant."""

from __future__ import annotations

import math

import pytest

from control.gait import Gait
from control.metrics import Metrics
from control.runs import Choice, RunRequest, Selection
from server.assembly import build_machine
from server.headless import run_headless
from server.settings import RigFile

WALK = Selection(
    Choice("geometric"), Choice("eight"), Gait(sweep=math.radians(10.0), tilt=math.radians(25.0))
)
PART = 12.0
"""Seconds of the eight in the everyday run of the tests; the full run walks all of it."""


def walked(board: str, seed: int, duration: float | None) -> Metrics:
    machine = build_machine(RigFile().with_simulation(board=board, seed=seed), realtime=False)
    return run_headless(machine, f"eight-{board}", RunRequest(WALK, duration=duration)).ended.metrics


@pytest.mark.timeout(900)
def test_the_compiled_firmware_walks_the_eight_as_well_as_its_twin(full: bool) -> None:
    duration = None if full else PART
    for seed in (1, 3) if full else (3,):
        twin, emulated = walked("twin", seed, duration), walked("emulated", seed, duration)
        assert emulated.mean_error == pytest.approx(twin.mean_error, rel=0.2)
        assert emulated.travelled == pytest.approx(twin.travelled, rel=0.2)
        assert emulated.sweeps == pytest.approx(twin.sweeps, rel=0.2)


def test_a_stepped_walk_on_the_emulated_board_is_the_same_each_time() -> None:
    first, again = (walked("emulated", 5, 2.0) for _ in range(2))
    assert first == again
