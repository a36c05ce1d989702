"""The three axes of coils and field."""

from __future__ import annotations

from typing import Literal

Axis = Literal["x", "y", "z"]
AXES: tuple[Axis, Axis, Axis] = ("x", "y", "z")
