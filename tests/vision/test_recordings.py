"""Video files, played as if they were a camera; damaged ones, too."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from control.model import Frame
from tests.vision.films import PATIENCE, SIZE, STEP, greys, played_fast
from vision.sources.opening import CameraError, open_camera

RATE = 25.0


@pytest.fixture
def video(tmp_path: Path) -> Path:
    """Ten frames at 25 frames/s; frame k is of the grey level 20 k."""
    path = tmp_path / "ten frames #1 (50 %).avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), RATE, SIZE)
    for index in range(10):
        writer.write(np.full((SIZE[1], SIZE[0], 3), STEP * index, np.uint8))
    writer.release()
    return path


def test_a_file_plays_at_its_own_pace_then_gives_nothing(video: Path) -> None:
    camera = open_camera(video.as_uri())
    camera.require()
    assert (camera.size, camera.rate, camera.simulated) == (SIZE, RATE, False)
    assert camera.identity == f"file {video.name}"
    start = camera.now()
    frames = [frame for _ in range(10) if (frame := camera.read(0.5)) is not None]
    assert greys(frames) == [frame.index for frame in frames]
    assert frames[-1].index == 9
    assert frames[-1].captured_at - start == pytest.approx(9 / RATE, abs=0.01)
    assert camera.read(0.01) is None
    camera.close()


def test_a_file_leaves_out_the_frames_that_nobody_fetched_in_time(video: Path) -> None:
    camera = open_camera(video.as_uri())
    first = camera.read(0.5)
    time.sleep(0.2)
    second = camera.read(0.5)
    camera.close()
    assert first is not None
    assert second is not None
    assert first.index == 0
    assert second.index >= 4
    assert greys([second]) == [second.index]


def test_a_frame_further_off_than_the_timeout_is_waited_for_no_longer(video: Path) -> None:
    camera = open_camera(video.as_uri())
    camera.read(0.5)
    assert camera.read(0.001) is None
    later = camera.read(0.5)
    camera.close()
    assert later is not None
    assert later.index >= 1


def test_as_fast_as_it_goes_every_frame_comes_and_the_clock_goes_with_the_film(video: Path) -> None:
    camera = open_camera(f"{video.as_uri()}?pace=fast")
    begin, start = time.monotonic(), camera.now()
    frames = [camera.read(0.1) for _ in range(10)]
    assert time.monotonic() - begin < 0.3
    assert [frame.index for frame in frames if frame is not None] == list(range(10))
    assert camera.now() - start == pytest.approx(9 / RATE)
    assert camera.read(0.1) is None
    assert camera.now() - start == pytest.approx(9 / RATE + 0.1)
    camera.close()


def test_a_film_in_a_loop_begins_again_and_its_time_goes_on(video: Path) -> None:
    camera = open_camera(f"{video.as_uri()}?pace=fast&loop=1")
    frames = played_fast(camera, 25)
    assert greys(frames) == [*range(10), *range(10), *range(5)]
    assert [frame.index for frame in frames] == list(range(25))
    steps = [after.captured_at - before.captured_at for before, after in pairwise(frames)]
    assert steps == pytest.approx([1 / RATE] * 24)


def test_a_film_that_cannot_be_opened_again_ends_and_says_why(video: Path) -> None:
    camera = open_camera(f"{video.as_uri()}?pace=fast&loop=1")
    camera.read(PATIENCE)
    video.unlink()
    frames = played_fast(camera, 15)
    assert greys(frames) == list(range(1, 10))
    assert "is missing" in camera.trouble


def test_a_film_that_is_over_says_so(video: Path) -> None:
    camera = open_camera(f"{video.as_uri()}?pace=fast")
    assert camera.trouble == ""
    played_fast(camera, 12)
    assert camera.trouble == f"video file {video} has ended"


def test_a_film_that_is_decoded_slower_than_it_goes_keeps_nobody_waiting(tmp_path: Path) -> None:
    """It falls behind its own pace and goes on from there, instead of being sought for longer and longer."""
    path = tmp_path / "large.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 5000.0, (640, 480))
    noise = np.random.default_rng(5).integers(0, 255, (480, 640, 3)).astype(np.uint8)
    for _ in range(60):
        writer.write(noise)
    writer.release()
    camera = open_camera(f"{path.as_uri()}?loop=1")
    end = time.monotonic() + 1.5
    frames = []
    while time.monotonic() < end:
        begin = time.monotonic()
        frames.append(camera.read(0.1))
        assert time.monotonic() - begin < 0.5
    camera.close()
    times = [frame.captured_at for frame in frames if frame is not None]
    assert len(times) >= 5
    assert times == sorted(set(times))


def test_a_film_may_be_closed_while_somebody_waits_for_its_next_frame(video: Path) -> None:
    camera = open_camera(video.as_uri())
    camera.read(0.5)
    camera.close()
    assert camera.read(0.5) is None


# Damaged films ----------------------------------------------------------------------------------


def walk(path: Path, codec: str, frames: int = 60) -> bytes:
    """A spot that goes to the right by 4 px a frame, on a noisy plate; the file's bytes."""
    noise = np.random.default_rng(1).normal(40.0, 4.0, (4, 240, 320, 3)).astype(np.uint8)
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*codec), RATE, (320, 240))
    for index in range(frames):
        plate = noise[index % 4].copy()
        cv2.circle(plate, (20 + 4 * index, 120), 15, (30, 30, 200), -1)
        writer.write(plate)
    writer.release()
    return path.read_bytes()


