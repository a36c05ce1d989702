"""What of a rig's values stays secret, and how values that were shown without it find back to it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, MutableMapping
from typing import Any

import tomlkit

from server.notification_section import shown_webhook
from server.settings import RigFile
from vision.sources.addresses import SECRET, shown

Hide = Callable[[str], str]
Secret = tuple[str, str, Hide, str]

_PUT_ASIDE = re.compile(r"\b((?:uri|webhook_url)[\"']?\s*=\s*[\"']*)[^\"'\n]+")
"""A secret setting within a comment; the value goes whole."""


def _secrets(own: RigFile) -> tuple[Secret, ...]:
    """Section, field, how its value may be told, and this rig's own."""
    return (
        ("camera", "uri", shown, own.camera.uri),
        ("notifications", "webhook_url", shown_webhook, own.notifications.webhook_url),
    )


def with_secrets(changes: Mapping[str, Any], own: RigFile) -> dict[str, Any]:
    """The changes, but what comes back as it was shown is what the rig has."""
    result = dict(changes)
    for section, field, hide, secret in _secrets(own):
        values = result.get(section)
        if isinstance(values, Mapping) and values.get(field) == hide(secret):
            result[section] = {**values, field: secret}
    return result


def text_without_secrets(text: str) -> str:
    """A rig file's text as it may be given away; its comments stay, but for the values of what is secret."""
    document = tomlkit.parse(text)
    for section, field, hide, _ in _secrets(RigFile()):
        values = document.get(section)
        if isinstance(values, MutableMapping) and isinstance(value := values.get(field), str):
            values[field] = hide(str(value))
    return "".join(_told(line) for line in tomlkit.dumps(document).splitlines(keepends=True))


def _told(line: str) -> str:
    """A line whose comment may be a setting that somebody has put out of force."""
    code, mark, comment = line.partition("#")
    return code + mark + _PUT_ASIDE.sub(rf"\1{SECRET}", comment) if mark and not code.strip() else line


def text_with_secrets(text: str, own: RigFile) -> str:
    """A text that was given away, with this rig's own secrets where it hides some; raises tomlkit's errors.

    A hidden address of notifications is this rig's own whatever its host is, since nobody can tell another.
    """
    document = tomlkit.parse(text)
    for section, field, hide, secret in _secrets(own):
        values = document.get(section)
        if not isinstance(values, MutableMapping) or not isinstance(value := values.get(field), str):
            continue
        if str(value) == hide(secret) or (hide is shown_webhook and SECRET in value):
            values[field] = secret
    return tomlkit.dumps(document)
