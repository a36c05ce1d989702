"""Sessions on the catalogue's file, also after another file has taken its place."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy.exc import IntegrityError, SQLAlchemyError
from sqlalchemy.orm import Session

from server.catalogue.database import FOR_WRITING, Access
from server.catalogue.errors import CatalogueError
from server.catalogue.opening import Opened, opened
from server.catalogue.words import in_words

Identity = tuple[int, int] | None
"""Device and inode of a file; None where there is none."""


class Sessions:
    """For all threads. A file that was deleted or replaced is noticed at the next use, and what is there is opened.

    SQLite itself would go on with the old file, which nobody else sees any more.
    """

    def __init__(self, path: Path, opened: Opened) -> None:
        self.path = path
        self.opened = opened
        self.exchanges = 0
        """How often another file has taken the place of the one before."""
        self._identity = identity_of(path)
        self._one_at_a_time = threading.Lock()

    def close(self) -> None:
        self.opened.engine.dispose()

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """Raises `CatalogueError`."""
        present = self._present()
        with self._in_words(), Session(present.engine) as session:
            yield session

    @contextmanager
    def changing(self) -> Iterator[Session]:
        """All of it counts, or nothing. Raises `CatalogueError`, and IntegrityError for a run that is there twice."""
        present = self._present()
        if present.access is not Access.WRITE:
            raise CatalogueError(
                f"the catalogue {self.path} cannot be written to; "
                "give yourself the right to write to its folder, or choose another with --data"
            )
        writing = present.engine.execution_options(**FOR_WRITING)
        with self._in_words(), Session(writing) as session, session.begin():
            yield session

    @contextmanager
    def _in_words(self) -> Iterator[None]:
        try:
            yield
        except IntegrityError:
            raise
        except SQLAlchemyError as error:
            raise CatalogueError(in_words(error, self.path)) from error
        except UnicodeEncodeError as error:
            raise CatalogueError(f"{error.object[:80]!a} is no text; write it anew, in letters") from error

    def _present(self) -> Opened:
        """What is open, of the file that is there now."""
        if identity_of(self.path) != self._identity:
            with self._one_at_a_time:
                if identity_of(self.path) != self._identity:
                    self._exchange()
        return self.opened

    def _exchange(self) -> None:
        if not self.path.parent.is_dir():
            raise CatalogueError(
                f"the data folder {self.path.parent} is gone; bring it back, or choose another"
            )
        found = opened(self.path.parent)
        if found.access is Access.NOTHING:
            found.engine.dispose()
            raise CatalogueError(f"the catalogue {self.path} is gone, and its place cannot be opened")
        self.opened.engine.dispose()
        self.opened, self._identity = found, identity_of(self.path)
        self.exchanges += 1


def identity_of(path: Path) -> Identity:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino
