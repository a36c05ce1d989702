"""What a module of the page imports and exports, and its code without that.

Only the syntax that the page is written in is understood; anything else is refused, not guessed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from server.page_text import BESIDE, parts

MODULES = "$modules"
"""Name of the object, in the page, that has the exports of each module that has been there."""

DEFAULT = "$default"
"""What a default export is called within its module."""

DEPTH = {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}
DECLARING = ("const", "class", "async", "function", "*")
"""What may stand between `export` and a name; a `let` is none: whoever imports it would keep its first value."""

LISTED = re.compile(r"([\w$]+)(?: as ([\w$]+))?")
"""One name of a list in braces, with the name that it gets."""

Resolve = Callable[[str], str]
"""Address in an import → name of the module."""


class NotUnderstood(ValueError):
    """A module is written in a way that cannot be joined with others."""


@dataclass(slots=True)
class Part:
    """A module as a part of a larger one.

    code: with as many lines as the module.  imports: names of modules, in order.  later: those it loads when they are
    needed.  exports: an expression by each name.  passed_on: modules of which it exports everything.
    """

    name: str
    code: str = ""
    imports: list[str] = field(default_factory=list[str])
    later: list[str] = field(default_factory=list[str])
    exports: dict[str, str] = field(default_factory=dict[str, str])
    passed_on: list[str] = field(default_factory=list[str])


def kept(name: str) -> str:
    """The exports of a module, as an expression."""
    return f"{MODULES}[{json.dumps(name)}]"


def part_of(name: str, code: str, resolve: Resolve, folder: str) -> Part:
    """Reads a module.  folder: address of all modules, with a slash at its end."""
    return _Reader(name, code, resolve, folder).read()


def _single_signs(code: str) -> Iterator[tuple[str, str]]:
    for kind, text in parts(code):
        yield from ((kind, each) for each in (text if kind == "sign" else [text]))


class _Reader:
    def __init__(self, name: str, code: str, resolve: Resolve, folder: str) -> None:
        self._part = Part(name)
        self._words = list(_single_signs(code))
        self._resolve, self._folder = resolve, folder
        self._place = 0
        self._lines = 0  # of what is being replaced
        self._depth = 0
        self._begun = False  # something other than an import has been read

    def read(self) -> Part:
        written: list[str] = []
        before = ""
        while self._place < len(self._words):
            kind, text = self._words[self._place]
            if kind == "word" and before != "." and text in ("import", "export"):
                self._lines = 0
                text = self._importing() if text == "import" else self._exporting()
                written.append(text + "\n" * self._lines)
                before = ";"
                continue
            self._place += 1
            written.append(self._own(kind, text))
            before = before if kind in BESIDE else text
        self._part.code = "".join(written)
        return self._part

    def _own(self, kind: str, text: str) -> str:
        if text == MODULES:
            raise self._refused(f"the name {MODULES} is taken")
        if kind == "sign":
            self._depth += DEPTH.get(text, 0)
        self._begun = self._begun or (kind not in BESIDE and text != ";")
        return text

    def _importing(self) -> str:
        self._take()
        if self._next() == ".":
            return "import"
        if self._next() == "(":
            return self._loading()
        if self._begun or self._depth:
            raise self._refused("an import after other code; all imports come first")
        return self._taken(self._clause(), kept(self._imported()))

    def _loading(self) -> str:
        opened, address = self._take(), self._take()
        if address[0] not in "\"'" or self._next() != ")":
            raise self._refused(f"import{opened}{address}…; what is loaded later is named by a text")
        self._depth += 1  # its end is read as code
        self._part.later.append(self._resolve(address[1:-1]))
        return f"import({json.dumps(self._folder + self._part.later[-1])}"

    def _taken(self, clause: str, source: str) -> str:
        """What an import is in a function: constants, since what is imported has been made and does not change."""
        if not clause:
            return ""
        own, _, rest = (None, "", clause) if clause[0] in "{*" else clause.partition(",")
        declared = [f"{own.strip()}={source}.default"] if own else []
        rest = rest.strip()
        if whole := re.fullmatch(r"\* as ([\w$]+)", rest):
            declared.append(f"{whole[1]}={source}")
        elif rest:
            names = ",".join(name if name == new else f"{name}:{new}" for name, new in self._listed(rest))
            declared.append(f"{{{names}}}={source}")
        return f"const {','.join(declared)};"

    def _exporting(self) -> str:
        self._take()
        self._begun = True
        if self._depth:
            raise self._refused("an export within something else")
        if self._next() in "{*":
            self._exports_list()
            return ";"
        if self._next() == "default":
            return self._exports_default()
        self._exports_declared()
        return ""

    def _exports_list(self) -> None:
        clause = self._clause()
        name = self._imported() if self._next()[:1] in ("'", '"') else None
        source = "" if name is None else f"{kept(name)}."
        if clause == "*" and name is not None:
            self._part.passed_on.append(name)
        else:
            self._part.exports |= {new: source + own for own, new in self._listed(clause)}

    def _exports_default(self) -> str:
        self._take()
        ahead = self._ahead()
        if ahead[0] in ("async", "class") or (ahead[0] == "function" and ahead[1] != "("):
            raise self._refused("a default export that has a name, or is a class, or async")
        self._part.exports["default"] = DEFAULT
        return f"const {DEFAULT}="

    def _exports_declared(self) -> None:
        """Notes the names; the declaration itself is read as code like any other."""
        ahead = self._ahead()
        if ahead[0] not in DECLARING:
            raise self._refused(f"export {ahead[0]}; a constant, function, class or list can be exported")
        place = next(place for place, text in enumerate(ahead) if text not in DECLARING)
        pattern = ahead[place : ahead.index("}") + 1] if ahead[place] == "{" else []
        listed = self._listed(" ".join(pattern).replace(" : ", " as ")) if pattern else [("", ahead[place])]
        if not re.fullmatch(r"[\w$]+", listed[0][1]):
            raise self._refused(f"export {' '.join(ahead[: place + 3])}…")
        if ahead[0] == "const":
            self._is_one_constant(ahead)
        self._part.exports |= {name: name for _, name in listed}

    def _is_one_constant(self, ahead: list[str]) -> None:
        depth = 0
        for text in ahead:
            depth += DEPTH.get(text, 0)
            if depth == 0 and text in (";", "import", "export"):
                return
            if depth == 0 and text == ",":
                raise self._refused("several constants in one export; export each by itself")

    def _listed(self, clause: str) -> list[tuple[str, str]]:
        """(name, new name) of each in `{ a , b as c }`."""
        names = [each.strip() for each in clause.strip("{ }").split(",") if each.strip()]
        found = [LISTED.fullmatch(each) for each in names]
        if clause[0] != "{" or clause[-1] != "}" or None in found:
            raise self._refused(clause)
        return [(each[1], each[2] or each[1]) for each in found if each is not None]

    def _imported(self) -> str:
        name = self._resolve(self._take()[1:-1])
        if self._next() in ("with", "assert"):
            raise self._refused("an import of something else than a module")
        self._part.imports.append(name)
        return name

    def _clause(self) -> str:
        """The words from here to `from` or, in a list of the module's own names, to its closing brace."""
        words: list[str] = []
        while self._next()[:1] not in ("'", '"', ";", "") and words[-1:] != ["from"]:
            if words[-1:] == ["}"] and self._next() != "from":
                break
            words.append(self._take())
        return " ".join(words[:-1] if words[-1:] == ["from"] else words)

    def _ahead(self) -> list[str]:
        return [text for kind, text in self._words[self._place :] if kind not in BESIDE]

    def _next(self) -> str:
        """The next word or sign, "" at the end; what is beside the code before it is passed."""
        while self._place < len(self._words) and self._words[self._place][0] in BESIDE:
            self._lines += self._words[self._place][1].count("\n")
            self._place += 1
        return self._words[self._place][1] if self._place < len(self._words) else ""

    def _take(self) -> str:
        text = self._next()
        self._place += 1
        return text

    def _refused(self, what: str) -> NotUnderstood:
        line = 1 + sum(text.count("\n") for _, text in self._words[: self._place])
        return NotUnderstood(f"{self._part.name}:{line}: the page cannot be joined with this: {what}")
