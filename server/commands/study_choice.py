"""The study that a command is about: by its id, the beginning of one, or the last; and where studies are kept."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from server.commands.outcome import FAILED, REFUSED, USAGE, fail, warn
from server.data_folder import data_folder

if TYPE_CHECKING:
    from server.studies.store import StudyStore
    from server.studies.study import Study

LAST = "last"
NAMED = 5
"""Ids that are told where several begin alike."""

StudyArgument = Annotated[
    str, typer.Argument(metavar="ID", help='A study; a beginning of its id, or "last".')
]


@contextmanager
def opened_store(data: Path | None) -> Iterator[StudyStore]:
    """The studies of a data folder; what goes wrong with them meanwhile ends the command with its reason."""
    from control.studies.errors import StudyError
    from server.catalogue.catalogue import Catalogue
    from server.catalogue.errors import CatalogueError
    from server.studies.errors import NoSuchStudy, StudyBusy, StudyStoreError
    from server.studies.store import StudyStore

    folder = data_folder(data)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        catalogue = Catalogue.open(folder)
    except (OSError, CatalogueError) as error:
        raise fail(f"{error}; choose another folder with --data", FAILED) from error
    try:
        yield StudyStore(folder, catalogue)
    except (StudyError, NoSuchStudy) as error:
        raise fail(str(error), USAGE) from error
    except StudyBusy as error:
        raise fail(str(error), REFUSED) from error
    except (StudyStoreError, CatalogueError) as error:
        raise fail(str(error), FAILED) from error
    finally:
        catalogue.close()


def chosen(store: StudyStore, text: str) -> Study:
    """The one study that is meant; ends the command where there is none, or more than one."""
    return store.open(id_of(store, text))


def id_of(store: StudyStore, text: str) -> str:
    """Of a study that need not be readable; ends the command as `chosen`."""
    ids = store.ids()
    if text == LAST and ids:
        return ids[0]
    found = [id for id in ids if id == text] or [id for id in ids if id.startswith(text)]
    if len(found) == 1:
        return found[0]
    if not found:
        raise fail(f"there is no study {text!r}; `pivotrig studies list` shows those that there are", USAGE)
    named = ", ".join(found[:NAMED]) + (", ..." if len(found) > NAMED else "")
    raise fail(f"several studies begin with {text!r}: {named}; write more of the id", USAGE)


def tell_of_unreadable(store: StudyStore) -> None:
    for reason in store.unreadable().values():
        warn(reason)
