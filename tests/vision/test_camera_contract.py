"""What the loop relies on, of every kind of camera."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from control.model import Frame
from control.parts import Camera
from server.assembly import build_machine
from server.settings import RigFile
from tests.processes import started
from vision.sources.opening import CameraRequest, open_camera

SIZE = (80, 64)


def simulated(_: Path) -> Iterator[Camera]:
    machine = build_machine(RigFile(), realtime=True)
    yield machine.camera
    machine.close()


def video(folder: Path) -> Iterator[Camera]:
    path = folder / "film.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, SIZE)
    for grey in range(60):
        writer.write(np.full((SIZE[1], SIZE[0], 3), 4 * grey, np.uint8))
    writer.release()
    yield open_camera(path.as_uri())


def pictures(folder: Path) -> Iterator[Camera]:
    for grey in range(60):
        cv2.imwrite(str(folder / f"{grey}.png"), np.full((SIZE[1], SIZE[0], 3), 4 * grey, np.uint8))
    yield open_camera(f"folder://{folder}?rate=30&loop=1")


def network(_: Path) -> Iterator[Camera]:
    with started("tests.vision.mjpeg_server", "0", "30") as (_process, address):
        yield open_camera(address, CameraRequest(SIZE, 30.0))


@pytest.fixture(params=[simulated, video, pictures, network], ids=lambda kind: kind.__name__)
def camera(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Camera]:
    make: Callable[[Path], Iterator[Camera]] = request.param
    for made in make(tmp_path):
        yield made
        made.close()


def frames_of(camera: Camera, count: int) -> list[Frame]:
    give_up = time.monotonic() + 20.0
    frames: list[Frame] = []
    while len(frames) < count and time.monotonic() < give_up:
        frame = camera.read(0.1)
        if frame is not None:
            frames.append(frame)
    return frames


def test_a_camera_that_is_there_has_an_identity_and_no_trouble(camera: Camera) -> None:
    camera.require()
    assert camera.identity
    assert camera.trouble == ""
    assert camera.rate > 0.0


def test_frames_have_the_camera_s_size_and_times_of_its_clock_that_go_up(camera: Camera) -> None:
    frames = frames_of(camera, 5)
    width, height = camera.size
    assert len(frames) == 5
    assert all(frame.image.shape == (height, width, 3) and frame.image.dtype == np.uint8 for frame in frames)
    assert all(after.captured_at > before.captured_at for before, after in pairwise(frames))
    assert all(after.index > before.index for before, after in pairwise(frames))
    assert all(math.isfinite(frame.captured_at) for frame in frames)
    assert 0.0 <= camera.now() - frames[-1].captured_at < 2.0


def test_nothing_comes_from_a_closed_camera_and_closing_twice_is_allowed(camera: Camera) -> None:
    frames_of(camera, 1)
    camera.close()
    camera.close()
    begin = time.monotonic()
    assert camera.read(0.2) is None
    assert time.monotonic() - begin < 1.0


def test_notes_are_told_once(camera: Camera) -> None:
    camera.require()
    frames_of(camera, 1)
    camera.take_notes()
    assert camera.take_notes() == []
