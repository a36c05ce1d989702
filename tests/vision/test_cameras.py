from __future__ import annotations

import time
from pathlib import Path

import cv2
import numpy as np
import pytest

from vision.sources.opening import CameraError, DeviceCamera, open_camera

SIZE = (64, 48)
RATE = 25.0


@pytest.fixture
def video(tmp_path: Path) -> Path:
    """Ten frames at 25 frames/s; frame k is of the grey level 20 k."""
    path = tmp_path / "ten frames.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), RATE, SIZE)
    for index in range(10):
        writer.write(np.full((SIZE[1], SIZE[0], 3), 20 * index, np.uint8))
    writer.release()
    return path


def test_a_file_plays_at_its_own_pace_then_gives_nothing(video: Path):
    camera = open_camera(video.as_uri())
    assert (camera.size, camera.rate, camera.simulated) == (SIZE, RATE, False)
    start = camera.now()
    frames = [frame for _ in range(10) if (frame := camera.read(0.5)) is not None]
    assert [round(float(frame.image.mean()) / 20) for frame in frames] == [frame.index for frame in frames]
    assert frames[-1].index == 9
    assert frames[-1].captured_at - start == pytest.approx(9 / RATE, abs=0.01)
    assert camera.read(0.01) is None
    camera.close()


def test_a_file_leaves_out_the_frames_that_nobody_fetched_in_time(video: Path):
    camera = open_camera(video.as_uri())
    first = camera.read(0.5)
    time.sleep(0.2)
    second = camera.read(0.5)
    assert first is not None
    assert second is not None
    assert first.index == 0
    assert second.index >= 4
    assert round(float(second.image.mean()) / 20) == second.index
    camera.close()


def test_a_frame_further_off_than_the_timeout_is_waited_for_no_longer(video: Path):
    camera = open_camera(video.as_uri())
    camera.read(0.5)
    assert camera.read(0.001) is None
    later = camera.read(0.5)
    assert later is not None
    assert later.index >= 1
    camera.close()


def slow_playback(path: Path, opened: list[float]):
    """Opens the file as if it were a camera; counts how often."""

    def opener() -> cv2.VideoCapture:
        opened.append(time.monotonic())
        return cv2.VideoCapture(str(path))

    return opener


def test_a_device_gives_the_newest_frame_once_and_is_opened_again_when_it_goes_away(video: Path):
    opened: list[float] = []
    camera = DeviceCamera(slow_playback(video, opened), "test", SIZE, RATE)
    deadline = time.monotonic() + 5.0
    indices = []
    while len(opened) < 3 and time.monotonic() < deadline:
        frame = camera.read(0.05)
        if frame is not None:
            assert 0.0 <= camera.now() - frame.captured_at < 0.5
            indices.append(frame.index)
    camera.close()
    assert len(opened) >= 3
    assert indices == sorted(set(indices))
    assert max(indices) >= 9
    assert camera.read(0.01) is None


def test_a_device_of_another_size_than_asked_is_refused(video: Path):
    with pytest.raises(CameraError, match="64x48 px where 640x480 px"):
        DeviceCamera(slow_playback(video, []), "test", (640, 480), RATE)


@pytest.mark.parametrize(
    ("uri", "says"),
    [
        ("v4l://97", "cannot be opened"),
        ("v4l://front", "allowed are"),
        ("v4l:///etc/passwd", "allowed are"),
        ("file:///nowhere/at/all.mp4", "missing"),
        ("sim://", "simulated"),
        ("http://10.0.0.1/", "allowed are"),
        ("0", "allowed are"),
        ("", "allowed are"),
    ],
)
def test_a_camera_that_is_not_there_or_not_understood_is_refused_with_what_is_allowed(uri: str, says: str):
    with pytest.raises(CameraError, match=says):
        open_camera(uri)
