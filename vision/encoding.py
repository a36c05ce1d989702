"""Pictures to bytes."""

from __future__ import annotations

import cv2

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
