"""The plane from points that are known on it: where the camera is over the workspace, and how well that is known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.calibration.board import Sighting
from vision.calibration.lens import Lens
from vision.calibration.position_error import PoseFit, position_error
from vision.camera_model import CalibrationError, CameraModel, Rotation

Floats = NDArray[np.float64]

FEWEST_MARKS = 4
"""Four points on a plane fix a camera's pose, if no three of them are on one line."""
CLICK_ERROR = 0.5
"""How well a person points at a mark, px, until the points themselves say more (assumed)."""
ENOUGH_FREEDOM = 6
"""Points with so many degrees of freedom (6 marks) speak for themselves; four corners have two, and the assumption
counts for the other four."""
POOREST_CLICKS = 5.0
"""Points that disagree by more, px RMS, were exchanged, or their places are not what was said."""
POOREST_BOARD = 1.5
"""The same for the corners of a board, px: it is bent, its squares are of another size, or the lens is another."""
SURELY_WRONG = 4.0
"""A mark that the others put so many standard deviations elsewhere is named."""
FINEST = 0.01
"""Points are never known better than this, px: without noise every difference would be a surely wrong mark."""
FLATTEST = 0.02
"""Points whose extent across their line is less than this share of that along it are on one line."""
NO_CAMERA = (
    "these points fit no camera above the plate: are they in order, clockwise in the picture, and are the measures "
    "right?"
)


class PlaneSource(StrEnum):
    """What the plane was found from."""

    BOARD = "board"
    CORNERS = "corners"
    MARKS = "marks"


@dataclass(frozen=True, slots=True)
class PlaneFit:
    """The camera over the workspace.

    rotation: vector (rad), workspace to camera.  translation: m.  residual: RMS error of positions over the
    workspace, m, as it is estimated.  residual_picture: RMS distance between the points seen and fitted, px.
    remarks: in words, what else is worth knowing.
    """

    source: PlaneSource
    lens: Lens
    rotation: tuple[float, float, float]
    translation: tuple[float, float, float]
    residual: float
    residual_picture: float
    remarks: tuple[str, ...] = ()

    @property
    def model(self) -> CameraModel:
        return camera_model(self.lens, self.rotation, self.translation)

    @property
    def camera_height(self) -> float:
        """Of the lens above the plate, m."""
        return _place(self.model)[2]

    @property
    def tilt(self) -> float:
        """Of the camera against looking straight down, rad."""
        return math.acos(max(-1.0, min(1.0, -self.model.rotation[2][2])))


def camera_model(
    lens: Lens, rotation: tuple[float, float, float], translation: tuple[float, float, float]
) -> CameraModel:
    """Lens and plane together; rotation as a vector, rad."""
    first, second, third = cv2.Rodrigues(np.array(rotation))[0].tolist()
    turned: Rotation = tuple(first), tuple(second), tuple(third)
    return CameraModel(lens.size, lens.fx, lens.fy, lens.cx, lens.cy, lens.distortion, turned, translation)


def _place(model: CameraModel) -> tuple[float, float, float]:
    """Of the camera in the workspace, m."""
    x, y, z = (-np.array(model.rotation).T @ np.array(model.translation)).tolist()
    return x, y, z


def plane_from_board(lens: Lens, sighting: Sighting, workspace: float, thickness: float = 0.0) -> PlaneFit:
    """The plane that the board lies on; the workspace's origin and axes become the board's.

    workspace: half the side of its square, m.  thickness: of the board, m: its print is so far above the plate.
    """
    _require_size(lens, sighting.size)
    points = np.column_stack([sighting.places, np.full(len(sighting.places), thickness)])
    fit = _pose(lens, points, sighting.pixels)
    residual = _rms(fit.residuals)
    if not residual <= POOREST_BOARD:
        raise CalibrationError(
            f"the board's corners are off by {residual:.2f} px, at most {POOREST_BOARD:g} px are a calibration: does "
            "it lie flat, is its square size right, and is the lens calibrated?"
        )
    return _plane(PlaneSource.BOARD, fit, workspace, ())


