"""Films: what a player sees of them, and when."""

import io
import itertools
from pathlib import Path

import av
import numpy as np
import pytest

from vision.encoding import encode_jpeg
from vision.film import FilmError, decode_jpeg, film_file, film_stream

UNEVEN = [0.0, 0.1, 0.233, 0.3, 0.7, 0.7333, 2.5, 2.6]
"""When pictures were taken, s: a camera that jitters, and one long gap."""


class Line:
    """Takes bytes one after the other, as a connection does: nobody can go back in it."""

    def __init__(self):
        self.taken = bytearray()

    def write(self, data: bytes) -> int:
        self.taken += data
        return len(data)


def grey(level, size=(64, 48)):
    width, height = size
    return np.full((height, width, 3), level, np.uint8)


def played(film: str | Path | io.BytesIO):
    """Time (s) and mean grey of each picture of a film."""
    with av.open(film, "r") as container:
        return [
            (picture.time, float(picture.to_ndarray(format="gray").mean()))
            for picture in container.decode(video=0)
        ]


def shot(film, times, size=(64, 48)):
    for level, time in zip(itertools.count(20, 20), times, strict=False):
        film.add(grey(level, size), time)


@pytest.fixture(params=["file", "stream"])
def made(request, tmp_path):
    """Makes a film of either kind, and gives it as something that can be played."""

    def make(times, size=(64, 48)):
        if request.param == "file":
            with film_file(tmp_path / "film.mp4") as film:
                shot(film, times, size)
            return str(tmp_path / "film.mp4")
        line = Line()
        with film_stream(line) as film:
            shot(film, times, size)
        return io.BytesIO(bytes(line.taken))

    return make


def test_a_film_shows_each_picture_when_it_was_taken(made):
    shown = [time for time, _ in played(made([1000.0 + time for time in UNEVEN]))]
    assert shown == pytest.approx(UNEVEN, abs=1e-4)


def test_a_camera_may_be_away_for_a_day(made):
    times = [0.0, 0.1, 86_400.0, 86_400.1]
    assert [time for time, _ in played(made(times))] == pytest.approx(times, abs=1e-4)


def test_a_film_shows_all_pictures_in_their_order(made):
    greys = [grey for _, grey in played(made(UNEVEN))]
    assert len(greys) == len(UNEVEN)
    assert greys == pytest.approx([20 * n for n in range(1, len(UNEVEN) + 1)], abs=20)
    assert greys == sorted(greys)


@pytest.mark.parametrize("size", [(63, 48), (64, 47), (63, 47)])
def test_odd_sizes_are_padded_by_one(made, size):
    with av.open(made(UNEVEN, size), "r") as container:
        stream = container.streams.video[0]
        assert (stream.width, stream.height) == (64, 48)
        assert stream.codec_context.pix_fmt == "yuv420p"


def test_two_pictures_of_the_same_time_follow_each_other(made):
    shown = [time for time, _ in played(made([0.0, 0.5, 0.5, 0.4, 1.0]))]
    assert len(shown) == 5
    assert all(earlier < later for earlier, later in itertools.pairwise(shown))
    assert shown[-1] == pytest.approx(1.0, abs=1e-4)


def test_a_film_in_a_file_has_its_index_in_front(tmp_path):
    with film_file(tmp_path / "film.mp4") as film:
        shot(film, UNEVEN)
    written = (tmp_path / "film.mp4").read_bytes()
    assert 0 < written.index(b"moov") < written.index(b"mdat")


def test_a_film_may_have_any_name_that_a_file_may_have(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with film_file(Path("at 12:30 100%d.mp4")) as film:
        shot(film, UNEVEN)
    assert len(played(tmp_path / "at 12:30 100%d.mp4")) == len(UNEVEN)


def test_a_film_that_is_sent_can_be_played_as_far_as_it_came():
    line = Line()
    with film_stream(line) as film:
        for frame in range(400):
            film.add(grey(frame % 256), frame / 30.0)
    half = bytes(line.taken[: len(line.taken) // 2])
    with av.open(io.BytesIO(half), "r") as container:
        assert sum(1 for _ in container.demux(video=0)) > 50


def test_a_film_without_pictures_is_empty():
    line = Line()
    with film_stream(line) as film:
        pass
    assert film.pictures == 0
    assert line.taken == b""


def test_pictures_of_another_size_are_refused_in_words():
    with film_stream(Line()) as film:
        film.add(grey(10), 0.0)
        with pytest.raises(FilmError, match="32 x 48 px cannot follow one of 64 x 48 px"):
            film.add(grey(10, (32, 48)), 0.1)


@pytest.mark.parametrize("image", [np.zeros((48, 64), np.uint8), np.zeros((48, 64, 3), np.float32)])
def test_a_film_takes_colour_pictures_of_bytes_only(image):
    with film_stream(Line()) as film, pytest.raises(FilmError, match="colour pictures of bytes"):
        film.add(image, 0.0)


def test_a_jpeg_comes_back_as_the_picture_it_was():
    image = grey(90)
    again = decode_jpeg(encode_jpeg(image))
    assert again is not None
    assert np.abs(again.astype(int) - image).max() <= 2


@pytest.mark.parametrize("data", [b"", b"no picture", encode_jpeg(grey(90))[:40]])
def test_what_is_no_jpeg_is_no_picture(data):
    assert decode_jpeg(data) is None
