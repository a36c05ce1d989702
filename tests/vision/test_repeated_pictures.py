"""A frozen camera repeats its picture; a quiet plate on which a small robot moves does not (row 2)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from control.arbiter import FROZEN_FRAMES
from control.model import Frame
from control.perception import THUMBNAIL, Perception
from server.assembly import build_machine
from server.settings import RigFile


@pytest.fixture
def perception() -> Iterator[Perception]:
    """Of a simulated rig, shown pictures of our own."""
    machine = build_machine(RigFile(), realtime=False)
    yield machine.loop.parts.perception
    machine.close()


def picture(number: int, column: int) -> Frame:
    """A noise-free plate with a robot that fits between the samples of a thumbnail."""
    image = np.full((480, 640, 3), 170, np.uint8)
    image[THUMBNAIL + 1 : THUMBNAIL + 9, THUMBNAIL + column : THUMBNAIL + column + 8] = (40, 40, 200)
    return Frame(image, 1.0 + number / 60.0, number)


def test_a_robot_that_moves_between_the_samples_makes_new_pictures(perception: Perception) -> None:
    for number in range(6):
        frame = picture(number, 1 + number)
        perception.look(frame)
        assert perception.identical_frames == 1
        assert perception.frame is frame


def test_a_picture_that_repeats_is_counted_and_not_looked_at(perception: Perception) -> None:
    first = picture(0, 1)
    for number in range(FROZEN_FRAMES):
        perception.look(Frame(first.image.copy(), 1.0 + number / 60.0, number))
    assert perception.identical_frames == FROZEN_FRAMES
    assert perception.frame is not None
    assert perception.frame.index == 0
