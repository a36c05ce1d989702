"""The camera's pictures as a film in real time, as they were or with what the rig knew drawn over them."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import BinaryIO

from server.exports.formats import ExportError, Job, Watch
from server.exports.overlay import Overlay
from server.recording.reading.recording import Picture, Recording
from vision.film import Film, FilmError, decode_jpeg, film_file, film_stream
from vision.tracking.colour import Image

OUT_OF_PLACE = 16
"""Places by which a picture may stand too far back: four wait for the encoder at most, and some more for the disk."""

Draw = Callable[[Image, float], Image]
"""The picture with something on it.  float: when it was taken, s since the run's start."""


def write(recording: Recording, sink: BinaryIO, job: Job, watch: Watch) -> None:
    """In fragments: a browser plays it while it is made."""
    with film_stream(sink) as film:
        _fill(film, recording, job, watch)


def write_file(recording: Recording, path: Path, job: Job, watch: Watch) -> None:
    """With its index in front, which older players need to jump."""
    with film_file(path) as film:
        _fill(film, recording, job, watch)


def _fill(film: Film, recording: Recording, job: Job, watch: Watch) -> None:
    if not job.overlay:
        _add_all(film, recording, lambda image, _time: image, watch)
    else:
        with Overlay.of(job.path) as overlay:
            _add_all(film, recording, overlay.drawn, watch)
    if not film.pictures:
        raise ExportError(
            "this run was recorded without pictures, so there is nothing to make a film of; "
            "set frames_Hz under [recording] in the rig file for the next run"
        )


def _add_all(film: Film, recording: Recording, draw: Draw, watch: Watch) -> None:
    """A picture that cannot be decoded is left out: the one before it is shown for longer."""
    duration = recording.duration
    for picture in in_order(recording.frames()):
        image = decode_jpeg(picture.jpeg)
        if image is not None:
            _add(film, draw(image, picture.captured_s), picture.captured_s)
            watch(min(max(picture.time_s / duration, 0.0), 1.0) if duration else 1.0)
    watch(1.0)


def in_order(pictures: Iterable[Picture]) -> Iterator[Picture]:
    """By capture time: a picture whose encoding took long stands behind later ones in the file."""
    waiting: list[tuple[float, int, Picture]] = []
    for number, picture in enumerate(pictures):
        heapq.heappush(waiting, (picture.captured_s, number, picture))
        if len(waiting) > OUT_OF_PLACE:
            yield heapq.heappop(waiting)[2]
    while waiting:
        yield heapq.heappop(waiting)[2]


def _add(film: Film, image: Image, time: float) -> None:
    try:
        film.add(image, time)
    except FilmError as error:
        raise ExportError(f"the film cannot be made: {error}") from error
