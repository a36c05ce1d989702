"""How well the rig knows where its robot is, against the simulated truth, through pixels and bytes."""

import math

import numpy as np
import pytest

from control.gait import Gait
from control.model import Pose, Tracking, wrap
from control.runs import Choice, RunRequest, Selection
from control.snapshot import Snapshot
from server.assembly import build_machine
from server.headless import run_headless
from server.settings import GaitSection, RigFile

GAIT = Gait(sweep=math.radians(10.0), tilt=math.radians(25.0))
EIGHT = Selection(Choice("geometric"), Choice("eight"), GAIT)


def error_figures(
    plant: str, duration: float, gait: GaitSection | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Errors (mm, deg) of estimate and of newest sighting against the truth now, while locked."""
    rig_file = RigFile(gait=gait or GaitSection()).with_simulation(plant=plant, seed=1)
    machine = build_machine(rig_file, realtime=False)
    estimates, sightings = [], []

    def watch(snapshot: Snapshot) -> None:
        if snapshot.run is None or snapshot.tracking is not Tracking.LOCKED:
            return
        assert machine.world is not None
        assert snapshot.pose is not None
        assert snapshot.observation is not None
        assert snapshot.observation.measurement is not None
        true = machine.world.body().pose
        estimates.append(difference(snapshot.pose, true))
        sightings.append(difference(snapshot.observation.measurement.pose, true))

    run_headless(machine, "figures", RunRequest(EIGHT, duration=duration), watch)
    return np.array(estimates), np.array(sightings)


def difference(pose: Pose, true: Pose) -> tuple[float, float]:
    return 1e3 * pose.distance_to(true.x, true.y), math.degrees(abs(wrap(pose.heading - true.heading)))


@pytest.mark.parametrize("plant", ["slip", "noslip"])
def test_the_estimate_knows_where_the_robot_is_now_although_the_camera_is_late(
    plant: str, full: bool
) -> None:
    estimates, sightings = error_figures(plant, 125.66 if full else 30.0)
    median = np.median(estimates, axis=0)
    assert median[0] <= 0.1
    assert median[1] <= 0.5
    rms, rms_of_sightings = (np.sqrt((errors**2).mean(axis=0)) for errors in (estimates, sightings))
    assert (rms < rms_of_sightings).all()


def test_a_calibrated_gait_makes_the_estimate_better() -> None:
    table_at_25_deg = GaitSection(out_mm=-0.148, forward_base_mm=0.107, forward_per_sweep_mm_rad=0.419)
    rms = [
        np.sqrt((error_figures("slip", 20.0, gait)[0] ** 2).mean(axis=0))[0]
        for gait in (None, table_at_25_deg)
    ]
    assert rms[1] < 0.8 * rms[0]
