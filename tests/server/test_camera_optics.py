"""The optics that the rig file describes: assumed, calibrated, and refused for another camera."""

import math

import pytest

from control.gait import Gait
from control.safety import Refused
from control.snapshot import RigState
from server.assembly import build_machine
from server.calibration.optics import assumed_model, calibration_problem, misfit, model_in_use
from server.settings import RigFile

LENS = {
    "identity": "simulated camera", "date": "2026-01-01 10:00:00", "size_px": [640, 480],
    "fx": 1300.0, "fy": 1301.0, "cx": 320.0, "cy": 240.0, "distortion": [-0.1, 0.0, 0.0, 0.0, 0.0],
    "residual_px": 0.05,
}  # fmt: skip
PLANE = {
    "source": "board", "identity": "simulated camera", "date": "2026-01-01 10:05:00", "size_px": [640, 480],
    "lens_date": "2026-01-01 10:00:00", "focal_px": 1300.0, "rotation_deg": [180.0, 0.0, 0.0],
    "translation_mm": [1.0, -2.0, 351.0], "residual_mm": 0.01, "residual_px": 0.05, "scale_px_mm": 3.7,
}  # fmt: skip
OTHER = {"identity": "usb 046d:0825 ABC123"}


def rig_file(**camera) -> RigFile:
    return RigFile.model_validate({"camera": camera})


def test_without_a_calibration_the_optics_are_those_that_the_rig_file_assumes():
    camera = RigFile().camera
    assert model_in_use(camera) is not None
    assert model_in_use(camera) == assumed_model(camera)
    assert calibration_problem(camera, "any camera") == ""


def test_lens_and_plane_make_the_model_of_the_tracker_and_not_the_picture_of_the_simulated_camera():
    settings = rig_file(lens=LENS, plane=PLANE)
    machine = build_machine(settings, realtime=False)
    machine.close()
    model = machine.camera_model
    assert (model.fx, model.fy, model.cx, model.cy) == (1300.0, 1301.0, 320.0, 240.0)
    assert model.translation == pytest.approx((0.001, -0.002, 0.351))
    assert model.to_pixel(0.0, 0.0) == pytest.approx((320.0 + 1.3 / 0.351, 240.0 - 2.602 / 0.351), abs=0.01)
    assert assumed_model(settings.camera) == assumed_model(RigFile().camera)


def test_a_lens_alone_leaves_the_scale_as_it_was_assumed():
    assumed, model = assumed_model(RigFile().camera), model_in_use(rig_file(lens=LENS).camera)
    assert model.fx == 1300.0
    assert model.scale_at(0.0, 0.0) == pytest.approx(assumed.scale_at(0.0, 0.0), rel=2e-3)


@pytest.mark.parametrize(
    ("lens", "plane", "words"),
    [
        (LENS | OTHER, PLANE, 'lens was calibrated for another camera, "usb 046d:0825 ABC123"'),
        (LENS, PLANE | OTHER, 'plane was calibrated for another camera, "usb 046d:0825 ABC123"'),
        (LENS | {"size_px": [1280, 720]}, None, "pictures of 1280 x 720 px, and these have 640 x 480 px"),
        (LENS, PLANE | {"size_px": [1280, 720]}, "pictures of 1280 x 720 px"),
        (LENS | {"date": "2026-02-02 09:00:00"}, PLANE, "another lens than the one in use"),
        (LENS | {"fx": 1290.0}, PLANE, "another lens than the one in use"),
        (None, PLANE, "another lens than the one in use"),
    ],
)
def test_a_calibration_that_is_not_this_camera_s_disarms_the_rig_and_says_why(lens, plane, words: str):
    machine = build_machine(rig_file(lens=lens, plane=plane), realtime=False)
    try:
        machine.open()
        for _ in range(30):
            machine.loop.tick(machine.camera.read(0.034), machine.camera.now())
        assert words in machine.loop.obstacle
        with pytest.raises(Refused, match="calibrat"):
            machine.loop.arm(Gait(), consent=True)
        assert machine.loop.state is RigState.DISARMED
    finally:
        machine.close()


def test_a_camera_that_has_not_been_there_yet_is_not_called_another_one():
    camera = rig_file(lens=LENS, plane=PLANE).camera
    assert camera.lens is not None
    assert misfit(camera, camera.lens, "") == ""
    assert calibration_problem(camera, "") == ""


def test_a_real_camera_s_calibration_is_not_in_the_way_when_the_rig_is_simulated():
    real = RigFile.model_validate(
        {
            "camera": {"uri": "v4l://0", "lens": LENS | OTHER, "plane": PLANE | OTHER},
            "link": {"port": "/dev/ttyACM0"},
        }
    )
    simulated = real.as_simulated().camera
    assert simulated.lens is simulated.plane is None
    own = rig_file(lens=LENS, plane=PLANE).as_simulated().camera
    assert own.lens is not None
    assert own.plane is not None


@pytest.mark.parametrize(
    "wrong",
    [
        {"lens": LENS | {"fx": 0.0}},
        {"lens": LENS | {"cx": math.nan}},
        {"lens": LENS | {"size_px": [640]}},
        {"plane": PLANE | {"translation_mm": [0.0, 0.0, -350.0]}},
        {"plane": PLANE | {"source": "guess"}},
        {"board": {"columns": 2}},
    ],
)
def test_a_calibration_of_impossible_values_is_no_rig_file(wrong: dict):
    with pytest.raises(ValueError, match=r"camera\."):
        rig_file(**wrong)
