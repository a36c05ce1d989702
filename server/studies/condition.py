"""In which state a study is: a small file that is exchanged whole, and the lock of who carries it out."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import time
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal, get_args

from server.atomic_save import replace_file
from server.studies.errors import NoSuchStudy, StudyBusy
from server.studies.results_file import cannot_write

StudyState = Literal["planned", "running", "stopped", "finished", "failed", "interrupted"]
"""planned: not begun.  stopped: by a person, or its hours were over.  failed: by its rule for failing runs.
interrupted: its program, its workers or its disk came to an end. All but finished can go on."""
ENDED: tuple[StudyState, ...] = ("stopped", "finished", "failed", "interrupted")
STATE, LOCK = "state.json", "lock"
LOOKS, BETWEEN_LOOKS = 250, 0.02
"""Who only asks whether a study is claimed holds its lock for some microseconds, or for as long as a busy computer
lets it wait in the middle of that; pauses in s."""
PROGRAM_ENDED = "the program that carried it out was ended"


@dataclass(frozen=True, slots=True)
class Condition:
    """created_at: ISO 8601, UTC.  wall_s: time that it was worked on, all sittings together, s.

    definition: its mark, "" where it is not known.  pardoned: rows that there were when a person last went on with
    it after it had failed.
    """

    state: StudyState
    created_at: str
    reason: str = ""
    wall_s: float = 0.0
    definition: str = ""
    pardoned: int = 0

    @property
    def created(self) -> datetime:
        return datetime.fromisoformat(self.created_at)


def read_condition(folder: Path) -> Condition:
    """As it stands on the disk; one whose file is lost is what its folder still tells. Raises `NoSuchStudy`."""
    try:
        found = json.loads((folder / STATE).read_bytes())
        known = found["state"], found["created_at"], found["reason"], float(found["wall_s"])
        condition = Condition(*known, str(found.get("definition", "")), int(found.get("pardoned", 0)))
        if condition.state in get_args(StudyState) and condition.created.tzinfo is not None:
            return condition
    except (OSError, ValueError, TypeError, KeyError):
        pass
    try:
        made = datetime.fromtimestamp(folder.stat().st_mtime, UTC)
    except FileNotFoundError as error:
        raise NoSuchStudy(folder.name) from error
    return Condition("interrupted", made.isoformat(), "its state file was lost")


def write_condition(folder: Path, condition: Condition) -> None:
    """Raises `StudyStoreError`."""
    try:
        replace_file(folder / STATE, json.dumps(asdict(condition), ensure_ascii=False, indent=1) + "\n")
    except OSError as error:
        raise cannot_write(folder / STATE, error) from error


class Claim:
    """The right to carry a study out. It dies with the process that has it."""

    def __init__(self, folder: Path, name: str) -> None:
        """Raises `StudyBusy` where another process, or thread, has it, and `NoSuchStudy`, `StudyStoreError`."""
        try:
            self._number = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        except FileNotFoundError as error:
            raise NoSuchStudy(folder.name) from error
        except OSError as error:
            raise cannot_write(folder / LOCK, error) from error
        if not self._locked():
            owner = os.pread(self._number, 20, 0).decode("ascii", "replace").strip()
            os.close(self._number)
            raise StudyBusy(
                f"the study {name!r} is being carried out already, by process {owner or '?'}; "
                "wait until it has finished, or stop that one first"
            )
        with contextlib.suppress(OSError):  # on a full disk nobody is told whose it is
            os.ftruncate(self._number, 0)
            os.pwrite(self._number, f"{os.getpid()}\n".encode("ascii"), 0)

    def _locked(self) -> bool:
        for _ in range(LOOKS):
            try:
                fcntl.flock(self._number, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if _has_owner(self._number):
                    return False
                time.sleep(BETWEEN_LOOKS)
            else:
                return True
        return False

    def release(self) -> None:
        os.close(self._number)


def is_claimed(folder: Path) -> bool:
    """Whether somebody carries it out just now."""
    try:
        number = os.open(folder / LOCK, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        return _has_owner(number)
    finally:
        os.close(number)


def _has_owner(number: int) -> bool:
    """Whether the open lock file is somebody's; others who only look do not count."""
    try:
        fcntl.flock(number, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    fcntl.flock(number, fcntl.LOCK_UN)
    return False
