"""What the tests of recordings share: short films of known greys, and playing them as fast as they go."""

from __future__ import annotations

from control.model import Frame
from vision.sources.opening import Camera

SIZE = (64, 48)
STEP = 20
"""Of grey between two frames of the short film."""
PATIENCE = 0.05
"""Longer than from frame to frame, s; at its end a film that is played fast lets this time pass, too."""


def greys(frames: list[Frame]) -> list[int]:
    return [round(float(frame.image.mean()) / STEP) for frame in frames]


def played_fast(camera: Camera, attempts: int) -> list[Frame]:
    frames = [frame for _ in range(attempts) if (frame := camera.read(PATIENCE)) is not None]
    camera.close()
    return frames
