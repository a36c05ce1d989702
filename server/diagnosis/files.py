"""The rig file and the data folder."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from control.link.conversion import LinkError
from server.atomic_save import previous_of
from server.diagnosis.check import Check, info, ok, problem, warning
from server.exchange import rehearse
from server.rig_file import RigFileError, RigStore
from server.settings import RigFile

LOW_SPACE = 2_000_000_000
"""Bytes that an hour of recording takes at most, roughly: 60 ticks/s and 10 pictures/s."""
NO_SPACE = 100_000_000


def rig_file(path: Path, is_named: bool) -> tuple[RigFile | None, Check]:
    """The rig that the file describes; None when it cannot be used. is_named: somebody asked for this file."""
    try:
        store = RigStore(path)
    except RigFileError as error:
        return None, problem("rig file", str(error), _way_back(path))
    if not store.is_saved:
        if is_named:
            return None, problem("rig file", f"there is no rig file {path}", "name another with --rig")
        return store.settings, info(
            "rig file", "none saved: the paper's rig, simulated", "--rig FILE checks another"
        )
    kind = "simulated" if store.settings.is_simulated else "real"
    return store.settings, ok(
        "rig file", f"{path}: {store.settings.name!r}, {kind}, version {store.settings.version}"
    )


def _way_back(path: Path) -> str:
    previous = previous_of(path)
    if os.path.exists(previous):  # which is never in doubt, unlike Path.exists
        return f"correct it, or copy {previous} over it: the file as it was before"
    return "correct it; rig.example.toml shows every value with its default"


def goes_together(settings: RigFile) -> Check:
    """Whether a rig can be built from the values, without its devices."""
    try:
        rehearse(settings)
    except (ValueError, LinkError) as error:
        return problem("rig", str(error), "correct the rig file: these values are allowed, but not together")
    return ok("rig", "its values go together")


def data_folder(folder: Path) -> Check:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"x")
            os.fsync(file.fileno())
    except OSError as error:
        return problem(
            "data folder",
            f"{folder} cannot be written: {error.strerror or error}",
            "choose another with --data",
        )
    free = shutil.disk_usage(folder).free
    found = f"{folder}: {free / 1e9:.1f} GB free"
    if free < NO_SPACE:
        return problem("data folder", found, "make room: nothing can be recorded")
    if free < LOW_SPACE:
        return warning("data folder", found, "make room: an hour's recording may not fit")
    return ok("data folder", found)
