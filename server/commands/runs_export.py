"""`pivotrig runs export`: a run in the forms that other programs read."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from server.commands.outcome import FAILED, USAGE, DataOption, console, fail
from server.commands.run_choice import RunArgument, recording_of, records_of
from server.exports.formats import FORMATS, ExportError, FormatName, Job, Watch, export_file
from server.exports.naming import file_name


@contextlib.contextmanager
def _bar(name: str) -> Iterator[Watch]:
    """A progress bar on stderr that stays away when nobody looks at a terminal."""
    columns = TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task(name, total=1.0)
        yield lambda share: progress.update(task, completed=share)


def _place(out: Path | None, name: str, several: bool) -> Path:
    """The file to write: `out`, or the file's own name in that folder."""
    if out is None:
        return Path(name)
    return out / name if several or out.is_dir() else out


def _written(job: Job, place: Path, force: bool) -> int:
    """Make the file beside its place, so that only a whole one ever has its name; its size, bytes."""
    _check_free(place, force)
    place.parent.mkdir(parents=True, exist_ok=True)
    part = place.with_name(f".{place.name}.{os.getpid()}.part")
    try:
        with _bar(place.name) as watch:
            export_file(job, part, watch)
        _check_free(place, force)
        os.replace(part, place)
    finally:
        part.unlink(missing_ok=True)
    return place.stat().st_size


def _check_free(place: Path, force: bool) -> None:
    if place.exists() and not force:
        raise fail(f"{place} is there already; choose another name with --out, or say --force", USAGE)


def export(
    id: RunArgument,
    formats: Annotated[
        list[FormatName] | None, typer.Option("--format", help="May be given again, for several files.")
    ] = None,
    overlay: Annotated[
        bool, typer.Option("--overlay", help="Draw into the film (mp4) what the rig knew.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="File or folder; default: named after the run, in this folder."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite files that are there.")] = False,
    data: DataOption = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Take a run away as table (csv, parquet, mat), recording (mcap), figure (png, svg) or film (mp4)."""
    [record] = records_of([id], data)
    if record.recording_state == "writing":
        raise fail(
            f"the run {record.id} is being recorded; stop it first. If its program has died, "
            "`pivotrig runs recover` keeps what there is",
            FAILED,
        )
    path = recording_of(record, data)
    wanted = dict.fromkeys(formats or [FormatName.CSV])
    files: list[dict[str, object]] = []
    for format in wanted:
        name = file_name(record.id, record.label, FORMATS[format].suffix)
        place = _place(out, name, several=len(wanted) > 1)
        size = _made(Job(path, format, overlay), place, force)
        files.append({"format": str(format), "file": str(place), "size_bytes": size})
        if not as_json:
            print(place, flush=True)
    if as_json:
        print(json.dumps({"run_id": record.id, "files": files}))


def _made(job: Job, place: Path, force: bool) -> int:
    try:
        return _written(job, place, force)
    except ExportError as error:
        raise fail(str(error), FAILED) from error
    except OSError as error:
        raise fail(f"{place} cannot be written: {error.strerror or error}", FAILED) from error
