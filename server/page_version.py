"""The files of the page as one version: all of them from the same moment, under addresses that name it.

A browser may keep them for ever, and a page that was opened before an upgrade never gets a module of the new one:
what it asks for under the old name is not there, and it says that it must be reloaded.
"""

from __future__ import annotations

import gzip
import hashlib
import re
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path, PurePosixPath
from posixpath import normpath

from server.page_imports import NotUnderstood
from server.page_joining import Joiner
from server.page_text import code_alone

STATIC = "/static/"
"""Where the page's files are, in addresses that the page itself is written with."""

ENTRY = "main.js"
SHEET = "page.css"
"""All style sheets of the page, in their order; none of its files has this name."""

NOT_OF_THE_PAGE = ("vendor/swagger",)
"""Has a page of its own, and is larger than all the rest."""

MEDIA_TYPES = {
    ".js": "text/javascript; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".svg": "image/svg+xml",
    ".map": "application/json",
}
"""What is part of the page, by the end of its name."""

MODULE_ENDINGS = (".js", ".mjs")
MAP_ENDING = ".map"
STAMP_LENGTH = 12
SHEET_LINK = re.compile(r' *<link rel="stylesheet" href="/static/[0-9a-f]+/([^"]+)">\n')


@dataclass(frozen=True, slots=True)
class PageFile:
    content: bytes
    compressed: bytes
    media_type: str


def stamp_of(folder: Path) -> str:
    """The name of the version in `folder`: another one whenever a file of the page has changed."""
    digest = hashlib.sha256()
    for name, path in page_paths(folder):
        status = path.stat()
        digest.update(f"{name}\0{status.st_size}\0{status.st_mtime_ns}\n".encode())
    return digest.hexdigest()[:STAMP_LENGTH]


def page_paths(folder: Path) -> list[tuple[str, Path]]:
    """(name with slashes, path) of each file of the page, in the order of the names."""
    found = ((path.relative_to(folder).as_posix(), path) for path in folder.rglob("*"))
    return sorted(
        (name, path)
        for name, path in found
        if path.suffix in MEDIA_TYPES and not name.startswith(NOT_OF_THE_PAGE)
    )


@lru_cache(maxsize=2)
def version_of(folder: Path, stamp: str) -> PageVersion:
    """Made once for all applications of a process, with what a page asks for first ready to be sent."""
    version = PageVersion(folder, stamp)
    for name in (ENTRY, SHEET, *version.loaded_later()):
        version.file(name)
    return version


class PageVersion:
    """All files of the page, read at once; every address in them that begins with /static/ names the version.

    Each module is sent with all that it needs and that the page has not begun with (`server/page_joining.py`).
    """

    def __init__(self, folder: Path, stamp: str) -> None:
        self.stamp = stamp
        self._own = f"{STATIC}{stamp}/"
        self._texts = {
            name: path.read_text(encoding="utf-8").replace(f'"{STATIC}', f'"{self._own}')
            for name, path in page_paths(folder)
        }
        self._joiner = Joiner(self._code, self._name_of, ENTRY, self._own)
        self._files: dict[str, PageFile] = {}

    def file(self, name: str) -> PageFile | None:
        """What is sent under a name in the folder; made and compressed when it is first asked for."""
        if name not in self._files and (text := self._sent(name)) is not None:
            content = text.encode()
            media_type = MEDIA_TYPES[PurePosixPath(name).suffix]
            self._files[name] = PageFile(content, gzip.compress(content, mtime=0), media_type)
        return self._files.get(name)

    def _sent(self, name: str) -> str | None:
        module = name.removesuffix(MAP_ENDING)
        if module in self._texts and module.endswith(MODULE_ENDINGS):
            join = self._joiner.join(module)
            return join.text if module == name else join.source_map(self._texts.__getitem__)
        if name == SHEET:
            return "\n".join(self._texts[each] for each in SHEET_LINK.findall(self._texts["index.html"]))
        return self._texts.get(name)

    @cached_property
    def index(self) -> bytes:
        """The page itself, which asks for one style sheet in the place of the first of those that it names."""
        link = f'    <link rel="stylesheet" href="{self._own}{SHEET}">\n'
        page = SHEET_LINK.sub(link, self._texts["index.html"], count=1)
        kept, found, rest = page.partition(link)
        return (kept + found + SHEET_LINK.sub("", rest)).encode()

    def modules(self, entry: str = ENTRY) -> list[str]:
        """Names of all modules that `entry` needs at once, each after those that it imports."""
        return self._joiner.needed(entry)

    def loaded_later(self) -> list[str]:
        """Names of the modules that a page may ask for after it has begun."""
        return self._joiner.loaded_later()

    def _code(self, name: str) -> str:
        text = self._texts[name]
        return code_alone(text) if name.endswith(".js") else text

    def _name_of(self, address: str, importer: str) -> str:
        name = address.removeprefix(self._own)
        if name == address:
            name = normpath((PurePosixPath(importer).parent / address).as_posix())
        if name not in self._texts:
            raise NotUnderstood(f"{importer} imports {address!r}, which is no file of the page")
        return name
