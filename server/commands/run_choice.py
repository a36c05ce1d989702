"""The runs that a command is about: by id, by the beginning of one, or the last; and where they are kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from server.commands.outcome import FAILED, USAGE, fail, warn
from server.data_folder import data_folder

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue
    from server.catalogue.records import RunRecord
    from server.catalogue.shelf import OpenShelf, Shelf

LAST = "last"
NAMED = 5
"""Ids that are told where several begin alike."""

RunArgument = Annotated[str, typer.Argument(metavar="ID", help='A run; a beginning of its id, or "last".')]
RunsArgument = Annotated[
    list[str], typer.Argument(metavar="ID...", help='Runs; beginnings of their ids, or "last".')
]


@contextmanager
def opened_shelf(data: Path | None) -> Iterator[OpenShelf]:
    """The runs of a data folder; what goes wrong with them meanwhile ends the command with its reason."""
    from server.catalogue.errors import CatalogueError, NoSuchRun
    from server.catalogue.shelf import OpenShelf

    try:
        shelf = OpenShelf.open(data_folder(data))
        try:
            tell_of_loss(shelf)
            yield shelf
        finally:
            shelf.close()
    except NoSuchRun as error:
        raise fail(str(error), USAGE) from error
    except CatalogueError as error:
        raise fail(str(error), FAILED) from error


def tell_of_loss(shelf: Shelf) -> None:
    """A catalogue that has just been made is empty; nobody should take that for there being no runs."""
    from server.catalogue.shelf import RECORDING

    if (aside := shelf.catalogue.put_aside) is not None:
        warn(f"the catalogue of runs was damaged; it is kept as {aside}, and there is a new, empty one")
    if shelf.catalogue.is_new and any(shelf.folder.glob(f"*{RECORDING}")):
        warn("the catalogue of runs is new, and there are recordings: `pivotrig runs rebuild` lists them")


def id_of(catalogue: Catalogue, text: str) -> str:
    """The id of the one run that is meant; ends the command where there is none, or more than one."""
    if catalogue.known([text]):
        return text
    found = catalogue.beginning_with("" if text == LAST else text, NAMED + 1)
    if (text == LAST and found) or len(found) == 1:
        return found[0]
    if not found:
        raise fail(_nothing_like(text), USAGE)
    named = ", ".join(found[:NAMED]) + (", ..." if len(found) > NAMED else "")
    raise fail(f"several runs begin with {text!r}: {named}; write more of the id", USAGE)


def _nothing_like(text: str) -> str:
    if text == LAST:
        return "there is no run yet; choose another folder with --data, or walk one with `pivotrig run`"
    return f"there is no run whose id begins with {text!r}; `pivotrig runs list` shows them"


def records_of(texts: Sequence[str], data: Path | None) -> list[RunRecord]:
    """The runs that are meant, with their settings."""
    with opened_shelf(data) as shelf:
        return [shelf.catalogue.get(id_of(shelf.catalogue, text)) for text in texts]


def recording_of(record: RunRecord, data: Path | None) -> Path:
    """The recording of a run; ends the command where there is none."""
    from server.catalogue.shelf import RECORDINGS, file_of

    path = file_of(data_folder(data) / RECORDINGS, record.id)
    if not path.exists():
        raise fail(f"of the run {record.id} there is no recording", FAILED)
    return path
