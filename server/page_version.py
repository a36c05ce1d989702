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

from server.page_text import code_alone

STATIC = "/static/"
"""Where the page's files are, in addresses that the page itself is written with."""

ENTRY = "main.js"
NOT_OF_THE_PAGE = ("vendor/swagger",)
"""Has a page of its own, and is larger than all the rest."""

MEDIA_TYPES = {
    ".js": "text/javascript; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".svg": "image/svg+xml",
}
"""What is part of the page, by the end of its name."""

STAMP_LENGTH = 12
IMPORT = re.compile(r"""^(?:import|export)\b[^"';()]*["']([^"']+)["']""", re.MULTILINE)
"""A static import; an `import()` is loaded later, when it is needed."""


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
    for name in version.modules():
        version.file(name)
    return version


class PageVersion:
    """All files of the page, read at once; every address in them that begins with /static/ names the version."""

    def __init__(self, folder: Path, stamp: str) -> None:
        self.stamp = stamp
        self._texts = {
            name: path.read_text(encoding="utf-8").replace(f'"{STATIC}', f'"{STATIC}{stamp}/')
            for name, path in page_paths(folder)
        }
        self._files: dict[str, PageFile] = {}

    def file(self, name: str) -> PageFile | None:
        """A file by its name in the folder; compressed when it is first asked for."""
        if name not in self._files and name in self._texts:
            text = self._texts[name]
            content = (code_alone(text) if name.endswith(".js") else text).encode()
            media_type = MEDIA_TYPES[PurePosixPath(name).suffix]
            self._files[name] = PageFile(content, gzip.compress(content, mtime=0), media_type)
        return self._files.get(name)

    @cached_property
    def index(self) -> bytes:
        """The page itself, which announces all modules that it begins with: none waits until another names it."""
        links = "".join(
            f'    <link rel="modulepreload" href="{STATIC}{self.stamp}/{name}">\n' for name in self.modules()
        )
        head, end, rest = self._texts["index.html"].partition("  </head>")
        return (head + links + end + rest).encode()

    def modules(self, entry: str = ENTRY) -> list[str]:
        """Names of all modules that `entry` imports, directly or not, those nearest to it first."""
        found = [entry]
        for name in found:
            asked = (self._name_of(each, name) for each in IMPORT.findall(self._texts.get(name, "")))
            found += [each for each in dict.fromkeys(asked) if each not in found]
        return [name for name in found if name in self._texts]

    def _name_of(self, address: str, importer: str) -> str:
        own = f"{STATIC}{self.stamp}/"
        if address.startswith(own):
            return address.removeprefix(own)
        return normpath((PurePosixPath(importer).parent / address).as_posix())
