"""A whole rig file taken over from another computer, and this rig's own given away."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tomlkit.exceptions import TOMLKitError

from server.rig_file import Plan, RigFileError, RigStore, differences, settings_in, written_anew
from server.rig_secrets import text_with_secrets, text_without_secrets
from server.settings import RigFile

GIVEN = Path("rig.toml")
"""What a file that comes from a page is called in words."""


class UnusableText(RigFileError):
    """A text that is no rig file; the words say what is wrong in it."""


def exported(store: RigStore) -> str:
    """The rig file's text with its comments; every value where there is no file. Secrets are hidden."""
    return text_without_secrets(store.text or written_anew(store.settings))


def plan_of_text(store: RigStore, text: str) -> Plan:
    """What another file's text makes of the rig; raises `UnusableText` with all that is wrong in it.

    What it hides is as this rig has it.
    """
    own = store.settings
    try:
        text = text_with_secrets(text, own)
    except (TOMLKitError, ValueError) as error:
        raise UnusableText(f"the file is not TOML: {error}") from error
    try:
        settings = settings_in(text, GIVEN)
    except RigFileError as error:
        raise UnusableText(str(error)) from error
    return Plan(text, settings, differences(own, settings))


def listed(before: RigFile, plan: Plan) -> list[dict[str, Any]]:
    """What would change: dotted names with both values, as they may be told."""
    old, new = before.to_public(), plan.settings.to_public()
    return [{"field": field, "from": _at(old, field), "to": _at(new, field)} for field in plan.changed]


def _at(values: Any, field: str) -> Any:
    for name in field.split("."):
        values = values.get(name) if isinstance(values, dict) else None
    return values