def spot(frame: Frame) -> float:
    """Which frame of the walk it is, by where the spot stands; NaN where the picture is broken."""
    row = frame.image[120].astype(int)
    red = np.flatnonzero(row[:, 2] - row[:, 1] > 90)
    return float((red.mean() - 20.0) / 4.0) if red.size else float("nan")


@pytest.mark.parametrize(("suffix", "codec"), [(".avi", "MJPG"), (".mp4", "mp4v")])
@pytest.mark.parametrize("damage", [bytes, lambda count: np.random.default_rng(2).bytes(count)])
def test_a_film_with_a_corrupt_middle_plays_on(
    tmp_path: Path, suffix: str, codec: str, damage: Callable[[int], bytes]
) -> None:
    """A tenth of the file is overwritten: what comes before and after is seen, and the end is reached."""
    path = tmp_path / f"walk{suffix}"
    whole = walk(path, codec)
    begin, end = int(0.4 * len(whole)), int(0.5 * len(whole))
    path.write_bytes(whole[:begin] + damage(end - begin) + whole[end:])
    frames = played_fast(open_camera(f"{path.as_uri()}?pace=fast"), 75)
    seen = [spot(frame) for frame in frames]
    assert seen[:20] == pytest.approx(range(20), abs=0.5)
    assert sum(position > 30.0 for position in seen) >= 20
    assert max(position for position in seen if not np.isnan(position)) == pytest.approx(59.0, abs=0.5)
    times = [frame.captured_at for frame in frames]
    assert times == sorted(set(times))


def test_pictures_that_could_not_be_decoded_are_counted_and_told(tmp_path: Path) -> None:
    path = tmp_path / "walk.mp4"
    whole = walk(path, "mp4v")
    begin, end = int(0.4 * len(whole)), int(0.5 * len(whole))
    path.write_bytes(whole[:begin] + bytes(end - begin) + whole[end:])
    camera = open_camera(f"{path.as_uri()}?pace=fast")
    notes = [note.message for _ in range(70) if camera.read(PATIENCE) or True for note in camera.take_notes()]
    camera.close()
    assert any(f"{path} is damaged: " in note for note in notes)


def test_a_film_that_was_cut_off_plays_as_far_as_it_goes(tmp_path: Path) -> None:
    path = tmp_path / "walk.avi"
    whole = walk(path, "MJPG")
    path.write_bytes(whole[: len(whole) // 2])
    frames = played_fast(open_camera(f"{path.as_uri()}?pace=fast"), 70)
    assert 25 <= len(frames) <= 35


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("text.mp4", b"This is no film.\n" * 50, "cannot be read"),
        ("empty.mp4", b"", "is empty"),
        ("noise.avi", np.random.default_rng(3).bytes(5000), "cannot be read"),
    ],
)
def test_what_is_no_film_is_named_with_what_is_wrong(
    tmp_path: Path, name: str, content: bytes, says: str
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(CameraError, match=says) as refusal:
        open_camera(path.as_uri())
    assert name in str(refusal.value)


def test_a_film_without_its_index_is_refused(tmp_path: Path) -> None:
    """An MP4 has its index at the end: cut off, nothing of it can be found."""
    path = tmp_path / "walk.mp4"
    whole = walk(path, "mp4v", 20)
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(CameraError, match="cut off before its index"):
        open_camera(path.as_uri())


def test_decoders_say_nothing_to_the_terminal(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "walk.mp4"
    whole = walk(path, "mp4v")
    path.write_bytes(whole[:2000] + bytes(3000) + whole[5000:])
    capfd.readouterr()
    played_fast(open_camera(f"{path.as_uri()}?pace=fast"), 80)
    with pytest.raises(CameraError):
        open_camera((tmp_path / "nothing.mp4").as_uri())
    (tmp_path / "text.mp4").write_text("no film")
    with pytest.raises(CameraError):
        open_camera((tmp_path / "text.mp4").as_uri())
    assert capfd.readouterr() == ("", "")
