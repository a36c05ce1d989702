"""The files of the page as one version."""

from __future__ import annotations

import gzip
import os
import re
from pathlib import Path

import httpx
import pytest
from starlette.applications import Starlette
from starlette.routing import Mount, Route

import web
from server.fresh_files import FreshFiles
from server.page_text import code_alone
from server.page_version import PageVersion, stamp_of

pytestmark = pytest.mark.anyio

PAGE = '<html>\n  <head>\n    <script type="module" src="/static/main.js"></script>\n  </head>\n</html>\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "index.html").write_text(PAGE)
    (tmp_path / "main.js").write_text(
        'import { a } from "./part/a.js";\nconst later = () => import("./later.js");\n'
    )
    (tmp_path / "later.js").write_text("export const later = 1;\n")
    (tmp_path / "part").mkdir()
    (tmp_path / "part" / "a.js").write_text(
        'import {\n  b,\n} from "/static/b.mjs";\nexport * from "../c.js";\nexport const a = b;\n'
    )
    (tmp_path / "b.mjs").write_text('import{c}from"./c.js";export const b = c;\n')
    (tmp_path / "c.js").write_text('/** import of "nothing.js" */\nexport const c = "from";\n')
    return tmp_path


@pytest.fixture
def client(folder: Path) -> httpx.AsyncClient:
    files = FreshFiles(folder)
    app = Starlette(routes=[Route("/", files.page), Mount("/static", files)])
    return httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://rig")


def change(file: Path) -> None:
    file.write_text(file.read_text() + "export const newer = 1;\n")
    os.utime(file, ns=(file.stat().st_atime_ns, file.stat().st_mtime_ns + 1))


def test_another_content_is_another_version_and_the_same_is_the_same(folder: Path) -> None:
    before = stamp_of(folder)
    assert stamp_of(folder) == before
    change(folder / "part" / "a.js")
    assert stamp_of(folder) != before


def test_what_is_imported_at_once_comes_with_the_first_module_and_what_is_loaded_later_does_not(
    folder: Path,
) -> None:
    version = PageVersion(folder, "0123456789ab")
    assert version.modules() == ["c.js", "b.mjs", "part/a.js", "main.js"]
    assert version.loaded_later() == ["later.js"]
    assert re.findall(r'/static/[^"]+', version.index.decode()) == ["/static/0123456789ab/main.js"]
    first = version.file("main.js")
    assert first is not None
    assert re.findall(r'modules\["([^"]+)"\]\?\?=', first.content.decode()) == version.modules()


def test_each_module_of_the_dashboard_finds_the_modules_that_it_imports() -> None:
    folder = Path(web.__file__).parent
    version = PageVersion(folder, stamp_of(folder))
    names = version.modules()
    assert {"main.js", "store.js", "vendor/preact/preact.mjs"} <= set(names)
    assert all(version.file(name) is not None for name in names)
    assert '"/static/' not in version.index.decode().replace(f'"/static/{version.stamp}/', "")


async def test_the_files_of_a_version_are_kept_for_good_and_come_compressed(
    folder: Path, client: httpx.AsyncClient
) -> None:
    page = await client.get("/")
    assert page.headers["cache-control"] == "no-cache"
    assert (await client.get("/", headers={"If-None-Match": page.headers["etag"]})).status_code == 304
    address = re.findall(r'src="([^"]+)"', page.text)[0]
    answer = await client.get(address)
    sent = PageVersion(folder, stamp_of(folder)).file("main.js")
    assert sent is not None
    assert answer.content == sent.content
    assert code_alone((folder / "c.js").read_text()).replace("export ", "") in answer.text
    assert "immutable" in answer.headers["cache-control"]
    assert answer.headers["content-encoding"] == "gzip"
    plain = await client.get(address, headers={"Accept-Encoding": "identity"})
    assert plain.text == answer.text
    assert "content-encoding" not in plain.headers


async def test_a_page_from_before_an_upgrade_gets_no_module_of_the_new_one(
    folder: Path, client: httpx.AsyncClient
) -> None:
    old = re.findall(r'src="([^"]+)main.js"', (await client.get("/")).text)[0]
    assert (await client.get(f"{old}later.js")).status_code == 200
    change(folder / "b.mjs")
    new = re.findall(r'src="([^"]+)main.js"', (await client.get("/")).text)[0]
    assert new != old
    refused = await client.get(f"{old}later.js")
    assert refused.status_code == 404
    assert refused.headers["cache-control"] == "no-store"
    assert "reload" in refused.text
    assert "newer = 1" in (await client.get(f"{new}main.js")).text


async def test_a_module_that_cannot_be_sent_is_told_of_and_open_pages_keep_theirs(
    folder: Path, client: httpx.AsyncClient
) -> None:
    old = re.findall(r'src="([^"]+)main.js"', (await client.get("/")).text)[0]
    (folder / "c.js").write_text("export let c = 1;\n")
    told = await client.get("/")
    assert (told.status_code, told.headers["cache-control"]) == (500, "no-store")
    assert "c.js:1" in told.text
    assert "export let" in told.text
    assert (await client.get(f"{old}later.js")).status_code == 200
    (folder / "c.js").write_text("export const c = 1;\n")
    assert (await client.get("/")).status_code == 200


async def test_nothing_beside_the_page_is_served_as_part_of_it(
    folder: Path, client: httpx.AsyncClient
) -> None:
    (folder.parent / "secret.js").write_text("secret")
    stamp = re.findall(r'src="([^"]+)main.js"', (await client.get("/")).text)[0]
    for path in (
        f"{stamp}../secret.js",
        f"{stamp}%2e%2e/%2e%2e/secret.js",
        f"{stamp}nothing.js",
        "/static/nothing.js",
    ):
        assert (await client.get(path)).status_code == 404


async def test_a_file_by_its_plain_name_is_asked_about_each_time(client: httpx.AsyncClient) -> None:
    answer = await client.get("/static/c.js")
    assert answer.headers["cache-control"] == "no-cache"
    assert (
        await client.get("/static/c.js", headers={"If-None-Match": answer.headers["etag"]})
    ).status_code == 304


def test_a_compressed_file_is_the_file(folder: Path) -> None:
    file = PageVersion(folder, "0123456789ab").file("later.js")
    assert file is not None
    assert gzip.decompress(file.compressed) == file.content
