"""What a recording can be turned into, and the one function that does it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import StrEnum
from importlib import import_module
from pathlib import Path
from typing import BinaryIO

from server.recording.reading.recording import Recording, Unreadable

Watch = Callable[[float], None]
"""Told how far an export has come, 0 to 1."""


IMPOSSIBLE = 3
"""Exit status of an export that has said in words why it cannot be made."""


class ExportError(Exception):
    """The recording cannot be turned into this; the text says why and what to do."""


@dataclass(frozen=True, slots=True)
class Job:
    """One export. overlay: whether what the rig knew is drawn into the film."""

    path: Path
    format: str
    overlay: bool = False


@dataclass(frozen=True, slots=True)
class Format:
    """suffix: of the file's name.  module: where its `write(recording, sink, job, watch)` is.

    The modules are loaded when they are needed: some bring a large library along.
    """

    suffix: str
    media_type: str
    module: str


class FormatName(StrEnum):
    """As the command line has them."""

    CSV = "csv"
    PARQUET = "parquet"
    MAT = "mat"
    MCAP = "mcap"
    PNG = "png"
    SVG = "svg"
    MP4 = "mp4"


FORMATS: dict[str, Format] = {
    FormatName.CSV: Format(".csv", "text/csv; charset=utf-8", "server.exports.csv_table"),
    FormatName.PARQUET: Format(".parquet", "application/vnd.apache.parquet", "server.exports.parquet_table"),
    FormatName.MAT: Format(".mat", "application/x-matlab-data", "server.exports.mat_table"),
    FormatName.MCAP: Format(".mcap", "application/octet-stream", "server.exports.whole_file"),
    FormatName.PNG: Format(".png", "image/png", "server.exports.run_figure"),
    FormatName.SVG: Format(".svg", "image/svg+xml", "server.exports.run_figure"),
    FormatName.MP4: Format(".mp4", "video/mp4", "server.exports.run_film"),
}


def unwatched(share: float) -> None:
    """Nobody wants to know how far it is."""


def export(job: Job, sink: BinaryIO, watch: Watch = unwatched) -> None:
    """Write the recording in that format into anything that takes bytes one after the other.

    Raises `ExportError` in words, or OSError when the sink does not take it.
    """
    write = import_module(FORMATS[job.format].module).write
    with _opened(job) as recording:
        write(recording, sink, job, watch)


@contextmanager
def _opened(job: Job) -> Iterator[Recording]:
    try:
        with Recording.open(job.path) as recording:
            yield recording
    except Unreadable as error:
        raise ExportError(str(error)) from error


def export_file(job: Job, place: Path, watch: Watch = unwatched) -> None:
    """Write the recording in that format into a new file; a film gets its index in front, as it may go back.

    Raises like `export`.
    """
    if job.format == FormatName.MP4:
        _film_file(job, place, watch)
        return
    with open(place, "xb") as sink:
        export(job, sink, watch)


def _film_file(job: Job, place: Path, watch: Watch) -> None:
    from server.exports import run_film

    with _opened(job) as recording:
        run_film.write_file(recording, place, job, watch)
