"""Which end is A: the 180 degrees that the shape of the body leaves open."""

from __future__ import annotations

MARK_PATIENCE = 3
"""A mark on the wrong end is believed at the so manieth picture in a row: until then it may be a speck or a glint."""


class EndsMemory:
    """The heading by which the next sighting's ends get their names, rad.

    It never grows old: a robot without current does not turn round by itself. Only a mark on end A knows better.
    """

    def __init__(self, hint: float) -> None:
        self.heading = hint
        self.is_assumed = True
        """Nothing but the hint has told the ends so far: no mark was seen."""
        self._contradictions = 0

    def side(self, remembered: int, mark: int, *, is_followed: bool) -> int:
        """+1 or -1: towards which end of the blob's axis A lies.

        remembered: by the heading.  mark: by the mark, 0 when it is not seen.  is_followed: from picture to picture;
        a robot that comes back from where nobody saw it is believed its mark at once.
        """
        if mark in (0, remembered):
            self._contradictions = 0
            self.is_assumed &= mark == 0
            return remembered
        self._contradictions += 1
        if is_followed and self._contradictions < MARK_PATIENCE:
            return remembered
        self.is_assumed = False
        return mark
