"""Everything that is kept of runs: their recordings, the catalogue of them, and who writes both."""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass
from pathlib import Path

from server.catalogue.catalogue import Catalogue
from server.catalogue.shelf import RECORDINGS, file_of
from server.recording.writing.recorder import Recorder

_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,79}")


class NoSuchName(ValueError):
    """That cannot be the id of a run."""


@dataclass(frozen=True, slots=True)
class Archive:
    """folder: of the recordings."""

    folder: Path
    catalogue: Catalogue
    recorder: Recorder

    @classmethod
    def open(cls, data: Path, *, patient: bool = False) -> Archive:
        """Of a data folder; raises `CatalogueError`.

        patient: the recorder is waited for, as by a simulated run that goes as fast as it can.
        """
        folder = data / RECORDINGS
        with contextlib.suppress(
            OSError
        ):  # where nothing can be written, what is there can still be looked at
            folder.mkdir(parents=True, exist_ok=True)
        catalogue = Catalogue.open(data)
        return cls(folder, catalogue, Recorder(folder, catalogue, patient=patient))

    def path_of(self, id: str) -> Path:
        """Where a run's recording is, if there is one; raises `NoSuchName` for what would lead elsewhere."""
        if not _ID.fullmatch(id):
            raise NoSuchName(f"{id[:80]!a} is no run's id: those have letters, digits, - and _")
        return file_of(self.folder, id)

    def close(self) -> None:
        """Finish what is being recorded (at most 5 s) and give everything back."""
        self.recorder.close()
        self.catalogue.close()
