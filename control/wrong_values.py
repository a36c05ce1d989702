"""What is wrong with a value that a file or a request gave, in words."""

from __future__ import annotations

from collections.abc import Callable

from pydantic import ValidationError

SECRET_FIELDS = frozenset({"webhook_url"})
"""Fields whose values are told to nobody, not even when they are wrong."""
LONGEST_GIVEN = 100
"""Characters that are shown of what was given: enough to find it again."""


def _nowhere(_: tuple[str | int, ...]) -> str:
    return ""


def in_words(error: ValidationError, place: Callable[[tuple[str | int, ...]], str] = _nowhere) -> str:
    """One line for each wrong value: its name, what is wrong with it, what was given, and where `place` finds it."""
    lines = []
    for problem in error.errors(include_url=False):
        where = ".".join(str(part) for part in problem["loc"]) or "the whole file"
        is_one_value = problem["type"] not in ("missing", "extra_forbidden") and not isinstance(
            problem["input"], dict
        )
        may_be_told = is_one_value and SECRET_FIELDS.isdisjoint(problem["loc"])
        given = f" (given: {_cut(repr(problem['input']))})" if may_be_told else ""
        lines.append(f"  {where}: {problem['msg']}{given}{place(problem['loc'])}")
    return "\n".join(lines)


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST_GIVEN else f"{text[:LONGEST_GIVEN]}…"
