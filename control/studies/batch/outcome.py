"""What becomes of a run that does not come to its end."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Failed:
    """reason: in the operator's words."""

    reason: str


class RunFailed(Exception):
    """A run that ends without figures; the text is the reason."""
