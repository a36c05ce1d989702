"""The page as files: what loads what, how large it is, and that all of it comes from us."""

import re

from server.page_version import PageVersion, stamp_of
from tests.web.page_files import LOGIN, START, WEB, imports_of, own_modules, page_modules

LARGEST_PAGE_KB = 250
# A tag that makes the browser ask for something.
ASKS = re.compile(r"""<(?:script|link|img|iframe)\b[^>]*?(?:src|href)="([^"]+)\"""")


def test_every_import_leads_to_a_file_that_is_served() -> None:
    missing = [str(path) for path in page_modules() if not path.is_file()]
    assert missing == []


def test_no_module_lies_about_unused() -> None:
    unused = {str(path.relative_to(WEB)) for path in own_modules() - page_modules() - {LOGIN}}
    assert unused == set()


def test_the_first_page_asks_for_nothing_but_files_of_ours() -> None:
    asked = ASKS.findall((WEB / "index.html").read_text())
    assert f"/static/{START.name}" in asked
    for address in asked:
        assert address.startswith("/static/"), address
        assert (WEB / address.removeprefix("/static/")).is_file(), address


def test_every_stylesheet_is_asked_for() -> None:
    page = (WEB / "index.html").read_text()
    forgotten = [
        path.name for path in (WEB / "styles").glob("*.css") if f"/static/styles/{path.name}" not in page
    ]
    assert forgotten == []


def test_stylesheets_ask_for_nothing() -> None:
    for sheet in WEB.rglob("*.css"):
        if "swagger" in sheet.parts:
            continue
        addresses = re.findall(r"url\(\s*[\"']?([^)\"']+)", sheet.read_text()) + re.findall(
            "@import.*", sheet.read_text()
        )
        assert [each for each in addresses if not each.startswith("data:")] == [], sheet


def test_no_module_names_an_address_elsewhere() -> None:
    """The names of SVG and its kin look like addresses, but nobody asks there."""
    for module in own_modules():
        assert set(re.findall(r"https?://[\w.]+", module.read_text())) <= {"http://www.w3.org"}, module


def test_the_renderer_is_bound_in_one_place() -> None:
    users = [
        path.name
        for path in own_modules()
        if any("preact" in name or "htm/" in name for name in imports_of(path))
    ]
    assert users == ["view.js"]


def test_the_scripts_of_the_page_are_small() -> None:
    """As the server sends them: what a first visit begins with, and all that is ever loaded, each by itself."""
    version = PageVersion(WEB, stamp_of(WEB))
    sent = [START.name, *version.loaded_later()]
    every = {path.relative_to(WEB).as_posix() for path in page_modules() if path.is_file()}
    assert {module for name in sent for module in version.modules(name)} == every
    sizes = {name: len(file.compressed) for name in sent if (file := version.file(name)) is not None}
    assert list(sizes) == sent
    first_kB, every_kB = sizes[START.name] / 1000, sum(sizes.values()) / 1000
    print(f"scripts: {first_kB:.0f} kB at first, {every_kB:.0f} kB in {len(sent)} files with all")
    largest = sorted(((size, name) for name, size in sizes.items()), reverse=True)[:10]
    assert first_kB < every_kB < LARGEST_PAGE_KB, largest
