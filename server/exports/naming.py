"""What an exported file is called."""

from __future__ import annotations

import re

LABEL_LENGTH = 60
"""Characters of a label that go into a file's name; a name may have 255 bytes at most."""
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")


def file_name(id: str, label: str, suffix: str) -> str:
    """Run and label, in characters that every file system and every HTTP header takes."""
    safe = _UNSAFE.sub("-", label)[:LABEL_LENGTH].strip("-.")
    return f"{id}_{safe}{suffix}" if safe else f"{id}{suffix}"
