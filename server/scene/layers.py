"""The parts of the scene that each viewer may hide; each is the top of a branch of nodes, and has its name."""

from __future__ import annotations

from typing import Literal, get_args

Layer = Literal["field", "coils", "camera", "trail", "reference"]

LAYERS: tuple[Layer, ...] = get_args(Layer)
AT_FIRST: frozenset[Layer] = frozenset(LAYERS) - {"camera"}
"""Shown until a viewer says otherwise. The camera's picture is some 100 kB a second."""


def root_of(layer: Layer) -> str:
    """The name of the node that hides the whole layer."""
    return f"/{layer}"
