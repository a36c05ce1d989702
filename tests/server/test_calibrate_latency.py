"""`pivotrig calibrate latency` on a simulated rig whose camera stamps its frames as a real one does."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from control.controllers.wiggle import WiggleParameters
from control.gait import Gait
from control.model import Tracking, wrap
from control.runs import Choice, RunRequest, Selection
from control.safety import Refused
from control.snapshot import Snapshot
from server.assembly import Machine, build_machine
from server.calibration.latency import Latency, LatencyWalk, calibrate_latency
from server.camera_sections import CameraSection
from server.cli import app
from server.diagnosis.latency import examine
from server.headless import run_headless
from server.rig_file import load_rig_file
from server.settings import EstimatorSection, LinkSection, RigFile

WITHIN = 0.002
"""The latency is found as exactly as this, s."""


def rig(plant: str = "slip", latency_ms: float = 35.0, known_ms: float = 0.0, **more) -> RigFile:
    """As fast as it goes a tick takes no time, so commands have none of the delay that a real rig's have."""
    settings = RigFile(
        camera=CameraSection(latency_ms=known_ms), estimator=EstimatorSection(actuation_delay_ms=0.0)
    )
    simulation = {"start_x_mm": 0.0, "start_y_mm": 0.0, "stamps": "arrival", **more}
    return settings.with_simulation(plant=plant, latency_ms=latency_ms, **simulation)


def found(settings: RigFile, turns: int = 12) -> Latency:
    machine = build_machine(settings, realtime=False)
    return calibrate_latency(machine, "latency", Gait(), WiggleParameters(turns=turns))


CASES = [("slip", 100.0), ("noslip", 35.0)]
MORE = [(plant, late) for plant in ("slip", "noslip") for late in (10.0, 20.0, 35.0, 60.0, 80.0, 100.0)]


def test_the_true_latency_is_found_within_two_milliseconds(full: bool) -> None:
    for plant, latency_ms in MORE if full else CASES:
        for seed in range(1, 6 if full else 2):
            answer = found(rig(plant, latency_ms, seed=seed))
            assert answer.latency == pytest.approx(latency_ms * 1e-3, abs=WITHIN), (plant, latency_ms, seed)
            assert answer.standard_error < WITHIN


def test_a_camera_that_knows_its_exposures_true_time_is_not_late_at_all() -> None:
    assert found(rig(stamps="capture")).latency == pytest.approx(0.0, abs=WITHIN)


def test_what_the_rig_file_had_counts_whether_it_was_too_little_or_too_much() -> None:
    answer = found(rig(latency_ms=20.0, known_ms=35.0))
    assert answer.delay.delay == pytest.approx(-0.015, abs=WITHIN)
    assert answer.latency == pytest.approx(0.020, abs=WITHIN)


def test_a_robot_that_is_not_seen_gives_no_latency() -> None:
    machine = build_machine(rig(), realtime=False)
    machine.camera.disturbance.hidden = True  # type: ignore[attr-defined]
    with pytest.raises(Refused, match="not seen"):
        calibrate_latency(machine, "latency", Gait(), WiggleParameters())


def test_a_robot_that_turns_against_the_field_gives_no_latency() -> None:
    machine = build_machine(rig(wiring=["-x", "y", "z"]), realtime=False)
    with pytest.raises(Refused, match="turns against the field"):
        calibrate_latency(machine, "latency", Gait(), WiggleParameters())


def errors(settings: RigFile) -> np.ndarray:
    """How far the estimate is from the truth while it walks an eight, mm and degrees; rows of locked ticks."""
    machine = build_machine(settings, realtime=False)
    world, rows = machine.world, []
    assert world is not None

    def watch(snapshot: Snapshot) -> None:
        if snapshot.run is None or snapshot.tracking is not Tracking.LOCKED:
            return
        pose, true = snapshot.pose, world.body().pose
        assert pose is not None
        rows.append(
            (1e3 * pose.distance_to(true.x, true.y), math.degrees(abs(wrap(pose.heading - true.heading))))
        )

    gait = Gait(sweep=math.radians(10.0), tilt=math.radians(25.0))
    eight = Selection(Choice("geometric"), Choice("eight"), gait)
    run_headless(machine, "eight", RunRequest(eight, duration=5.0), watch)
    return np.array(rows)


