"""`pivotrig doctor` on the camera's lens and plane: not calibrated, calibrated, and for another camera."""

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from server.cli import app
from server.diagnosis.calibration import examine
from server.settings import RigFile

LENS = {
    "identity": "simulated camera", "date": "2026-01-01 10:00:00", "size_px": [640, 480],
    "fx": 1300.0, "fy": 1301.0, "cx": 320.0, "cy": 240.0, "distortion": [-0.1, 0.0, 0.0, 0.0, 0.0],
    "residual_px": 0.05, "views": 12,
}  # fmt: skip
PLANE = {
    "source": "board", "identity": "simulated camera", "date": "2026-01-01 10:05:00", "size_px": [640, 480],
    "lens_date": "2026-01-01 10:00:00", "focal_px": 1300.0, "rotation_deg": [180.0, 0.0, 0.0],
    "translation_mm": [1.0, -2.0, 351.0], "residual_mm": 0.01, "residual_px": 0.05, "scale_px_mm": 3.7,
}  # fmt: skip
REAL = {"camera": {"uri": "v4l://0"}, "link": {"port": "/dev/ttyACM0"}}


def levels(settings: dict[str, Any], identity: str = "simulated camera") -> dict[str, tuple[str, str]]:
    checks = examine(RigFile.model_validate(settings), identity)
    return {check.name: (check.level.value, f"{check.finding} {check.advice}") for check in checks}


def calibrated(**changes: Any) -> dict[str, Any]:
    return {"camera": {"lens": LENS, "plane": PLANE, **changes}}


def test_a_calibrated_camera_is_well_and_how_well():
    found = levels(calibrated())
    assert found["lens"] == ("ok", "calibrated 2026-01-01 10:00:00: 12 views, residual 0.050 px ")
    assert found["plane"] == (
        "ok",
        "calibrated 2026-01-01 10:05:00: from board, positions known to 0.010 mm ",
    )


def test_a_real_camera_that_was_never_calibrated_is_to_be():
    for name, (level, words) in levels(REAL, "usb 046d:0825 ABC123").items():
        assert level == "warning"
        assert f"pivotrig calibrate {name} --save" in words
    assert {level for level, _ in levels({}).values()} == {"info"}


@pytest.mark.parametrize(
    ("settings", "identity", "words"),
    [
        (calibrated(), "usb 046d:0825 ABC123", 'this one is "usb 046d:0825 ABC123"; the rig does not arm'),
        (calibrated(size_px=[320, 240]), "simulated camera", "these have 320 x 240 px; the rig does not arm"),
        (calibrated(lens=None), "simulated camera", "another lens than the one in use; the rig does not arm"),
    ],
)
def test_a_calibration_that_is_not_this_camera_s_is_a_problem(
    settings: dict[str, Any], identity: str, words: str
):
    level, said = levels(settings, identity)["plane"]
    assert level == "problem"
    assert words in said


def test_the_command_asks_the_camera_itself_who_it_is(tmp_path: Path):
    rig_file = tmp_path / "rig.toml"
    section = "\n".join(f"{name} = {json.dumps(value)}" for name, value in LENS.items())
    rig_file.write_text(f"[camera.lens]\n{section}\n".replace("simulated camera", "usb 046d:0825 ABC123"))
    answer = CliRunner().invoke(app, ["doctor", "--json", "--rig", str(rig_file)])
    checks = {check["name"]: check for check in json.loads(answer.stdout)["checks"]}
    assert answer.exit_code == 1
    assert checks["lens"]["level"] == "problem"
    assert 'this one is "simulated camera"' in checks["lens"]["finding"]
