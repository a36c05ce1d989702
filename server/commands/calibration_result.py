"""What a calibration found: shown, or written into the rig file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from server.commands.outcome import FAILED, console, fail
from server.data_folder import rig_path
from server.rig_file import RigFileError, RigStore
from server.section import in_words


def saved_or_shown(rig: Path | None, changes: dict[str, Any], save: bool) -> str:
    """Write the changes into the rig file where that is asked for; a line that says where they are.

    What cannot be written is shown all the same: nobody wants to measure it again.
    """
    lines = "\n".join(["for the rig file:", *toml_lines(changes)])
    try:
        store = RigStore(rig_path(rig))
        store.plan(changes)
        if not save:
            return lines
        store.save(changes)
    except ValidationError as error:
        raise fail(
            f"the result does not fit into the rig file:\n{in_words(error)}\n{lines}", FAILED
        ) from error
    except RigFileError as error:
        raise fail(f"{error}\n{lines}", FAILED) from error
    return f"saved in {store.path}; the file before is kept beside it"


def toml_lines(changes: dict[str, Any], prefix: str = "") -> list[str]:
    """Nested changes as the lines of a rig file; what is None has none."""
    plain = {name: value for name, value in changes.items() if not (value is None or isinstance(value, dict))}
    lines = [f"{name} = {_toml(value)}" for name, value in plain.items()]
    if lines and prefix:
        lines.insert(0, f"[{prefix}]")
    for name, value in changes.items():
        if isinstance(value, dict):
            lines += toml_lines(value, f"{prefix}.{name}" if prefix else name)
    return lines


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else str(value)


def show(result: dict[str, Any], words: list[str], where: str, as_json: bool) -> None:
    if as_json:
        console.print(where, markup=False, highlight=False, soft_wrap=True)
        print(json.dumps(result, allow_nan=False))
    else:
        print("\n".join([*words, "", where]))
