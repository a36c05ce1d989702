"""What all commands share: the rig file that is asked for, and how they end.

Exit status: 0 done, 1 failed, 2 wrong usage, 3 the rig refused or faulted.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic import ValidationError
from rich.console import Console

from server.data_folder import rig_path
from server.rig_file import RigFileError, RigStore
from server.section import in_words
from server.settings import RigFile

FAILED, USAGE, REFUSED = 1, 2, 3

console = Console(stderr=True)

RigOption = Annotated[
    Path | None,
    typer.Option(
        "--rig",
        help="Rig file (TOML); default: the one saved in the data folder, else the paper's rig, simulated.",
    ),
]

DataOption = Annotated[
    Path | None, typer.Option("--data", help="Folder for data; default: your user data folder.")
]


def fail(message: str, status: int) -> typer.Exit:
    console.print(f"pivotrig: {message}", style="red", markup=False, highlight=False, soft_wrap=True)
    return typer.Exit(status)


def warn(message: str) -> None:
    console.print(f"pivotrig: {message}", style="yellow", markup=False, highlight=False, soft_wrap=True)


def read_rig_file(path: Path | None) -> RigFile:
    """The rig file, else the saved one, else the paper's rig; ends the command when it cannot be used."""
    return open_rig_store(path).settings


def open_rig_store(path: Path | None, data: Path | None = None) -> RigStore:
    """The rig file that was named, or the saved one of the data folder, which need not be there."""
    try:
        store = RigStore(rig_path(path, data))
    except RigFileError as error:
        raise fail(str(error), USAGE) from error
    if path is not None and not store.is_saved:
        raise fail(f"cannot read the rig file {path}: No such file or directory", USAGE)
    if path is None and store.is_saved:
        console.print(f"rig file: {store.path}", markup=False, highlight=False, soft_wrap=True)
    return store


def with_simulation(rig_file: RigFile, options: Mapping[str, Any]) -> RigFile:
    """The rig with the options that were given (not None); ends the command when there is nothing to simulate."""
    changes = {name: value for name, value in options.items() if value is not None}
    if changes and not rig_file.is_simulated:
        given = " and ".join(f"--{name}" for name in changes)
        raise fail(f"{given} belong to the simulated rig, but this rig file has a real camera", USAGE)
    try:
        return rig_file.with_simulation(**changes)
    except ValidationError as error:
        raise fail(f"the simulation cannot be set up:\n{in_words(error)}", USAGE) from error
