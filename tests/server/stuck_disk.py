"""A disk of this computer that does not come back, as one of another computer may when its cable is out."""

from __future__ import annotations

import threading
from pathlib import Path

from server.recording.writing.disk import DiskFile, LocalDisk, LocalFile


class Stuck(LocalDisk):
    """A disk whose `sync` waits."""

    def __init__(self) -> None:
        self.may_go_on = threading.Event()
        self.may_go_on.set()

    def create(self, path: Path) -> DiskFile:
        return StuckFile(path, self.may_go_on)


class StuckFile(LocalFile):
    def __init__(self, path: Path, may_go_on: threading.Event) -> None:
        super().__init__(path)
        self._may_go_on = may_go_on

    def sync(self) -> None:
        self._may_go_on.wait(30.0)
        super().sync()


class Silent(LocalDisk):
    """A disk that does not even say how much room there is."""

    def __init__(self) -> None:
        self.may_answer = threading.Event()

    def free(self, folder: Path) -> int:
        self.may_answer.wait(30.0)
        return super().free(folder)
