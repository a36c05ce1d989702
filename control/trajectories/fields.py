"""Parameter fields that several trajectories share."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

Direction = Literal["clockwise", "anticlockwise"]

SMALLEST_MM = 0.1
"""Smallest size of a figure, mm: what the camera resolves."""
SAME_POINT_MM = 1e-3
"""Points closer together than this are one, mm."""
SLOWEST_MM_S = 1e-3
"""Lowest speed, mm/s: a robot's length takes three hours."""


def millimetres(default: float, title: str, description: str = "", least: float = -500.0) -> Any:
    """A length in mm, from `least` to 500."""
    return Field(
        default=default,
        ge=least,
        le=500.0,
        title=title,
        description=description,
        json_schema_extra={"unit": "mm"},
    )


def degrees(default: float, title: str, description: str = "") -> Any:
    return Field(
        default=default,
        ge=-360.0,
        le=360.0,
        title=title,
        description=description,
        json_schema_extra={"unit": "°"},
    )


def speed(default: float = 3.0) -> Any:
    return Field(
        default=default,
        ge=SLOWEST_MM_S,
        le=50.0,
        title="Speed",
        description="Along the path, at a path step of 0.1 s.",
        json_schema_extra={"unit": "mm/s"},
    )


def direction() -> Any:
    return Field(default="clockwise", title="Direction")
