"""What a campaign is doing just now, for people."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from control.studies.table import StudyRow


@dataclass(frozen=True, slots=True)
class Activity:
    """words: such as "run 7 of 18: walking back to the start".  done, total: runs.  index: of the run, None between
    runs.  row: the one that has just been added.
    """

    words: str
    done: int
    total: int
    index: int | None = None
    row: StudyRow | None = None


Tell = Callable[[Activity], None]


def tell_nobody(_: Activity) -> None:
    """Where nobody listens."""
