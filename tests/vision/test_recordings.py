"""Video files and folders of pictures, played as if they were a camera; damaged ones, too."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from control.model import Frame
from vision.sources.image_folder import natural_order
from vision.sources.opening import Camera, CameraError, open_camera

SIZE = (64, 48)
RATE = 25.0
STEP = 20
"""Of grey between two frames of the short film."""
PATIENCE = 0.05
"""Longer than from frame to frame, s; at its end a film that is played fast lets this time pass, too."""


@pytest.fixture
def video(tmp_path: Path) -> Path:
    """Ten frames at 25 frames/s; frame k is of the grey level 20 k."""
    path = tmp_path / "ten frames #1 (50 %).avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), RATE, SIZE)
    for index in range(10):
        writer.write(np.full((SIZE[1], SIZE[0], 3), STEP * index, np.uint8))
    writer.release()
    return path


def greys(frames: list[Frame]) -> list[int]:
    return [round(float(frame.image.mean()) / STEP) for frame in frames]


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


def played_fast(camera: Camera, attempts: int) -> list[Frame]:
    frames = [frame for _ in range(attempts) if (frame := camera.read(PATIENCE)) is not None]
    camera.close()
    return frames


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


# Folders ----------------------------------------------------------------------------------------


def shade(path: Path, grey: int, size: tuple[int, int] = SIZE) -> None:
    cv2.imwrite(str(path), np.full((size[1], size[0], 3), grey, np.uint8))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Twelve pictures whose numbers have no leading zeros."""
    for index in range(12):
        shade(tmp_path / f"Picture {index}.png", STEP * index)
    (tmp_path / "notes.txt").write_text("not a picture")
    return tmp_path


def test_the_pictures_of_a_folder_come_in_the_order_of_their_numbers(folder: Path) -> None:
    camera = open_camera(f"folder://{folder}?rate=50&pace=fast")
    assert (camera.size, camera.rate, camera.identity) == (SIZE, 50.0, f"folder {folder.name}")
    frames = played_fast(camera, 20)
    assert greys(frames) == list(range(12))
    assert frames[-1].captured_at - frames[0].captured_at == pytest.approx(11 / 50)


def test_a_folder_plays_at_the_rate_that_was_asked(folder: Path) -> None:
    camera = open_camera(f"folder://{folder}?rate=100")
    begin = time.monotonic()
    frames = [camera.read(0.5) for _ in range(8)]
    camera.close()
    assert 0.05 <= time.monotonic() - begin < 0.4
    assert all(frame is not None for frame in frames)


@pytest.mark.parametrize("suffix", [".jpg", ".png"])
def test_one_broken_picture_is_left_out_and_told(folder: Path, suffix: str) -> None:
    """Text, half a picture and an empty file among good ones; a decoder would fill half a picture up with grey."""
    whole = cv2.imencode(suffix, np.random.default_rng(4).integers(0, 255, (48, 64, 3), np.uint8))[
        1
    ].tobytes()
    (folder / f"Picture 3.5{suffix}").write_bytes(whole[: len(whole) // 2])
    (folder / f"Picture 4.5{suffix}").write_text("no picture")
    (folder / f"Picture 5.5{suffix}").write_bytes(b"")
    camera = open_camera(f"folder://{folder}?loop=0&pace=fast")
    frames = [camera.read(PATIENCE) for _ in range(15)]
    notes = [note.message for note in camera.take_notes()]
    camera.close()
    assert greys([frame for frame in frames if frame is not None]) == list(range(12))
    assert "3 of its pictures could not be used" in notes[-1]


def test_a_picture_of_another_size_is_left_out(folder: Path) -> None:
    shade(folder / "Picture 2.5.png", 255, (32, 32))
    assert greys(played_fast(open_camera(f"folder://{folder}?pace=fast"), 20)) == list(range(12))


def test_a_folder_without_pictures_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CameraError, match="holds no pictures; understood are"):
        open_camera(f"folder://{tmp_path}")
    (tmp_path / "a.png").write_text("no picture")
    with pytest.raises(CameraError, match="none of them can be read"):
        open_camera(f"folder://{tmp_path}")
    with pytest.raises(CameraError, match="cannot be read"):
        open_camera(f"folder://{tmp_path}/nowhere")


def test_numbers_in_names_count_as_numbers() -> None:
    names = ["b1", "a10", "a9", "a", "a9b", "10", "9", ""]
    assert sorted(names, key=natural_order) == ["", "9", "10", "a", "a9", "a9b", "a10", "b1"]
