"""What a person writes about a run. It stands in the catalogue, and beside the recording for the day it is rebuilt."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from server.atomic_save import replace_file
from server.catalogue.errors import CatalogueError
from server.catalogue.records import RunRecord
from server.catalogue.shelf import EDITS, Shelf, file_of

EDITED = ("label", "tags", "notes", "pinned")
LARGEST = 1 << 20
"""Bytes of such a file that are read; the longest note and twenty tags are a tenth of that."""


def edit(shelf: Shelf, id: str, changes: Mapping[str, Any]) -> RunRecord:
    """Change some of label, tags, notes and pinned; the run as it is then. Raises `CatalogueError`: nothing changed."""

    def keep(record: RunRecord) -> None:
        if record.recording_state != "none":
            _keep(file_of(shelf.folder, id, EDITS), record)

    return shelf.catalogue.edit(id, normalised(changes), keep)


def _keep(path: Path, record: RunRecord) -> None:
    text = json.dumps({name: getattr(record, name) for name in EDITED}, ensure_ascii=False, indent=1)
    try:
        replace_file(path, text + "\n")
    except OSError as error:
        raise CatalogueError(
            f"this cannot be saved beside the recording: {error.strerror}; nothing was changed"
        ) from error


def normalised(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Without what nobody sees: spaces around a label, the same tag twice."""
    found = dict(changes)
    if "label" in found:
        found["label"] = " ".join(found["label"].split())
    if "tags" in found:
        tags = (" ".join(tag.split()) for tag in found["tags"])
        found["tags"] = tuple(dict.fromkeys(tag for tag in tags if tag))
    return found


def edits_beside(folder: Path, id: str) -> dict[str, Any]:
    """What was written about a run; empty where nothing is, or where it makes no sense."""
    try:
        with file_of(folder, id, EDITS).open("rb") as file:
            content = json.loads(file.read(LARGEST))
    except (OSError, ValueError, RecursionError):
        return {}
    return normalised(_sensible(content)) if isinstance(content, dict) else {}


def _sensible(content: Mapping[str, Any]) -> dict[str, Any]:
    tags = content.get("tags")
    found = {name: content[name] for name in ("label", "notes") if isinstance(content.get(name), str)}
    if isinstance(content.get("pinned"), bool):
        found["pinned"] = content["pinned"]
    if isinstance(tags, list) and all(isinstance(tag, str) for tag in tags):
        found["tags"] = tags
    return found
