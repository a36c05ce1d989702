"""What a batch leaves out (pixels, bytes, currents) against the complete simulated rig, on the same walk."""

import math

import pytest

from control.gait import Gait
from control.metrics import Metrics
from control.model import Pose
from control.runs import Choice, RunRequest, Selection
from control.simulation.plants import PlantChoice
from control.snapshot import Snapshot
from control.studies.batch import simulate
from control.studies.plan import PlannedRun
from server.assembly import build_machine
from server.headless import run_headless
from server.settings import RigFile

START = Pose(0.0, -0.040, math.pi)
DURATION = 20.0
CONTROLLERS = ("geometric", "gradient", "planner")
NEAR = 3e-4
"""m, 3 % of the robot's length: measured 0.06 (geometric), 0.20 (gradient) and 0.05 mm (planner)."""


def on_the_rig(selection: Selection, plant: str) -> tuple[float, Metrics]:
    """Mean distance of the true robot from the reference, m, and the rig's own figures."""
    rig = RigFile().with_simulation(
        plant=plant, seed=1, start_x_mm=0.0, start_y_mm=-40.0, start_heading_deg=180.0
    )
    vision = rig.vision.model_copy(update={"heading_hint_deg": 180.0})
    machine = build_machine(rig.model_copy(update={"vision": vision}), realtime=False)
    errors: list[float] = []

    def watch(snapshot: Snapshot) -> None:
        if snapshot.run is not None and snapshot.reference is not None and machine.world is not None:
            errors.append(machine.world.body().pose.distance_to(*snapshot.reference))

    ended = run_headless(machine, "beside a batch", RunRequest(selection, duration=DURATION), watch).ended
    return sum(errors) / len(errors), ended.metrics


def in_a_batch(selection: Selection, plant: str) -> Metrics:
    run = PlannedRun(0, 0, 0, 1, {}, selection, duration=DURATION, plant=PlantChoice(plant), start=START)
    figures = simulate([run])[0]
    assert isinstance(figures, Metrics)
    return figures


def test_a_walk_without_slip_is_nearly_the_rigs(full: bool) -> None:
    """Both are deterministic but for the camera's noise; the currents and the picture's age are what differs."""
    for controller in CONTROLLERS if full else CONTROLLERS[:1]:
        selection = Selection(Choice(controller), Choice("eight"), Gait())
        true_error, rig = on_the_rig(selection, "noslip")
        batch = in_a_batch(selection, "noslip")
        assert batch.mean_error == pytest.approx(true_error, abs=NEAR)
        assert batch.steps == pytest.approx(rig.steps, abs=2)
        assert batch.sweeps == pytest.approx(rig.sweeps, abs=3)
        assert batch.travelled == pytest.approx(rig.travelled, rel=0.08)
