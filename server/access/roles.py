"""What somebody may do."""

from __future__ import annotations

from enum import IntEnum


class Role(IntEnum):
    """Each may do what the one before it may, and more."""

    VIEWER = 1
    OPERATOR = 2
    ADMIN = 3
