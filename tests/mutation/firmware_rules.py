"""What a slip of the keyboard does to a line of C++."""

from __future__ import annotations

import re
from collections.abc import Iterator

_RULES = tuple(
    (re.compile(pattern), replacement)
    for pattern, replacement in (
        # arithmetic
        (r" \+ ", " - "),
        (r" - ", " + "),
        (r" \* ", " + "),
        (r" / ", " * "),
        (r" >> ", " << "),
        (r" << ", " >> "),
        (r"\+= ", "-= "),
        (r"-= ", "+= "),
        (r"\+\+", "--"),
        (r"--", "++"),
        (r"(?<=[(,= ])-(?=\w)", ""),
        # bits and logic
        (r" & ", " | "),
        (r" \| ", " & "),
        (r" \^ ", " & "),
        (r"~", ""),
        (r" && ", " || "),
        (r" \|\| ", " && "),
        (r"!(?=[\w(])", ""),
        # comparisons and their boundaries
        (r" < ", " <= "),
        (r" < ", " > "),
        (r" <= ", " < "),
        (r" <= ", " >= "),
        (r" > ", " >= "),
        (r" > ", " < "),
        (r" >= ", " > "),
        (r" >= ", " <= "),
        (r" == ", " != "),
        (r" != ", " == "),
        # constants, and what is left out
        (r"(?<![\w.])(\d+)(?![\w.])", r"(\1 + 1)"),
        (r"\btrue\b", "false"),
        (r"\bfalse\b", "true"),
        (r"^(\s*)[\w.\->\[\]]+(\(.*\)| [-+|&^]?= .*|\+\+|--);$", r"\1;"),
        (r"^(\s*)(\+\+|--)\w+;$", r"\1;"),
        (r"\breturn (?!\{\}).*;", "return {};"),
        (r"\bbreak;", ";"),
    )
)
_NOT_CODE = re.compile(r"^\s*(#|//|namespace\b|using\b|static_assert\b|\}?\s*$)")


def changed_lines(line: str) -> Iterator[str]:
    """Each way in which one line (without its end) may be wrong; comments are left as they are."""
    if _NOT_CODE.match(line):
        return
    code, slashes, comment = line.partition("//")
    seen = {code}
    for pattern, replacement in _RULES:
        for place in pattern.finditer(code):
            changed = code[: place.start()] + place.expand(replacement) + code[place.end() :]
            if changed not in seen:
                seen.add(changed)
                yield changed + slashes + comment
