"""Folders of pictures, played as if they were a camera; damaged ones, too."""

from __future__ import annotations

import struct
import time
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.vision.films import PATIENCE, SIZE, STEP, greys, played_fast
from vision.sources.image_folder import natural_order
from vision.sources.opening import CameraError, open_camera


def shade(path: Path, grey: int, size: tuple[int, int] = SIZE) -> None:
    cv2.imwrite(str(path), np.full((size[1], size[0], 3), grey, np.uint8))


def chunk(kind: bytes, data: bytes) -> bytes:
    """Of a PNG file."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


GIGANTIC = (
    b"\x89PNG\r\n\x1a\n"
    + chunk(b"IHDR", struct.pack(">IIBBBBB", 60_000, 60_000, 8, 2, 0, 0, 0))
    + chunk(b"IDAT", zlib.compress(bytes(100)))
    + chunk(b"IEND", b"")
)


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
    """Text, half a picture, an empty file and one that says it has 3.6 gigapixels among good ones; a decoder would
    fill half a picture up with grey."""
    whole = cv2.imencode(suffix, np.random.default_rng(4).integers(0, 255, (48, 64, 3), np.uint8))[
        1
    ].tobytes()
    (folder / f"Picture 3.5{suffix}").write_bytes(whole[: len(whole) // 2])
    (folder / f"Picture 4.5{suffix}").write_text("no picture")
    (folder / f"Picture 5.5{suffix}").write_bytes(b"")
    (folder / "Picture 6.5.png").write_bytes(GIGANTIC)
    camera = open_camera(f"folder://{folder}?loop=0&pace=fast")
    frames = [camera.read(PATIENCE) for _ in range(16)]
    notes = [note.message for note in camera.take_notes()]
    camera.close()
    assert greys([frame for frame in frames if frame is not None]) == list(range(12))
    assert "4 of its pictures could not be used" in notes[-1]


def test_a_damaged_film_in_a_loop_does_not_fill_the_event_log(folder: Path) -> None:
    (folder / "Picture 3.png").write_text("no picture")
    camera = open_camera(f"folder://{folder}?loop=1&pace=fast")
    frames = [camera.read(PATIENCE) for _ in range(1200)]
    notes = camera.take_notes()
    camera.close()
    assert frames.count(None) == 100
    assert 1 <= len(notes) <= 8


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
