"""`pivotrig runs rebuild` and `recover`: the catalogue from the recordings, and recordings after a crash."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from server.commands.outcome import DataOption, console
from server.commands.run_choice import opened_shelf

JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")]


def rebuild(data: DataOption = None, as_json: JsonOption = False) -> None:
    """Make the catalogue anew from the recordings; labels, notes, tags and pins stay."""
    from server.catalogue.rebuilding import rebuild as rebuild_catalogue

    columns = TextColumn("reading recordings"), BarColumn(), MofNCompleteColumn()
    with (
        opened_shelf(data) as shelf,
        Progress(*columns, console=console, disable=not console.is_terminal) as bar,
    ):
        task = bar.add_task("rebuild", total=None)
        done = rebuild_catalogue(shelf, lambda read, all_: bar.update(task, completed=read, total=all_))
    if as_json:
        print(json.dumps(asdict(done)))
        return
    print(f"{done.added} runs added, {done.renewed} renewed, {done.lost} without their recording")
    if done.studies:
        print(f"{done.studies} studies listed")
    for line in done.told:
        typer.echo(line, err=True)


def recover(data: DataOption = None, as_json: JsonOption = False) -> None:
    """Mend recordings whose program ended before they did: everything that can be read is kept."""
    from server.recording.recovery.recover import recover as recover_recordings

    with opened_shelf(data) as shelf:
        mended = recover_recordings(shelf.folder, shelf.catalogue)
    if as_json:
        print(json.dumps({"recovered": [str(each) for each in mended]}))
        return
    for each in mended:
        print(each)
    if not mended:
        print("every recording is whole")
