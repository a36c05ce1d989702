"""What is wrong with a study, in words for the person who wrote it."""

from __future__ import annotations


class StudyError(ValueError):
    """A definition that cannot be carried out; the text says what was given, what is allowed and where."""