def saved_latency(tmp_path: Path, settings: RigFile) -> RigFile:
    """The rig file after `pivotrig calibrate latency --save`."""
    path = tmp_path / "rig.toml"
    simulation = settings.simulation
    path.write_text(
        f'# kept\n[simulation]\nplant = "{simulation.plant}"\nstamps = "arrival"\n'
        "[estimator]\nactuation_delay_ms = 0.0\n"
    )
    answer = CliRunner().invoke(app, ["calibrate", "latency", "--rig", str(path), "--save", "--json"])
    assert answer.exit_code == 0, answer.stderr
    figures = json.loads(answer.stdout)
    assert figures["latency_ms"]["value"] == pytest.approx(35.0, abs=2.0)
    assert "# kept" in path.read_text()
    saved = load_rig_file(path)
    assert saved.camera.latency_ms == pytest.approx(figures["latency_ms"]["value"], abs=0.01)
    assert saved.camera.latency_source.startswith("measured 20")
    return saved


def test_once_it_is_saved_the_estimate_is_as_good_as_with_true_stamps(tmp_path: Path) -> None:
    plant = {"plant": "noslip"}  # a slipping robot whose camera is late and not known to be is soon lost
    before = np.median(errors(rig().with_simulation(**plant, start_y_mm=-42.0)), axis=0)
    saved = saved_latency(tmp_path, rig("noslip"))
    after = np.median(errors(saved), axis=0)
    true = np.median(errors(saved.with_simulation(stamps="capture")), axis=0)
    assert before[1] > 0.8
    assert (after < 0.15 * before).all()
    assert (after < 1.5 * true + (0.003, 0.03)).all()


def test_nothing_is_driven_through_real_coils_without_consent(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text('[camera]\nuri = "v4l://0"\n[link]\nport = "/dev/ttyACM0"\n')
    answer = CliRunner().invoke(app, ["calibrate", "latency", "--rig", str(path)], input="n\n")
    assert answer.exit_code == 3
    assert "nothing was driven" in " ".join(answer.stderr.split())


def test_the_doctor_says_that_a_real_camera_s_latency_was_never_measured() -> None:
    for uri in ("v4l://0", "rtsp://camera/1", "rtsps://camera/1", "HTTP://camera/1"):
        assert examine(real(uri=uri)).level == "warning", uri
    unknown = examine(real(uri="v4l://0"))
    assert "calibrate latency --save" in unknown.advice
    known = examine(
        real(uri="v4l://0", latency_ms=31.0, latency_source="measured 2026-05-01, standard error 1.1 ms")
    )
    assert known.level == "ok"
    assert "31 ms (measured 2026-05-01" in known.finding
    assert examine(real(uri="file:///walk.mp4")).level == "ok"


def real(**camera) -> RigFile:
    return RigFile(camera=CameraSection(**camera), link=LinkSection(port="/dev/ttyACM0"))


class LateClock:
    """A machine whose clock shows `by` s more; what it tells is the same."""

    def __init__(self, machine: Machine, by: float) -> None:
        self.settings, self.loop, self._machine, self._by = machine.settings, self, machine, by

    def field_at(self, time: float) -> tuple[float, float]:
        return self._machine.loop.field_at(time - self._by)

    def told(self, snapshot: Snapshot) -> Snapshot:
        seen = snapshot.observation
        if seen is not None and seen.measurement is not None:
            later = replace(seen.measurement, captured_at=seen.measurement.captured_at + self._by)
            seen = replace(seen, measurement=later)
        return replace(snapshot, time=snapshot.time + self._by, observation=seen)


@pytest.mark.parametrize("uptime", [34_137.414, 1.0e6 / 3.0])
def test_the_hour_that_the_computer_has_been_up_for_does_not_matter(uptime: float) -> None:
    machine = build_machine(rig(), realtime=False)
    clock = LateClock(machine, uptime)
    walk = LatencyWalk(clock, Gait(), WiggleParameters(turns=8))  # type: ignore[arg-type]
    run_headless(machine, "latency", walk.request, lambda snapshot: walk.watch(clock.told(snapshot)))
    assert walk.found().latency == pytest.approx(0.035, abs=WITHIN)
