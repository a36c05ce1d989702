"""The robot's colour in the camera's picture: whether it is one blob, and how well it stands out."""

from __future__ import annotations

from control.model import Frame
from server.calibration.optics import model_in_use
from server.diagnosis.check import Check, ok, warning
from server.settings import MM, RigFile
from server.vision_settings import tracker_settings
from vision.camera_model import CameraModel
from vision.tracking.detection import Candidate, find
from vision.tracking.picking import CLOSE, PickError, Sight, pick

CLICK = "put the robot under the camera, click on it in the dashboard and use the colour that it finds"


def examine(frame: Frame, settings: RigFile) -> Check:
    model, looks = model_in_use(settings.camera), tracker_settings(settings.vision)
    width, height = model.size
    if frame.image.shape != (height, width, 3):
        return warning(
            "robot's colour", "not looked for in a picture of another size", "set camera.size_px first"
        )
    covered = 100.0 * float((looks.colours.mask(frame.image) > 0).mean())
    found = f"{covered:.2g} % of the picture has it"
    robot_height = settings.robot.body_height_mm * MM
    region = looks.region.scaled(model.scale_at(0.0, 0.0, robot_height) ** 2)
    blobs = find(frame.image, (0, 0, width, height), looks.colours, region)
    if not blobs:
        return warning("robot's colour", f"{found}, and no blob is as large as the robot", CLICK)
    if len(blobs) > 1:
        advice = f"take away what is not the robot, or {CLICK}"
        return warning("robot's colour", f"{found}, and {len(blobs)} blobs look like the robot", advice)
    return _standing_out(frame, settings, model, blobs[0], f"{found}, in one blob")


def _standing_out(frame: Frame, settings: RigFile, model: CameraModel, blob: Candidate, found: str) -> Check:
    """As a click on the blob would find it."""
    robot = settings.robot
    sight = Sight(frame.image, model, robot.body_height_mm * MM, robot.body_length_mm * MM)
    try:
        proposal = pick(sight, blob.centre)
    except PickError as error:
        return warning("robot's colour", f"{found} that does not stand out: {error}", CLICK)
    found = f"{found}; {100 * proposal.separation:.0f} % separated from its surroundings"
    if not proposal.separation >= CLOSE:
        return warning("robot's colour", found, "use a background of another colour, or more light")
    return ok("robot's colour", found)
