"""Paths that somebody drew or sent, by name; kept in a file of the data folder, so that a restart forgets none."""

from __future__ import annotations

import asyncio
import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from control.safety import Refused
from control.trajectories import trajectories
from control.trajectories.custom import SavedPath, TooManyPaths, save_path
from control.trajectories.trajectory import MM
from control.trajectories.waypoints import Smoothing, WaypointsParameters
from server.api.schemas import CustomPathBody
from server.atomic_save import Staged

NAME = "trajectories.json"
"""In the data folder."""
FORMAT = 1


@dataclass(frozen=True, slots=True)
class NamedPath:
    """A saved path as it can be saved anew; lab units."""

    name: str
    whole: WaypointsParameters

    def to_json(self) -> dict[str, Any]:
        return {"name": self.name, **self.whole.model_dump(mode="json")}


class CustomTrajectories:
    """What the page and scripts may add to the trajectories, rename and take out again."""

    def __init__(self) -> None:
        self._file: Path | None = None
        self._turn = asyncio.Lock()

    def open(self, file: Path) -> list[str]:
        """Know the paths of `file` and keep all in it from now on; what could not be read, in words."""
        self._file = file
        try:
            text = file.read_text(encoding="utf-8")
        except FileNotFoundError:
            return []
        except (OSError, UnicodeDecodeError) as error:
            return [f"the saved paths in {file} cannot be read ({error}); {_aside(file)}"]
        problems = _restore(text)
        return [f"{', '.join(problems)}; {_aside(file)}"] if problems else []

    def save(
        self, name: str, points: NDArray[np.float64], closed: bool, speed: float, kind: Smoothing
    ) -> None:
        """Know a path ((n, 2) points, m; m/s) by a free name; raises `Refused` when there are too many."""
        try:
            save_path(name, points, closed, speed, kind)
        except TooManyPaths as error:
            raise Refused(str(error)) from error

    def find(self, name: str) -> NamedPath | None:
        """None for a name that is free, and for what the program brings along."""
        if name not in trajectories:
            return None
        entry = trajectories[name]
        return NamedPath(name, entry.whole) if issubclass(entry, SavedPath) else None

    def forget(self, name: str) -> None:
        trajectories.forget(name)

    def all(self) -> list[NamedPath]:
        found = (self.find(name) for name in trajectories)
        return [path for path in found if path is not None]

    async def keep(self) -> None:
        """Write them all to the file, off the event loop; raises `Refused` where that is not possible."""
        if self._file is None:
            return
        async with self._turn:
            try:
                await asyncio.to_thread(_write, self._file, self.all())
            except OSError as error:
                raise Refused(
                    f"the path cannot be kept in {self._file} ({error.strerror}); make room or choose another "
                    "data folder with --data"
                ) from error


def _write(file: Path, paths: Sequence[NamedPath]) -> None:
    text = json.dumps({"format": FORMAT, "paths": [path.to_json() for path in paths]}, ensure_ascii=False)
    with Staged(file, text) as staged:
        staged.commit("")


def _restore(text: str) -> list[str]:
    """Each path that is whole becomes a trajectory; what is wrong with the others, in words."""
    try:
        paths = json.loads(text)["paths"]
        entries = list(paths) if isinstance(paths, list) else [None]
    except (ValueError, KeyError, TypeError, RecursionError):
        entries = [None]
    return [problem for number, entry in enumerate(entries, start=1) if (problem := _take(number, entry))]


def _take(number: int, entry: object) -> str:
    try:
        path = CustomPathBody.model_validate_json(json.dumps(entry), strict=True)
        save_path(path.name, np.array(path.points_mm) * MM, path.closed, path.speed_mm_s * MM, path.kind)
    except ValidationError as error:
        return f"saved path {number} is damaged ({error.errors()[0]['msg']})"
    except ValueError as error:
        return f"saved path {number} is left out ({error})"
    return ""


def _aside(file: Path) -> str:
    """Keep what could not be read, before the next save replaces it."""
    copy = file.with_name(file.name + ".unread")
    try:
        shutil.copyfile(file, copy)
    except OSError as error:
        return f"the file could not be put aside either ({error.strerror})"
    return f"the file as it was is kept as {copy.name}"