def plane_from_corners(
    lens: Lens, pixels: Floats, rectangle: tuple[float, float], workspace: float
) -> PlaneFit:
    """From the corners (4, 2) px of a rectangle (width, height; m), round it from its upper left one.

    Its middle becomes the workspace's origin, and its upper edge, to the right, the x axis. Corners that were
    clicked the other way round are put in order.
    """
    width, height = rectangle
    if not (width > 0.0 and height > 0.0 and math.isfinite(width) and math.isfinite(height)):
        raise CalibrationError(
            f"the rectangle must be wider and higher than 0 mm, got {width * 1e3:g} x {height * 1e3:g} mm"
        )
    x, y = 0.5 * width, 0.5 * height
    places = np.array([[-x, y], [x, y], [x, -y], [-x, -y]])
    weak = "four corners hardly check each other: more marks, or the printed board, tell how good this is"
    return _clicked(PlaneSource.CORNERS, lens, _in_order(pixels), places, workspace, (weak,))


def plane_from_marks(lens: Lens, pixels: Floats, places: Floats, workspace: float) -> PlaneFit:
    """From marks (n, 2) m on the plate that are seen at (n, 2) px; n is at least 4."""
    if len(pixels) < FEWEST_MARKS:
        raise CalibrationError(f"the plane needs at least {FEWEST_MARKS} marks, got {len(pixels)}: add marks")
    return _clicked(PlaneSource.MARKS, lens, pixels, places, workspace, ())


def _clicked(
    source: PlaneSource,
    lens: Lens,
    pixels: Floats,
    places: Floats,
    workspace: float,
    remarks: tuple[str, ...],
) -> PlaneFit:
    _require_spread(places, "on the plate")
    _require_spread(pixels, "in the picture")
    _require_more_than_a_line(places)
    points = np.column_stack([places, np.zeros(len(places))])
    fit = _pose(lens, points, pixels, ENOUGH_FREEDOM)
    residual = _rms(fit.residuals)
    if not residual <= POOREST_CLICKS:
        raise CalibrationError(
            f"the points disagree by {residual:.1f} px, at most {POOREST_CLICKS:g} px are a calibration: are they in "
            f"order, and are the measures right? {_suspect(lens, points, pixels)}".rstrip()
        )
    suspect = _suspect(lens, points, pixels)
    return _plane(source, fit, workspace, (*remarks, suspect) if suspect else remarks)


def _in_order(pixels: Floats) -> Floats:
    """Corners round a rectangle clockwise in the picture, the first one staying first."""
    pixels = np.asarray(pixels, float)
    if pixels.shape != (4, 2):
        raise CalibrationError(f"a rectangle has four corners, got {len(pixels)}")
    around = pixels - pixels.mean(axis=0)
    angles = np.arctan2(around[:, 1], around[:, 0])
    return pixels[np.argsort((angles - angles[0]) % (2.0 * math.pi))]


def _require_spread(points: Floats, where: str) -> None:
    """Refuse points that are not finite, or all on one line."""
    if not np.isfinite(points).all():
        raise CalibrationError(f"the points {where} must be finite numbers")
    if not _is_spread(points):
        raise CalibrationError(f"the points {where} are on one line: spread them over the workspace")


def _is_spread(points: Floats) -> bool:
    along, across = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[:2]
    return bool(along > 0.0 and across >= FLATTEST * along)


def _require_more_than_a_line(places: Floats) -> None:
    """Refuse a line and one point beside it: two poses of the camera explain these nearly alike, some mm apart."""
    for number in range(len(places)):
        if not _is_spread(np.delete(places, number, axis=0)):
            raise CalibrationError(
                f"all points but number {number + 1} are on one line: add another one away from that line"
            )


def _require_size(lens: Lens, size: tuple[int, int]) -> None:
    if size != lens.size:
        raise CalibrationError(
            f"the lens holds for pictures of {lens.size[0]} x {lens.size[1]} px and this one has "
            f"{size[0]} x {size[1]} px: calibrate the lens at that size, or set camera.size_px back"
        )


