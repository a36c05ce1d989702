"""The disk of a simulated rig's recordings, which can be full, read-only or slow on demand."""

from __future__ import annotations

from pathlib import Path

from control.simulation.disk_faults import DiskFaults
from server.recording.writing.disk import Disk, DiskFile


class FaultyDisk:
    """A disk with fault points in front of it."""

    def __init__(self, disk: Disk, faults: DiskFaults) -> None:
        self._disk = disk
        self._faults = faults

    def create(self, path: Path) -> DiskFile:
        self._faults.check_writable()
        return FaultyFile(self._disk.create(path), self._faults)

    def check(self, folder: Path) -> None:
        self._faults.check_writable()
        self._disk.check(folder)

    def free(self, folder: Path) -> int:
        return 0 if self._faults.full else self._disk.free(folder)


class FaultyFile:
    """A file on such a disk."""

    def __init__(self, file: DiskFile, faults: DiskFaults) -> None:
        self._file = file
        self._faults = faults

    def fileno(self) -> int:
        return self._file.fileno()

    def write(self, data: bytes | bytearray | memoryview, /) -> int:
        self._faults.check_writable()
        self._faults.check_room()
        return self._file.write(data)

    def sync(self) -> None:
        self._faults.wait()
        self._file.sync()

    def close(self) -> None:
        self._file.close()
