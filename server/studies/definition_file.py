"""A study's definition on the disk: as JSON, which counts, and as TOML for people; it does not change any more."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from control.studies.definition import StudyDefinition
from control.studies.errors import StudyError
from server.atomic_save import replace_file
from server.studies.errors import StudyStoreError

DEFINITION, FOR_PEOPLE = "definition.json", "definition.toml"


def save_for_people(folder: Path, definition: StudyDefinition) -> None:
    """Raises OSError."""
    replace_file(folder / FOR_PEOPLE, definition.to_toml())


def save(folder: Path, definition: StudyDefinition) -> None:
    """Raises OSError."""
    replace_file(folder / DEFINITION, json.dumps(definition.to_json(), ensure_ascii=False, indent=1))


def read(folder: Path) -> StudyDefinition:
    """Raises `StudyStoreError` for one that this program does not understand."""
    try:
        return StudyDefinition.from_json(json.loads((folder / DEFINITION).read_bytes()))
    except (OSError, ValueError, RecursionError, StudyError) as error:
        raise StudyStoreError(f"the study {folder.name} cannot be read: {error}") from error


def mark_of(raw: Any) -> str:
    """The same for two definitions that say the same, however they are laid out."""
    return hashlib.sha256(json.dumps(raw, sort_keys=True).encode()).hexdigest()


def require_unchanged(folder: Path, mark: str) -> None:
    """Runs of two definitions must not get into one table. Raises `StudyStoreError`. mark: "" where it is not known."""
    path = folder / DEFINITION
    try:
        found = mark_of(json.loads(path.read_bytes()))
    except (OSError, ValueError, RecursionError) as error:
        raise StudyStoreError(f"{path} cannot be read: {error}") from error
    if mark and found != mark:
        raise StudyStoreError(
            f"{path} was changed since the study was made, so its runs would not belong together; "
            "put it back as it was, or begin a new study with the changed definition"
        )
