"""What can go wrong with the catalogue, in words."""

from __future__ import annotations


class CatalogueError(Exception):
    """The catalogue cannot do what was asked; the text says why and what to do."""


class NoSuchRun(CatalogueError):
    """There is no run of that id."""

    def __init__(self, id: str) -> None:
        super().__init__(f"There is no run {id[:80]!r} in the catalogue.")
        self.id = id


class NotNow(CatalogueError):
    """The run is in a state that does not allow what was asked."""


class BadCursor(CatalogueError):
    """A cursor that no page has given out."""
