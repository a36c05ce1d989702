"""What of a module goes to a browser: the code, without what is written in it for people.

A fifth of what the page loads would be comments and spaces. Every line stays on its line, so that an error in a browser
names the place in the file; whoever wants to read the page finds it in the repository, with everything.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

PART = re.compile(
    r"""
    (?P<word> [\w$]+ )
  | (?P<space> \s+ )
  | (?P<sign> [^\w$\s"'`/{}]+ | [{}`] )
  | (?P<comment> //[^\n]* | /\*.*?\*/ )
  | (?P<text> "(?:[^"\\\n]|\\.)*+" | '(?:[^'\\\n]|\\.)*+' )
  | (?P<pattern> /(?:[^/\\\[\n]|\\.|\[(?:[^\]\\\n]|\\.)*+\])++/[a-z]* )
  | (?P<other> . )
    """,
    re.VERBOSE | re.DOTALL,
)
"""The parts of JavaScript that tell comments from what only looks like one; templates are read by themselves."""

TEMPLATE = re.compile(r"(?:[^`\\$]|\\.|\$(?!\{))*+(?:`|\$\{)", re.DOTALL)
"""The text of a template up to its end, or up to a value in it."""

BESIDE = ("comment", "space")
"""Kinds of parts that are no code."""

OPERATORS = frozenset(
    ["return", "typeof", "case", "in", "of", "delete", "void", "throw", "new", "await", "yield", "else", "do"]
)
"""Words after which a slash begins a regular expression, as it does after most signs; after a value it divides."""


SEPARATORS = frozenset(",;:{}()[]=>&|?")
"""Signs beside which a space says nothing. A plus, a minus or a slash may mean something else beside another one."""


def code_alone(module: str) -> str:
    """The text of a JavaScript module without comments and without the spaces that only set it out."""
    kept = [text if kind not in BESIDE else gap(text) for kind, text in parts(module)]
    return "".join(text for place, text in enumerate(kept) if text != " " or not _says_nothing(kept, place))


def gap(text: str) -> str:
    """What stays of a comment or of spaces: the line breaks, or else one space, which keeps words apart."""
    return "\n" * text.count("\n") or " "


def _says_nothing(kept: list[str], place: int) -> bool:
    before, after = kept[place - 1 : place], kept[place + 1 : place + 2]
    return not before or not after or {before[0][-1], after[0][0]} & SEPARATORS != set() or after[0].isspace()


def parts(module: str) -> Iterator[tuple[str, str]]:
    """(kind, text) of each part, in order; together they are the module."""
    place, depth, before = 0, 0, ""
    outside: list[int] = []  # how deep the braces were where each template began whose value is being read
    while (found := PART.match(module, place)) is not None:
        kind, text = str(found.lastgroup), found.group()
        if kind == "pattern" and is_value(before):
            kind, text = "sign", "/"
        if text == "`" or (text == "}" and outside and depth == outside[-1]):
            if text == "}":
                outside.pop()
            kind, text = "template", text + _rest_of_template(module, place + 1)
            if text.endswith("${"):
                outside.append(depth)
        elif kind == "sign":
            depth += {"{": 1, "}": -1}.get(text, 0)
        if kind not in BESIDE:
            before = text
        place += len(text)
        yield kind, text


def is_value(text: str) -> bool:
    """Whether a part may be the end of something that can be divided."""
    return text not in OPERATORS and re.search(r"[\w$)\]}\"'`/]$", text) is not None


def _rest_of_template(module: str, place: int) -> str:
    found = TEMPLATE.match(module, place)
    if found is None:
        raise ValueError(f"a template without an end in a module of the page: `{module[place : place + 60]}…")
    return found.group()
