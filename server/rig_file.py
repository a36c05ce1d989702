"""The rig file on disk: read and validated whole, changed without losing a comment, saved so that nothing tears it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, MutableMapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import tomlkit
from pydantic import ValidationError

from server.atomic_save import Staged, keep_previous, previous_of
from server.rig_secrets import with_secrets
from server.section import Section, in_words
from server.settings import FORMAT, RigFile

NAME = "rig.toml"
"""The rig file that the data folder may hold."""

HEADING = "# A rig of pivotrig. What is left out here is the paper's rig, simulated.\n"
NEW = f"{HEADING}version = {FORMAT}\n"
"""A rig file with nothing in it."""


class RigFileError(ValueError):
    """A rig file that cannot be used or saved; the text says where and why."""


class ChangedOnDisk(RigFileError):
    """Somebody has edited the file since it was read."""


def load_rig_file(path: Path) -> RigFile:
    """Read and validate a rig file; raises `RigFileError` naming every wrong value with its line."""
    return settings_in(read(path), path)


def is_there(path: Path) -> bool:
    """Whether there is such a file; raises `RigFileError` for a path that may not or cannot be looked at."""
    try:
        return path.exists()
    except OSError as error:
        raise RigFileError(f"cannot read the rig file {path}: {error.strerror or error}") from error


def read(path: Path) -> str:
    """The file's text; raises `RigFileError`."""
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise RigFileError(f"cannot read the rig file {path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise RigFileError(f"the rig file {path} is not TOML: it is not UTF-8 text ({error})") from error


def settings_in(text: str, path: Path) -> RigFile:
    """The rig that a file's text describes; raises `RigFileError`."""
    try:
        values = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise RigFileError(f"the rig file {path} is not TOML: {error}") from error
    _refuse_newer(values, path)
    try:
        return RigFile.model_validate(values)
    except ValidationError as error:
        lines = _lines(text)
        words = in_words(error, lambda field: _at_line(lines, field))
        raise RigFileError(f"the rig file {path} cannot be used:\n{words}") from error


def _refuse_newer(values: Mapping[str, Any], path: Path) -> None:
    found = values.get("version")
    if isinstance(found, int) and not isinstance(found, bool) and found > FORMAT:
        raise RigFileError(
            f"the rig file {path} has version = {found}, and this pivotrig {version('pivotrig')} reads versions up "
            f"to {FORMAT}: it needs a newer pivotrig. The file has not been changed"
        )


# Where a value stands ---------------------------------------------------------------------------

_HEADER = re.compile(r"\s*\[\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"\s*([\w.\"'-]+(?:\s*\.\s*[\w\"'-]+)*)\s*=")


def _at_line(lines: Mapping[tuple[str, ...], int], field: tuple[str | int, ...]) -> str:
    """ " (line 7)" for the line that sets a field, or the table that lacks it; "" when neither is there."""
    wanted = tuple(str(part) for part in field)
    for length in range(len(wanted), 0, -1):
        if wanted[:length] in lines:
            return f" (line {lines[wanted[:length]]})"
    return ""


def _lines(text: str) -> dict[tuple[str, ...], int]:
    """Line number of each table and each key, by its path."""
    found: dict[tuple[str, ...], int] = {}
    table: tuple[str, ...] = ()
    for number, line in enumerate(text.splitlines(), start=1):
        if header := _HEADER.match(line):
            table = _path(header[1])
            found.setdefault(table, number)
        elif key := _KEY.match(line):
            found.setdefault((*table, *_path(key[1])), number)
    return found


def _path(dotted: str) -> tuple[str, ...]:
    return tuple(part.strip().strip("\"'") for part in dotted.split("."))


# Changes ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Plan:
    """A rig file as it shall become. changed: the dotted names of the fields whose values differ."""

    text: str
    settings: RigFile
    changed: tuple[str, ...]


def merged(values: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`values` with nested `changes`; None puts a default back."""
    result = dict(values)
    for name, change in changes.items():
        if change is None:
            result.pop(name, None)
        elif isinstance(change, Mapping) and isinstance(result.get(name), Mapping):
            result[name] = merged(result[name], change)
        else:
            result[name] = change
    return result


def differences(before: Section, after: Section, prefix: str = "") -> tuple[str, ...]:
    """Dotted names of the fields whose values differ."""
    names: list[str] = []
    for name in type(after).model_fields:
        old, new = getattr(before, name), getattr(after, name)
        if isinstance(old, Section) and isinstance(new, Section):
            names += differences(old, new, f"{prefix}{name}.")
        elif isinstance(old, dict) and isinstance(new, dict):
            names += [f"{prefix}{name}.{key}" for key in {**old, **new} if old.get(key) != new.get(key)]
        elif old != new:
            names.append(prefix + name)
    return tuple(names)


def with_settings(text: str, before: RigFile, after: RigFile) -> str:
    """The text with the values of `after` where they differ from `before`; comments and layout stay.

    A layout in which that does not work out (some with dotted keys or inline tables) is given up for a plain one with
    every value.
    """
    document = tomlkit.parse(text or NEW)
    try:
        _write(document, before, after)
    except ValueError:  # tomlkit puts no table into an inline one
        return written_anew(after)
    changed = tomlkit.dumps(document)
    return changed if _says(changed, after) else written_anew(after)


def _says(text: str, settings: RigFile) -> bool:
    try:
        return RigFile.model_validate(tomllib.loads(text)) == settings
    except ValueError:
        return False


def written_anew(settings: RigFile) -> str:
    """A rig file's text with every value and no comments."""
    return HEADING + tomlkit.dumps(settings.model_dump(mode="json", exclude_none=True))


def _write(table: MutableMapping[str, Any], before: Section | None, after: Section) -> None:
    plain = after.model_dump(mode="json")
    for name in type(after).model_fields:
        old, new = getattr(before, name, None), getattr(after, name)
        if old == new and before is not None:
            continue
        if isinstance(new, Section):
            _write_section(table, name, old if isinstance(old, Section) else None, new)
        elif isinstance(new, dict) and new:
            _write_named(table, name, old if isinstance(old, dict) else {}, new)
        elif plain[name] is None or plain[name] == {}:
            table.pop(name, None)
        else:
            table[name] = plain[name]


def _write_section(
    table: MutableMapping[str, Any], name: str, before: Section | None, after: Section
) -> None:
    """A section that the file has not had is written whole when some of its fields have no default."""
    if name not in table:
        table[name] = tomlkit.table()
        if any(field.is_required() for field in type(after).model_fields.values()):
            before = None
    _write(table[name], before, after)


def _write_named(
    table: MutableMapping[str, Any], name: str, before: Mapping[str, Section], after: Mapping[str, Section]
) -> None:
    """A table of sections with names that the lab has given them; a new one is written whole."""
    sections = table.setdefault(name, tomlkit.table(is_super_table=True))
    for gone in before.keys() - after.keys():
        sections.pop(gone, None)
    for key, section in after.items():
        if key not in sections:
            sections[key] = tomlkit.table()
            _write(sections[key], None, section)
        elif section != before.get(key):
            _write(sections[key], before.get(key), section)


class RigStore:
    """One rig file, which need not be there yet. text, settings: as last read or saved here."""

    def __init__(self, path: Path) -> None:
        """Reads the file where there is one; raises `RigFileError`."""
        self.path = path
        self.is_saved = is_there(path)
        self.text = read(path) if self.is_saved else ""
        self.settings = settings_in(self.text, path)

    def plan(self, changes: Mapping[str, Any]) -> Plan:
        """What `changes` make of the file; raises ValidationError or `RigFileError`, and changes nothing."""
        asked = with_secrets(changes, self.settings)
        wanted = RigFile.model_validate(merged(self.settings.model_dump(mode="json"), asked))
        text = with_settings(self.text, self.settings, wanted)
        return Plan(text, wanted, differences(self.settings, wanted))

    def plan_of_disk(self) -> Plan:
        """The file as it is on the disk now; raises `RigFileError`."""
        return self._plan_of(read(self.path), self.path)

    def plan_of_previous(self) -> Plan:
        """The file as it was before the last save; raises `RigFileError`."""
        path = previous_of(self.path)
        if not is_there(path):
            raise RigFileError(f"there is nothing to undo: no earlier version of {self.path} has been kept")
        return self._plan_of(read(path), path)

    def _plan_of(self, text: str, path: Path) -> Plan:
        settings = settings_in(text, path)
        return Plan(text, settings, differences(self.settings, settings))

    @property
    def is_as_read(self) -> bool:
        """Whether nobody else has written the file; one that was deleted counts as unchanged."""
        return not self.path.exists() or read(self.path) == self.text

    def _require_as_read(self) -> None:
        if not self.is_as_read:
            raise ChangedOnDisk(
                f"the rig file {self.path} was edited since it was read; reload it first (POST /api/v1/rig/reload)"
            )

    def stage(self, plan: Plan) -> Staged:
        """The new file, complete on the disk beside the old one; raises `RigFileError`."""
        self._require_as_read()
        try:
            return Staged(self.path, plan.text)
        except OSError as error:
            raise self._not_saved(error) from error

    def commit(self, staged: Staged, plan: Plan) -> None:
        """Put the staged file in place, the old one kept beside it; raises `RigFileError`."""
        self._require_as_read()  # a machine may have been built in the meantime, which takes seconds
        try:
            staged.commit(self.text or NEW)
        except OSError as error:
            raise self._not_saved(error) from error
        self._take(plan)

    def take_disk(self, plan: Plan) -> None:
        """From now on the file is what the plan says, as on the disk; what it was before is kept beside it.

        Raises `RigFileError` when that cannot be kept; the file counts as read all the same.
        """
        before = self.text
        self._take(plan)
        try:
            if plan.text != before:
                keep_previous(self.path, before or NEW)
        except OSError as error:
            raise RigFileError(
                f"the rig file {self.path} was read and is in force, but what it was before cannot be kept: "
                f"{error.strerror or error}"
            ) from error

    def _take(self, plan: Plan) -> None:
        self.text, self.settings, self.is_saved = plan.text, plan.settings, True

    def save(self, changes: Mapping[str, Any]) -> Plan:
        """Change the file on the disk; raises ValidationError or `RigFileError`, and then nothing has changed."""
        plan = self.plan(changes)
        with self.stage(plan) as staged:
            self.commit(staged, plan)
        return plan

    def _not_saved(self, error: OSError) -> RigFileError:
        return RigFileError(
            f"the rig file {self.path} cannot be saved: {error.strerror or error}; nothing was changed"
        )
