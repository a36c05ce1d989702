"""All studies of a data folder. Each is a folder of its own; the catalogue lists them and can be made anew."""

from __future__ import annotations

import contextlib
import re
import shutil
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from control.studies.definition import StudyDefinition
from server.run_list import new_id
from server.studies import definition_file
from server.studies.condition import Claim, Condition, write_condition
from server.studies.definition_file import DEFINITION
from server.studies.errors import NoSuchStudy, StudyStoreError
from server.studies.study import Study

if TYPE_CHECKING:
    from server.catalogue.catalogue import Catalogue
    from server.catalogue.records import StudyRecord

T = TypeVar("T")

STUDIES = "studies"
"""In the data folder."""
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,79}")


class StudyStore:
    """catalogue: where the studies are listed, too; None: nowhere else."""

    def __init__(self, data: Path, catalogue: Catalogue | None = None) -> None:
        self.folder = data / STUDIES
        self._catalogue = catalogue

    def create(self, definition: StudyDefinition) -> Study:
        """A new study, planned; raises `StudyStoreError`."""
        folder = self.folder / new_id()
        try:
            folder.mkdir(parents=True)
            _lay_out(folder, definition)
        except (OSError, StudyStoreError) as error:
            shutil.rmtree(folder, ignore_errors=True)
            raise StudyStoreError(
                f"a study cannot be kept in {self.folder}: {getattr(error, 'strerror', None) or error}; "
                "choose another folder with --data"
            ) from error
        study = Study(folder, definition, self._list)
        self._list(study)
        return study

    def open(self, id: str) -> Study:
        """Raises `NoSuchStudy`, and `StudyStoreError` for one whose definition cannot be read."""
        folder = self.folder / id
        if not _ID.fullmatch(id) or not (folder / DEFINITION).is_file():
            raise NoSuchStudy(id)
        return Study(folder, definition_file.read(folder), self._list)

    def ids(self) -> list[str]:
        """Newest first."""
        found = self.folder.glob(f"*/{DEFINITION}")
        return sorted((path.parent.name for path in found if _ID.fullmatch(path.parent.name)), reverse=True)

    def all(self) -> list[Study]:
        """Newest first; one that cannot be read is left out (`unreadable` says why)."""
        return list(self._readable({}))

    def described(self, describe: Callable[[Study], T]) -> list[T]:
        """What is said of each, newest first; nothing of one that is deleted meanwhile."""
        said = list[T]()
        for study in self.all():
            with contextlib.suppress(NoSuchStudy):
                said.append(describe(study))
        return said

    def unreadable(self) -> dict[str, str]:
        """Studies whose definition this program does not understand, and why, by id."""
        told: dict[str, str] = {}
        self._readable(told)
        return told

    def _readable(self, told: dict[str, str]) -> list[Study]:
        found = []
        for id in self.ids():
            try:
                found.append(self.open(id))
            except NoSuchStudy:  # deleted since
                continue
            except StudyStoreError as error:
                told[id] = str(error)
        return found

    def delete(self, id: str) -> None:
        """With its results and report, not with its runs. Raises `NoSuchStudy`, `StudyBusy`, `StudyStoreError`."""
        folder = self.folder / id
        if not _ID.fullmatch(id) or not folder.is_dir():
            raise NoSuchStudy(id)
        claim = Claim(folder, id)
        try:
            (folder / DEFINITION).unlink(
                missing_ok=True
            )  # from now on nobody sees it, whatever comes between
            shutil.rmtree(folder)
        except OSError as error:
            raise StudyStoreError(f"the study {id} cannot be deleted: {error.strerror or error}") from error
        finally:
            claim.release()
        if self._catalogue is not None:
            self._catalogue.studies.delete(id)

    def newest_like(self, definition: StudyDefinition) -> Study | None:
        """The newest unfinished study of exactly this definition."""
        for study in self.all():
            if study.definition == definition and study.state != "finished":
                return study
        return None

    def newest_named(self, name: str) -> Study | None:
        """The newest unfinished study of that name."""
        return next(
            (each for each in self.all() if each.definition.name == name and each.state != "finished"), None
        )

    def relist(self) -> int:
        """Make the catalogue's list of studies what is in the folder; how many there are. Raises `CatalogueError`."""
        ids = self.ids()
        if self._catalogue is None:
            return len(ids)
        listed = {record.id: record for record in self._catalogue.studies.all()}
        if listed.keys() - ids:
            self._catalogue.studies.keep_only(ids)
        for record in self.described(_record):
            if listed.get(record.id) != record:
                self._catalogue.studies.put(record)
        return len(ids)

    def _list(self, study: Study) -> None:
        """The folder is what counts: a catalogue that cannot be written to is made anew some other day."""
        if self._catalogue is None:
            return
        from server.catalogue.errors import CatalogueError

        with contextlib.suppress(CatalogueError):
            self._catalogue.studies.put(_record(study))


def _lay_out(folder: Path, definition: StudyDefinition) -> None:
    """The definition comes last: with it there is a study. Raises OSError, `StudyStoreError`."""
    definition_file.save_for_people(folder, definition)
    mark = definition_file.mark_of(definition.to_json())
    write_condition(folder, Condition("planned", datetime.now(UTC).isoformat(), definition=mark))
    definition_file.save(folder, definition)


def _record(study: Study) -> StudyRecord:
    from server.catalogue.records import StudyRecord

    condition, definition = study.condition, study.definition
    return StudyRecord(study.id, definition.name, definition.to_json(), condition.state, condition.created)
