"""What is wrong with a value that a file or a request gave, in words."""

from __future__ import annotations

from collections.abc import Callable

from pydantic import ValidationError

SECRET_FIELDS = frozenset({"webhook_url", "token"})
"""Fields whose values are told to nobody, not even when they are wrong."""
LONGEST_GIVEN = 100
"""Characters that are shown of what was given: enough to find it again."""
MOST_LINES = 100
"""Wrong values that are told one by one; a file with more is another kind of file."""


def _nowhere(_: tuple[str | int, ...]) -> str:
    return ""


def in_words(error: ValidationError, place: Callable[[tuple[str | int, ...]], str] = _nowhere) -> str:
    """One line for each wrong value: its name, what is wrong with it, what was given, and where `place` finds it."""
    lines = []
    problems = error.errors(include_url=False)
    for problem in problems[:MOST_LINES]:
        where = ".".join(str(part) for part in problem["loc"]) or "the whole file"
        is_one_value = problem["type"] not in ("missing", "extra_forbidden") and not isinstance(
            problem["input"], dict
        )
        may_be_told = is_one_value and SECRET_FIELDS.isdisjoint(problem["loc"])
        given = f" (given: {_cut(repr(problem['input']))})" if may_be_told else ""
        lines.append(f"  {where}: {problem['msg']}{given}{place(problem['loc'])}")
    if len(problems) > MOST_LINES:
        lines.append(f"  … and {len(problems) - MOST_LINES} more")
    return "\n".join(lines)


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST_GIVEN else f"{text[:LONGEST_GIVEN]}…"
