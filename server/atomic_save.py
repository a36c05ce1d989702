"""Saving a file so that a crash at any instant leaves the old one or the new one, whole, and the one before it."""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
import time
from pathlib import Path
from types import TracebackType

STALE = 60.0
"""A half-made file of somebody who died is removed after this long, s; making one takes milliseconds."""


def previous_of(path: Path) -> Path:
    """Where the file as it was before the last save is kept."""
    return path.with_name(path.name + ".previous")


def keep_previous(path: Path, text: str) -> None:
    """Keep `text` as what the file was before; raises OSError."""
    path = path.resolve()
    _put(_written(path, text.encode("utf-8")), previous_of(path))


def replace_file(path: Path, text: str, mode: int | None = None) -> None:
    """Save without keeping what was there before; raises OSError. mode: its permissions, else as they were."""
    path = path.resolve()
    _put(_written(path, text.encode("utf-8"), mode), path)
    _sync_folder(path.parent)


class Staged:
    """The new text of a file, complete and synced beside it. Use as a context: what is not committed is removed.

    Raises OSError when it cannot be written. A path that is a symbolic link stays one.
    """

    def __init__(self, path: Path, text: str) -> None:
        self._path = path.resolve()
        self._path.parent.mkdir(parents=True, exist_ok=True)
        _sweep(self._path)
        self._new = _written(self._path, text.encode("utf-8"))

    def commit(self, before: str) -> None:
        """Keep the old file as `.previous` and let the new one take its place; raises OSError.

        before: what is kept where there is no old file.
        """
        old = self._path.read_bytes() if self._path.exists() else before.encode("utf-8")
        _put(_written(self._path, old), previous_of(self._path))
        os.replace(self._new, self._path)
        _sync_folder(self._path.parent)

    def __enter__(self) -> Staged:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._new.unlink(missing_ok=True)


def _written(path: Path, content: bytes, mode: int | None = None) -> Path:
    """`content` in a synced file beside `path`, with its permissions or with those of `mode`."""
    new = path.with_name(f".{path.name}.{secrets.token_hex(4)}.new")
    handle = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666 if mode is None else mode)
    try:
        with open(handle, "wb") as file:
            file.write(content)
            if mode is None:
                _adopt_permissions(path, handle)
            file.flush()
            os.fsync(handle)
    except OSError:
        new.unlink(missing_ok=True)
        raise
    return new


def _put(new: Path, place: Path) -> None:
    try:
        os.replace(new, place)
    except OSError:
        new.unlink(missing_ok=True)
        raise


def _adopt_permissions(path: Path, handle: int) -> None:
    if not path.exists():
        return
    old = path.stat()
    os.fchmod(handle, stat.S_IMODE(old.st_mode))
    with contextlib.suppress(PermissionError):  # only root may give a file to somebody else
        os.fchown(handle, old.st_uid, old.st_gid)


def _sweep(path: Path) -> None:
    """Remove what a save that was killed has left."""
    for left in path.parent.glob(f".{path.name}.*.new"):
        with contextlib.suppress(FileNotFoundError):
            if time.time() - left.stat().st_mtime > STALE:
                left.unlink()


def _sync_folder(folder: Path) -> None:
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
