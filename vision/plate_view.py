"""A camera's picture as it would be from straight above: the plate's plane, lens and tilt taken out."""

from __future__ import annotations

import cv2
import numpy as np

from vision.camera_model import CameraModel
from vision.tracking.colour import Image

OUTSIDE = (74, 66, 60)
"""Where the camera sees nothing of the plate, BGR: a dark grey."""


class PlateView:
    """Worked out once for a camera; then a picture takes about a millisecond.

    The upright square of 2 * `half` (m) around the workspace's origin, x to the right and y up, at `side` px.
    """

    def __init__(self, camera: CameraModel, half: float, side: int) -> None:
        steps = np.linspace(-half, half, side)
        x, y = np.meshgrid(steps, steps[::-1])
        pixels = camera.to_image(np.column_stack([x.ravel(), y.ravel()])).astype(np.float32)
        self._u, self._v = pixels.reshape(side, side, 2).transpose(2, 0, 1).copy()
        self._size = camera.size

    def of(self, image: Image) -> Image:
        """(side, side, 3) BGR of a picture of the camera; raises ValueError for a picture of another size."""
        if (image.shape[1], image.shape[0]) != self._size:
            raise ValueError(
                f"the camera is calibrated for pictures of {self._size[0]} x {self._size[1]} px, "
                f"got one of {image.shape[1]} x {image.shape[0]} px"
            )
        return cv2.remap(
            image, self._u, self._v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=OUTSIDE
        )
