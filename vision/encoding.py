"""Pictures to bytes."""

from __future__ import annotations

import cv2
import numpy as np

from vision.tracking.colour import Image

JPEG_QUALITY = 80
"""Of 100: 40 to 70 kB for a noisy 640x480 picture, edges still sharp."""


def encode_jpeg(image: Image, quality: int = JPEG_QUALITY) -> bytes:
    """A BGR or grey picture as JPEG; quality 1..100."""
    if not 1 <= quality <= 100:
        raise ValueError(f"JPEG quality must be within 1..100, got {quality}")
    done, encoded = cv2.imencode(".jpg", image, (cv2.IMWRITE_JPEG_QUALITY, quality))
    if not done:
        raise ValueError(f"a picture of shape {image.shape} and type {image.dtype} cannot be written as JPEG")
    return encoded.tobytes()


MASK_COLOUR = (233, 180, 86, 205)
"""The sky blue of Okabe and Ito's palette, BGR, and how much it covers what is below, of 255."""


def encode_mask(mask: Image) -> bytes:
    """A mask (height, width) as a PNG to lay over its picture: coloured where it is set, clear elsewhere."""
    layer = np.zeros((*mask.shape, 4), np.uint8)
    layer[mask > 0] = MASK_COLOUR
    done, encoded = cv2.imencode(".png", layer)
    if not done:
        raise ValueError(f"a mask of shape {mask.shape} and type {mask.dtype} cannot be written as PNG")
    return encoded.tobytes()
