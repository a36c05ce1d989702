"""What can go wrong with the studies of a data folder, in words."""

from __future__ import annotations


class StudyStoreError(Exception):
    """What was asked cannot be done with the studies of this folder; the text says why and what to do."""


class NoSuchStudy(StudyStoreError):
    """There is no study of that id."""

    def __init__(self, id: str) -> None:
        super().__init__(
            f"There is no study {id[:80]!a}; `pivotrig studies list` shows those that there are."
        )
        self.id = id


class StudyBusy(StudyStoreError):
    """Another process carries the study out."""
