"""`pivotrig doctor`: what is connected, what is wrong with it, and what to do."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic import ValidationError
from rich.console import Console
from rich.table import Table
from rich.text import Text

from server.commands.outcome import FAILED, USAGE, RigOption, console, fail
from server.data_folder import data_folder, rig_path
from server.diagnosis.check import Check, Level
from server.section import in_words
from server.settings import RigFile

COLOURS = {Level.OK: "green", Level.INFO: "cyan", Level.WARNING: "yellow", Level.PROBLEM: "bold red"}


def doctor(
    rig: RigOption = None,
    port: Annotated[str | None, typer.Option(help="Look for the board here instead of at link.port.")] = None,
    data: Annotated[
        Path | None, typer.Option(help="Folder for data; default: your user data folder.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Check computer, rig file, board and camera, and say what to do. Never puts current into a coil.

    Opening an UNO's port resets it: do not run this beside a rig that walks. Exit status 1 when there is a problem.
    """
    with console.status("looking"):
        checks = list(examine(rig, port, data))
    if as_json:
        print(json.dumps(_json(checks), allow_nan=False))
    elif Console().is_terminal:
        Console().print(_table(checks))
    else:
        print(_lines(checks))
    if any(check.level is Level.PROBLEM for check in checks):
        raise typer.Exit(FAILED)


def examine(rig: Path | None, port: str | None, data: Path | None) -> Iterator[Check]:
    """Every check, as it is done; those that need a rig only where the rig file gives one."""
    from server.diagnosis import coils, computer, files, ports
    from server.diagnosis import rig as devices

    yield from computer.examine()
    yield files.data_folder(data_folder(data))
    settings, check = files.rig_file(rig_path(rig, data), is_named=rig is not None)
    yield check
    if settings is None:
        return
    settings = settings if port is None else _at_port(settings, port)
    yield from coils.examine(settings)
    together = files.goes_together(settings)
    yield together
    if together.level is Level.PROBLEM:
        return
    yield computer.headroom(settings)
    yield from ports.examine(settings)
    yield from devices.examine(settings)


def _at_port(settings: RigFile, port: str) -> RigFile:
    whole = settings.model_dump(mode="json")
    whole["link"]["port"] = port
    try:
        return RigFile.model_validate(whole)
    except ValidationError as error:
        raise fail(f"--port {port} cannot be used:\n{in_words(error)}", USAGE) from error


def _json(checks: Sequence[Check]) -> dict[str, Any]:
    levels = [check.level for check in checks]
    return {
        "checks": [asdict(check) for check in checks],
        "problems": levels.count(Level.PROBLEM),
        "warnings": levels.count(Level.WARNING),
    }


def _table(checks: Sequence[Check]) -> Table:
    table = Table("", "looked at", "found", "what to do", box=None, padding=(0, 2, 0, 0))
    for check in checks:
        colour = COLOURS[check.level]
        table.add_row(Text(check.level, colour), check.name, Text(check.finding), Text(check.advice, colour))
    return table


def _lines(checks: Sequence[Check]) -> str:
    width = max(len(check.name) for check in checks)
    lines = []
    for check in checks:
        what = f"{check.finding}. To do: {check.advice}" if check.advice else check.finding
        lines.append(f"{check.level:<8} {check.name:<{width}}  {' '.join(what.split())}")
    return "\n".join(lines)
