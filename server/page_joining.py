"""The modules that a part of the page needs, as one: a browser that asks for each by itself waits for each.

Each module becomes a function that is called once, after those of all that it imports, and what it exports is kept by
its name. A part that is loaded later brings only what the page has not begun with, and finds the rest as it is. Every
line stays a line of its own, and a source map tells a browser's tools which.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass

from server.page_imports import MODULES, NotUnderstood, Part, kept, part_of


@dataclass(frozen=True, slots=True)
class Join:
    """text: of the joined module.  begins: at which line each of its modules begins, from zero, by its name."""

    text: str
    begins: dict[str, int]

    def source_map(self, sources: Callable[[str], str]) -> str:
        """Says of each line which line of which file it is (ECMA-426).  sources: the files as they are written."""
        sections = [
            {"offset": {"line": line, "column": 0}, "map": _line_by_line(name, sources(name))}
            for name, line in self.begins.items()
        ]
        return json.dumps({"version": 3, "sections": sections}, ensure_ascii=False)


def _line_by_line(name: str, source: str) -> dict[str, object]:
    mappings = "AAAA" + ";AACA" * source.count("\n")
    return {"version": 3, "sources": [name], "sourcesContent": [source], "names": [], "mappings": mappings}


class Joiner:
    """Joins modules, which have names within one folder.

    code: what a browser would get of a module.  resolve: (address, importing module) → name.  entry: what the page
    begins with.  folder: address of all modules, with a slash at its end.
    """

    def __init__(
        self, code: Callable[[str], str], resolve: Callable[[str, str], str], entry: str, folder: str
    ) -> None:
        self._code, self._resolve = code, resolve
        self._entry, self._folder = entry, folder
        self._parts: dict[str, Part] = {}

    def part(self, name: str) -> Part:
        if name not in self._parts:
            code = self._code(name)
            self._parts[name] = part_of(name, code, lambda each: self._resolve(each, name), self._folder)
        return self._parts[name]

    def needed(self, name: str) -> list[str]:
        """Names of all modules that `name` cannot be without: each after those that it imports, itself last."""
        found: dict[str, None] = {}
        self._find(name, (), found)
        return list(found)

    def _find(self, name: str, importers: tuple[str, ...], found: dict[str, None]) -> None:
        if name in importers:
            circle = " imports ".join([*importers[importers.index(name) :], name])
            raise NotUnderstood(f"{circle}: what they share belongs in a module of its own")
        if name not in found:
            for each in self.part(name).imports:
                self._find(each, (*importers, name), found)
            found[name] = None

    def loaded_later(self) -> list[str]:
        """Names of the modules that some part of the page loads when they are needed."""
        found = [self._entry]
        for name in found:
            later = [each for own in self.needed(name) for each in self.part(own).later]
            found += [each for each in dict.fromkeys(later) if each not in found]
        return found[1:]

    def join(self, name: str) -> Join:
        """The module `name` with all that it needs and that the page has not begun with."""
        begun = set() if name == self._entry else set(self.needed(self._entry))
        texts, begins = [self._head(name)], dict[str, int]()
        lines = 1
        for each in self.needed(name):
            if each not in begun:
                begins[each] = lines + 1
                texts.append(self._wrapped(self.part(each)))
                lines += texts[-1].count("\n") + 1
        texts.append(self._exported_again(name))
        return Join("\n".join(texts) + f"\n//# sourceMappingURL={name.rpartition('/')[2]}.map\n", begins)

    def _head(self, name: str) -> str:
        if name == self._entry:
            return f"export const {MODULES}={{__proto__:null}};"
        return f"import{{{MODULES}}}from{json.dumps(self._folder + self._entry)};"

    def _wrapped(self, part: Part) -> str:
        exports = "".join(f",{each}:{value}" for each, value in self._exports(part).items())
        return f"{kept(part.name)}??=(()=>{{\n{part.code}\nreturn Object.freeze({{__proto__:null{exports}}})}})();"

    def _exports(self, part: Part) -> dict[str, str]:
        passed = {
            each: f"{kept(other)}.{each}"
            for other in part.passed_on
            for each in self._exports(self.part(other))
            if each != "default"
        }
        return passed | part.exports

    def _exported_again(self, name: str) -> str:
        names = list(self._exports(self.part(name)))
        if name == self._entry and names:
            raise NotUnderstood(
                f"{name} exports {', '.join(names)}, but nobody imports what a page begins with"
            )
        taken = ",".join(f"{each}:$_{place}" for place, each in enumerate(names))
        given = ",".join(f"$_{place} as {each}" for place, each in enumerate(names))
        return f"const{{{taken}}}={kept(name)};export{{{given}}};" if names else ""
