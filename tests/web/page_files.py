"""What the page is made of: the modules that a browser comes to from `index.html`, by their imports."""

import re
from pathlib import Path

WEB = Path(__file__).parents[2] / "web"
START = WEB / "main.js"
LOGIN = WEB / "login" / "login.js"
"""The only module of a page of its own, for who has yet to show a token."""
# `import … from "x"`, `export … from "x"` and `import "x"`; and, anywhere, `import("x")`.
STATED = re.compile(r"""^(?:import|export)\b(?:[^;"'`]*?\bfrom)?\s*["']([^"'\n]+)["']""", re.MULTILINE)
LATER = re.compile(r"""\bimport\(\s*["']([^"'\n]+)["']""")
COMMENT = re.compile(r"/\*.*?\*/|^\s*//.*?$", re.DOTALL | re.MULTILINE)


def imports_of(module: Path) -> list[str]:
    """The names that a module imports, as they are written."""
    text = COMMENT.sub("", module.read_text())
    return STATED.findall(text) + LATER.findall(text)


def file_of(name: str, importer: Path) -> Path:
    """The file that a name means in a browser; ValueError for one that this program does not serve."""
    if name.startswith("/static/"):
        return WEB / name.removeprefix("/static/")
    if name.startswith("."):
        return (importer.parent / name).resolve()
    raise ValueError(
        f"{importer.relative_to(WEB)} imports {name!r}, which is neither relative nor below /static/"
    )


def page_modules() -> set[Path]:
    """Every module that the page may load, now or later; also those that are not there."""
    known: set[Path] = set()
    waiting = [START]
    while waiting:
        module = waiting.pop()
        if module in known:
            continue
        known.add(module)
        if module.is_file():
            waiting.extend(file_of(name, module) for name in imports_of(module))
    return known


def own_modules() -> set[Path]:
    """The page's modules in the folder, without the libraries."""
    return {path for path in WEB.rglob("*.js") if "vendor" not in path.relative_to(WEB).parts}
