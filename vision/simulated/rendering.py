"""Draws the simulated camera's picture: plate, light, the robot and whatever else is in front of the camera.

The background is drawn once. A frame then costs one small patch around the robot, and one saturating
addition of sensor noise over every pixel; what else is there costs more, each thing for itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from control.model import Body
from vision.camera_model import CameraModel
from vision.simulated.board_view import BoardView, printed_board
from vision.simulated.figures import Figure, FigurePainter, Look, Shadow, top_surface
from vision.simulated.hand import SKIN, Hand
from vision.simulated.light import Glare, Light
from vision.simulated.plate import (
    NOISE_SPARE,
    PLATE,
    Colour,
    Image,
    as_seen,
    light_over,
    mottle_over,
    noise_tile,
    printed_grid,
    to_levels,
)

__all__ = ["Extras", "Painter", "SceneSettings", "top_surface"]

NO_SHADOW = Shadow(0.0, (0.0, 0.0))


@dataclass(frozen=True, slots=True)
class SceneSettings:
    """What the simulated camera sees, and how well.

    rate: frames/s.  latency: mid-exposure to delivery, s.
    assumed_latency: None for frames that bear the true time of their exposure; else what is subtracted from
    the time at which they come, s, as for a real camera.
    noise, blur: standard deviations of the sensor's noise, grey levels, and of the lens blur, px.
    light_gradient: change of light across the picture's width, as a fraction.
    shadow_strength: 0 (none) to 1 (black).  shadow_offset: from the body, on the plate, m.
    length, width, height: of the robot's body, m; the height is that of its top surface.
    colour, end_mark: of the body and of a mark on its end A, BGR grey levels; None: no mark.
    plate: colour of the plate, BGR grey levels.
    """

    rate: float = 60.0
    latency: float = 0.035
    assumed_latency: float | None = None
    noise: float = 3.0
    blur: float = 0.7
    light_gradient: float = 0.15
    shadow_strength: float = 0.35
    shadow_offset: tuple[float, float] = (0.0012, -0.0010)
    seed: int = 0
    length: float = 0.010
    width: float = 0.004
    height: float = 0.003
    colour: Colour = (40.0, 40.0, 200.0)
    end_mark: Colour | None = None
    plate: Colour = PLATE

    @property
    def look(self) -> Look:
        """Of the robot."""
        return Look(self.length, self.width, self.height, self.colour, self.end_mark)

    @property
    def shadow(self) -> Shadow:
        return Shadow(self.shadow_strength, self.shadow_offset)


@dataclass(frozen=True, slots=True)
class Extras:
    """What one picture shows beside the robot, and how the light is.

    moving: the robot at even times over the exposure, when it moves meanwhile.  company: others of its kind.
    litter: what lies on the plate, the same object as long as nothing changes.  shadow: when the light comes from
    elsewhere.  jpeg_quality: 1..100, of a camera that sends compressed pictures.
    """

    moving: tuple[Body, ...] = ()
    company: tuple[Figure, ...] = ()
    litter: tuple[Figure, ...] = ()
    shadow: Shadow | None = None
    light: Light = Light()
    hand: Hand | None = None
    glare: tuple[Glare, ...] = ()
    jpeg_quality: int | None = None


NOTHING_ELSE = Extras()


class Painter:
    """Draws frames, one after the other; equal settings, extras and frame numbers give equal bytes."""

    def __init__(self, optics: CameraModel, scene: SceneSettings) -> None:
        self._optics = optics
        self._scene = scene
        random = np.random.default_rng(scene.seed)
        self._light = light_over(optics.size, scene.light_gradient)
        self._noise, self._dark = noise_tile(optics.size, scene.noise, random)
        mottle = mottle_over(optics.size, random)
        plate = as_seen(self._light * printed_grid(optics), scene.plate, mottle, scene.blur)
        self._plate = to_levels(plate, self._dark)
        self._skin = to_levels(self._light[:, :, None] * np.array(SKIN, np.float32), self._dark)
        self._board: Image | None = None
        self._clean = np.empty_like(self._plate)
        self._littered: tuple[tuple[Figure, ...], Image] = (), self._plate
        self._figures = FigurePainter(optics, self._light, self._dark, scene.blur)
        self._offsets = random.integers(0, NOISE_SPARE, size=(4096, 2)).tolist()

    def show_board(self, view: BoardView | None) -> None:
        """Lays a printed board over the robot, or takes it away; may be called from any thread."""
        self._board = None if view is None else self._with_board(view)

    def paint(self, body: Body | None, index: int, extras: Extras = NOTHING_ELSE) -> NDArray[np.uint8]:
        """The picture with frame number `index`; without a body, the empty plate."""
        clean = self._clean
        np.copyto(clean, self._background(extras.litter))
        if self._board is None:
            for figure in self._shown(body, extras):
                self._figures.draw(clean, figure, extras.shadow or self._scene.shadow)
        if extras.hand is not None:
            extras.hand.draw(clean, self._skin)
        clean = extras.light.fall_on(clean, self._dark)
        for spot in extras.glare:
            spot.add_to(clean)
        image = cv2.add(clean, self._noise_of(index))
        if extras.jpeg_quality is not None:
            image = _compressed(image, extras.jpeg_quality)
        image.flags.writeable = False
        return np.asarray(image, np.uint8)

    def _shown(self, body: Body | None, extras: Extras) -> tuple[Figure, ...]:
        """All bodies, the robot last."""
        if body is None:
            return extras.company
        return *extras.company, Figure(extras.moving or (body,), self._scene.look)

    def _background(self, litter: tuple[Figure, ...]) -> Image:
        """Plate or board, with what lies on it."""
        board = self._board
        if board is not None:
            return board
        if self._littered[0] is not litter:
            image = self._plate.copy()
            for bit in litter:
                self._figures.draw(image, bit, NO_SHADOW)
            self._littered = litter, image
        return self._littered[1]

    def _with_board(self, view: BoardView) -> Image:
        """The board lying on the plate or held above it, without noise."""
        paper, cover = printed_board(view, self._optics, self._scene.blur)
        levels = to_levels((paper * self._light)[:, :, None].repeat(3, axis=2), self._dark)
        return cv2.blendLinear(self._plate, levels, 1.0 - cover, cover)

    def _noise_of(self, index: int) -> Image:
        width, height = self._optics.size
        left, top = self._offsets[index % len(self._offsets)]
        return self._noise[top : top + height, left : left + width]


def _compressed(image: Image, quality: int) -> Image:
    """What is left of a picture after JPEG with halved colour resolution, as cameras send it."""
    how = [
        cv2.IMWRITE_JPEG_QUALITY,
        quality,
        cv2.IMWRITE_JPEG_SAMPLING_FACTOR,
        cv2.IMWRITE_JPEG_SAMPLING_FACTOR_420,
    ]
    decoded = cv2.imdecode(cv2.imencode(".jpg", image, how)[1], cv2.IMREAD_COLOR)
    if decoded is None:
        raise RuntimeError(f"OpenCV could not read back its own JPEG of quality {quality}")
    return decoded
