"""What free text is looked for in, and whether one run is what a query asks for."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable

from server.catalogue.records import RunQuery, RunRecord

WORDS_TAKEN = 10
"""Words of a search that count; each one is looked for in every run."""
EQUAL = ("state", "controller", "trajectory", "study")
FLAGS = ("simulated", "pinned")


def folded(text: str) -> str:
    """Text for comparing: one line without case, and with one way of writing each letter.

    SQLite compares text up to its first NUL, so there is none.
    """
    return " ".join(unicodedata.normalize("NFKC", text).casefold().replace("\0", " ").split())


def words_in(tags: Iterable[str], *texts: str) -> str:
    """All that is looked for by text, folded. Only tags are lines that begin with #, so a whole one can be told."""
    lines = (*(f" {folded(text)}" for text in texts), *(f"#{folded(tag)}" for tag in tags))
    return "\n".join((*lines, ""))


def line_of(tag: str) -> str:
    """How a tag stands among a run's words."""
    return f"\n#{folded(tag)}\n"


def searched(text: str) -> list[str]:
    return folded(text).split()[:WORDS_TAKEN]


def words_of(record: RunRecord) -> str:
    texts = (record.id, record.label, record.controller, record.trajectory, record.notes)
    return words_in(record.tags, *texts)


def matches(query: RunQuery, record: RunRecord) -> bool:
    """The same as the catalogue's own conditions, for a run that is not in it yet."""
    return (
        all(getattr(query, name) in ("", getattr(record, name)) for name in EQUAL)
        and all(getattr(query, name) in (None, getattr(record, name)) for name in FLAGS)
        and (query.since is None or record.started_at >= query.since)
        and (query.until is None or record.started_at < query.until)
        and _has_words(query, words_of(record))
    )


def _has_words(query: RunQuery, words: str) -> bool:
    return (not query.tag or line_of(query.tag) in words) and all(
        word in words for word in searched(query.text)
    )
