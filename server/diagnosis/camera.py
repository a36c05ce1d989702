"""The camera: is it there, what size and rate it delivers, and whether there is anything in the picture."""

from __future__ import annotations

from collections.abc import Iterator

from control.model import Frame
from control.parts import Camera
from server.diagnosis import calibration, colour
from server.diagnosis.check import Check, info, ok, problem, warning
from server.settings import RigFile
from vision.sources.addresses import shown
from vision.sources.listing import FoundCamera
from vision.sources.request import CameraError

WATCHED = 1.0
"""How long frames are counted, s of the camera's clock."""
FIRST_FRAME = 3.0
"""A camera that has just been opened may take so long to its first frame, s."""
SLOWER = 0.9
"""Of the asked rate that still counts as kept."""
CORRECT = "ask for what the camera offers in [camera] of the rig file, or leave the line out"
INSPECT = "see to its cable and its supply; record a damaged film anew"
DARK = 8.0
"""Mean grey level (0..255) of a picture behind a lens cap."""


def listed(cameras: list[FoundCamera]) -> Check:
    """Those of this computer, whichever the rig uses."""
    if not cameras:
        return info("cameras", "none on this computer")
    return info("cameras", "; ".join(map(in_words, cameras)))


def in_words(camera: FoundCamera) -> str:
    used = ", in use" if camera.in_use else ""
    return f"{camera.name} ({camera.identity}) at {camera.uri}{used}"


def cannot_be_opened(error: CameraError) -> Check:
    return problem("camera", str(error), "connect it, or correct [camera] in the rig file")


def examine(camera: Camera, settings: RigFile) -> Iterator[Check]:
    """What it does otherwise than asked it has said when it was opened; what goes wrong later is no setting."""
    yield from (warning("camera settings", note.message, CORRECT) for note in camera.take_notes())
    frames = watch(camera)
    yield from (warning("camera trouble", note.message, INSPECT) for note in camera.take_notes())
    if len(frames) < 2:
        found = f"{shown(settings.camera.uri)} delivers no frames"
        yield problem("camera", found, "connect it anew; close other programs")
        return
    yield delivery(frames, settings)
    yield content(frames[-1])
    yield from calibration.examine(settings, camera.identity)
    yield colour.examine(frames[-1], settings)


def watch(camera: Camera) -> list[Frame]:
    """The frames of a second, from the first one on."""
    frames: list[Frame] = []
    until = camera.now() + FIRST_FRAME
    while camera.now() < until:
        frame = camera.read(0.05)
        if frame is not None:
            until = until if frames else frame.captured_at + WATCHED
            frames.append(frame)
    return frames


def delivery(frames: list[Frame], settings: RigFile) -> Check:
    height, width = frames[-1].image.shape[:2]
    asked = settings.camera
    rate = (len(frames) - 1) / (frames[-1].captured_at - frames[0].captured_at)
    found = f"{shown(asked.uri)}: {width}x{height} px, {rate:.1f} frames/s"
    if (width, height) != asked.size_px:
        size = f"{asked.size_px[0]}x{asked.size_px[1]}"
        return problem(
            "camera", f"{found}; {size} px were asked", "set camera.size_px to a size that it offers"
        )
    if not rate >= SLOWER * asked.rate_Hz:
        advice = (
            "more light (shorter exposure), a smaller picture, another USB port, or a lower camera.rate_Hz"
        )
        return warning("camera", f"{found}; {asked.rate_Hz:g} were asked", advice)
    return ok("camera", found)


def content(frame: Frame) -> Check:
    mean = float(frame.image.mean())
    if not mean >= DARK:
        return warning(
            "picture",
            f"dark: mean grey level {mean:.0f} of 255",
            "take the lens cap off, switch the light on",
        )
    return ok("picture", f"mean grey level {mean:.0f} of 255")
