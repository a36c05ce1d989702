"""What can go wrong between the robot and its measured pose."""

from __future__ import annotations

from control.registry import Parameters
from control.simulation.faults.kind import WHEN_TAKEN_AWAY, Family, FaultKind, quantity, share
from control.simulation.faults.points import FaultPoints

MM = 1e-3
MS = 1e-3
NIGHT = 0.03
"""What is left of the light when the lamp is out, as a share."""


class Late(Parameters):
    extra_ms: float = quantity(300.0, "ms", 0.0, 5000.0, "Additional age of every picture")


class Lost(Parameters):
    share: float = share(0.3, "Share of the pictures that are lost")


class Exposure(Parameters):
    factor: float = quantity(2.0, "1", 0.05, 10.0, "How bright the picture becomes, relative to before")


class Flicker(Parameters):
    depth: float = share(0.5, "How much darker the light is at its darkest")


class Twin(Parameters):
    distance_mm: float = quantity(25.0, "mm", 5.0, 100.0, "From the robot")


class Jump(Parameters):
    dx_mm: float = quantity(20.0, "mm", -200.0, 200.0, "Along x")
    dy_mm: float = quantity(0.0, "mm", -200.0, 200.0, "Along y")


def _unplugged(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.unplugged = on


def _frozen(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.frozen = on


def _hidden(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.hidden = on


def _mirrored(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.mirrored = on


def _cropped(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.cropped = on


def _timeless(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.timeless = on


def _late(points: FaultPoints, extra: float) -> None:
    points.camera.disturbance.extra_latency = extra


def _lost(points: FaultPoints, share_lost: float) -> None:
    points.camera.disturbance.lost = share_lost


def _light(points: FaultPoints, light: float) -> None:
    points.camera.disturbance.light = light


def _exposure(points: FaultPoints, factor: float) -> None:
    points.camera.disturbance.exposure = factor


def _flicker(points: FaultPoints, depth: float) -> None:
    points.camera.disturbance.flicker = depth


def _glare(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.glare = on


def _twin(points: FaultPoints, distance: float) -> None:
    points.camera.disturbance.twin = distance


def _hand(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.hand = on


def _litter(points: FaultPoints, on: bool) -> None:
    points.camera.disturbance.litter = on


def _jump(points: FaultPoints, offset: tuple[float, float]) -> None:
    points.sighting.offset = offset


def _no_number(points: FaultPoints, on: bool) -> None:
    points.sighting.not_a_number = on


KINDS = (
    FaultKind(
        "camera_unplugged", 1, Family.CAMERA, "Camera unplugged",
        "The camera's cable is out: no more pictures.",
        "when the cable is back: the rig opens the camera again, and you resume",
        lambda points, _: _unplugged(points, True), lambda points: _unplugged(points, False),
    ),
    FaultKind(
        "camera_frozen", 2, Family.CAMERA, "Picture frozen",
        "The camera sends the same picture again and again, with new times.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _frozen(points, True), lambda points: _frozen(points, False),
    ),
    FaultKind(
        "camera_late", 3, Family.CAMERA, "Pictures late",
        "Pictures pile up in the camera's driver and arrive long after they were taken.",
        WHEN_TAKEN_AWAY,
        lambda points, late: _late(points, late.extra_ms * MS), lambda points: _late(points, 0.0), Late,
    ),
    FaultKind(
        "camera_drops", 3, Family.CAMERA, "Pictures lost",
        "A share of the pictures never arrives.",
        WHEN_TAKEN_AWAY,
        lambda points, lost: _lost(points, lost.share), lambda points: _lost(points, 0.0), Lost,
    ),
    FaultKind(
        "camera_mirrored", 4, Family.CAMERA, "Picture mirrored",
        "The camera's driver mirrors the picture: left is right.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _mirrored(points, True), lambda points: _mirrored(points, False),
    ),
    FaultKind(
        "camera_cropped", 19, Family.CAMERA, "Picture of another size",
        "The camera suddenly delivers pictures of half the size.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _cropped(points, True), lambda points: _cropped(points, False),
    ),
    FaultKind(
        "camera_timeless", 19, Family.CAMERA, "Picture without a time",
        "The capture time of every picture is not a number.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _timeless(points, True), lambda points: _timeless(points, False),
    ),
    FaultKind(
        "robot_hidden", 6, Family.CAMERA, "Robot hidden",
        "Something covers the robot, or it has been taken away.",
        "when the camera sees the robot again",
        lambda points, _: _hidden(points, True), lambda points: _hidden(points, False),
    ),
    FaultKind(
        "light_off", 5, Family.CAMERA, "Light off",
        "The lamp over the plate goes out: the picture is nearly black.",
        "when the light is on again",
        lambda points, _: _light(points, NIGHT), lambda points: _light(points, 1.0),
    ),
    FaultKind(
        "exposure_jump", 5, Family.CAMERA, "Exposure jumps",
        "From one picture to the next everything is brighter or darker, as when an automatic exposure acts.",
        WHEN_TAKEN_AWAY,
        lambda points, jump: _exposure(points, jump.factor), lambda points: _exposure(points, 1.0), Exposure,
    ),
    FaultKind(
        "flicker", 5, Family.CAMERA, "Light flickers",
        "A lamp flickers with the mains: dark bands wander through the picture.",
        WHEN_TAKEN_AWAY,
        lambda points, flicker: _flicker(points, flicker.depth), lambda points: _flicker(points, 0.0), Flicker,
    ),
    FaultKind(
        "glare", 5, Family.CAMERA, "Glare on the robot",
        "A lamp is mirrored in the robot: a part of it is white.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _glare(points, True), lambda points: _glare(points, False),
    ),
    FaultKind(
        "hand", 6, Family.CAMERA, "Hand in the picture",
        "A hand reaches into the picture and stays over the robot.",
        "when the camera sees the robot again",
        lambda points, _: _hand(points, True), lambda points: _hand(points, False),
    ),
    FaultKind(
        "second_robot", 7, Family.CAMERA, "Second robot",
        "Another robot just like it lies on the plate.",
        "when the other one is gone",
        lambda points, twin: _twin(points, twin.distance_mm * MM), lambda points: _twin(points, 0.0), Twin,
    ),
    FaultKind(
        "debris", 7, Family.CAMERA, "Bits on the plate",
        "Specks, fibres and flakes lie about; some have the robot's colour.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _litter(points, True), lambda points: _litter(points, False),
    ),
    FaultKind(
        "sighting_jumps", 8, Family.CAMERA, "Sighting jumps",
        "The tracker sees the robot far from where it is.",
        WHEN_TAKEN_AWAY,
        lambda points, jump: _jump(points, (jump.dx_mm * MM, jump.dy_mm * MM)),
        lambda points: _jump(points, (0.0, 0.0)), Jump,
    ),
    FaultKind(
        "sighting_nan", 19, Family.CAMERA, "Sighting is not a number",
        "The tracker's pose is not a number.",
        WHEN_TAKEN_AWAY,
        lambda points, _: _no_number(points, True), lambda points: _no_number(points, False),
    ),
)  # fmt: skip