def _pose(lens: Lens, points: Floats, pixels: Floats, enough: int = 0) -> PoseFit:
    """Least squares in the picture, from both of the poses that a plane seen from afar may have.

    enough: degrees of freedom; what the points lack of them, the assumed error of a click stands for.
    """
    # OpenCV takes an array in another layout for another array, without a word.
    points, pixels = np.ascontiguousarray(points, float), np.ascontiguousarray(pixels, float)
    starts = _starts(lens, points - (0.0, 0.0, points[0, 2]), pixels)
    fits = [_refined(lens, points, pixels, turn, shift) for turn, shift in starts]
    above = [fit for fit in fits if _is_above(fit[0], fit[1])]
    if not above:
        raise CalibrationError(NO_CAMERA)
    turn, shift, residuals = min(above, key=lambda fit: _rms(fit[2]))
    squares, freedom = float(np.sum(residuals**2)), residuals.size - 6
    assumed = max(enough - freedom, 0)
    noise = math.sqrt((squares + assumed * CLICK_ERROR**2) / (freedom + assumed))
    return PoseFit(lens, turn, shift, points, residuals, noise)


def _starts(lens: Lens, flat: Floats, pixels: Floats) -> list[tuple[Floats, Floats]]:
    """Poses to begin with: the two that explain a plane best, and a third, for points whose symmetry leaves these
    undefined. Raises CalibrationError."""
    lens_terms = lens.matrix, lens.coefficients
    try:
        _, turns, shifts, _ = cv2.solvePnPGeneric(flat, pixels, *lens_terms, flags=cv2.SOLVEPNP_IPPE)
        _, turn, shift = cv2.solvePnP(flat, pixels, *lens_terms, flags=cv2.SOLVEPNP_ITERATIVE)
    except cv2.error as error:
        raise CalibrationError(NO_CAMERA) from error
    all_three = zip([*turns, turn], [*shifts, shift], strict=True)
    starts = [(np.array(turn, float), np.array(shift, float)) for turn, shift in all_three]
    return [start for start in starts if np.isfinite(start).all()]


def _refined(
    lens: Lens, points: Floats, pixels: Floats, turn: Floats, shift: Floats
) -> tuple[Floats, Floats, Floats]:
    """Rotation vector, translation (m), and residuals (n, 2) px."""
    refined = cv2.solvePnPRefineLM(points, pixels, lens.matrix, lens.coefficients, turn, shift)
    turn, shift = (np.asarray(vector, float).ravel() for vector in refined)
    seen, _ = lens.project(points, turn, shift)
    return turn, shift, pixels - seen


def _is_above(turn: Floats, shift: Floats) -> bool:
    rotation = cv2.Rodrigues(turn)[0]
    return bool((-rotation.T @ shift)[2] > 0.0 and shift[2] > 0.0)


def _suspect(lens: Lens, points: Floats, pixels: Floats) -> str:
    """Names the mark that the others put somewhere else; "" when they agree, or cannot tell."""
    if len(points) <= FEWEST_MARKS:
        return ""
    doubts = [(number, *_left_out(lens, points, pixels, number)) for number in range(len(points))]
    number, ratio, distance = max(doubts, key=lambda doubt: doubt[1], default=(0, 0.0, 0.0))
    if not ratio > SURELY_WRONG:
        return ""
    return f"mark {number + 1} is {distance * 1e3:.1f} mm from where the others put it: look at it again"


def _left_out(lens: Lens, points: Floats, pixels: Floats, number: int) -> tuple[float, float]:
    """How far one mark is from where the others put it, in standard deviations of theirs, and m.

    0 when the others by themselves fit no camera.
    """
    others = np.arange(len(points)) != number
    try:
        fit = _pose(lens, points[others], pixels[others], ENOUGH_FREEDOM)
    except CalibrationError:
        return 0.0, 0.0
    seen, _ = lens.project(points[number : number + 1], fit.turn, fit.shift)
    away = float(np.linalg.norm(pixels[number] - seen[0]))
    x, y, z = points[number].tolist()
    model = camera_model(lens, _triple(fit.turn), _triple(fit.shift))
    return away / max(fit.noise, FINEST), away / model.scale_at(x, y, z)


def _plane(source: PlaneSource, fit: PoseFit, workspace: float, remarks: tuple[str, ...]) -> PlaneFit:
    return PlaneFit(
        source,
        fit.lens,
        _triple(fit.turn),
        _triple(fit.shift),
        position_error(fit, workspace),
        _rms(fit.residuals),
        remarks,
    )


def _triple(values: Floats) -> tuple[float, float, float]:
    x, y, z = np.asarray(values, float).ravel().tolist()
    return x, y, z


def _rms(residuals: Floats) -> float:
    return math.sqrt(float(np.mean(np.sum(residuals**2, axis=1))))
