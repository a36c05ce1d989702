"""Where runs are kept: the catalogue, and beside it a folder with their recordings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from server.catalogue.catalogue import Catalogue

RECORDINGS = "recordings"
"""In the data folder."""
RECORDING, EDITS, TORN, WALKING = ".mcap", ".json", ".mcap.torn", ".walking"
"""Files of one run, named after it: its recording; what a person has written about it; what could not be mended;
and, while a run is walked that is not recorded, the one whose lock tells that its program lives."""


class Shelf(Protocol):
    """What deleting and editing need; an `Archive` is one, too. folder: of the recordings."""

    @property
    def folder(self) -> Path: ...

    @property
    def catalogue(self) -> Catalogue: ...


@dataclass(frozen=True, slots=True)
class OpenShelf:
    """For a command that records nothing."""

    folder: Path
    catalogue: Catalogue

    @classmethod
    def open(cls, data: Path) -> OpenShelf:
        """Of a data folder; raises `CatalogueError`."""
        return cls(data / RECORDINGS, Catalogue.open(data))

    def close(self) -> None:
        self.catalogue.close()


def file_of(folder: Path, id: str, kind: str = RECORDING) -> Path:
    """One of a run's files, there or not."""
    return folder / f"{id}{kind}"
