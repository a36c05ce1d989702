"""Where recordings are written: the seam at which a simulated rig's disk can be full, read-only or slow."""

from __future__ import annotations

import errno
import fcntl
import os
import shutil
from pathlib import Path
from tempfile import TemporaryFile
from typing import Protocol

OWN_FILE = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC
"""A recording never takes the place of another file."""


class DiskFile(Protocol):
    """An open file, without a buffer of its own."""

    def fileno(self) -> int: ...
    def write(self, data: bytes | bytearray | memoryview, /) -> int:
        """Takes all of it; raises OSError."""
        ...

    def sync(self) -> None:
        """Returns once everything is on the disk; raises OSError."""
        ...

    def close(self) -> None: ...


class Disk(Protocol):
    """What a recorder asks of a disk; everything raises OSError where the disk does."""

    def create(self, path: Path) -> DiskFile:
        """A new file; raises FileExistsError rather than touch another one."""
        ...

    def check(self, folder: Path) -> None:
        """Whether a file can be made and locked there; leaves none behind."""
        ...

    def free(self, folder: Path) -> int:
        """Bytes."""
        ...


class LocalFile:
    """A file of this computer."""

    def __init__(self, path: Path) -> None:
        self._number = os.open(path, OWN_FILE, 0o666)

    def fileno(self) -> int:
        return self._number

    def write(self, data: bytes | bytearray | memoryview, /) -> int:
        rest = memoryview(data)
        while rest:
            rest = rest[os.write(self._number, rest) :]
        return len(data)

    def sync(self) -> None:
        os.fsync(self._number)

    def close(self) -> None:
        number, self._number = self._number, -1
        if number >= 0:
            os.close(number)


class LocalDisk:
    """This computer's."""

    def create(self, path: Path) -> DiskFile:
        return LocalFile(path)

    def check(self, folder: Path) -> None:
        with TemporaryFile(dir=folder) as probe:
            fcntl.flock(probe.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)

    def free(self, folder: Path) -> int:
        return shutil.disk_usage(folder).free


def sync_folder(folder: Path) -> None:
    """Make a new file's name last; some network disks do so by themselves, and refuse to be asked."""
    number = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(number)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):
            raise
    finally:
        os.close(number)
