"""The libraries that the program serves to browsers are what their table says, and what their packages hold."""

import json
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
VENDOR = ROOT / "web/vendor"
TOOLS = ROOT / ".ci/javascript"
# | [name](address) | version | licence | `file`, `file` | what for |
ROW = re.compile(r"^\| \[([^]]+)\]\([^)]+\) \| (\S+) \| (\S+) \| ([^|]+) \|", re.MULTILINE)
LIBRARIES = {
    name: (version, licence, files)
    for name, version, licence, files in ROW.findall((VENDOR / "README.md").read_text())
}
# The files of ours, that stand beside those of the libraries.
OURS = {"README.md", "update.sh", "swagger/docs.html", "swagger/start.js"}


def locked() -> dict[str, dict[str, str]]:
    packages = json.loads((TOOLS / "package-lock.json").read_text())["packages"]
    return {name.removeprefix("node_modules/"): about for name, about in packages.items() if name}


def test_each_file_is_what_its_package_holds() -> None:
    check = ["bash", str(VENDOR / "update.sh"), "--check"]
    answer = subprocess.run(check, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr


@pytest.mark.parametrize("name", LIBRARIES)
def test_the_table_says_the_version_and_the_licence_of_the_package(name: str) -> None:
    version, licence, _ = LIBRARIES[name]
    about = locked()[name]
    assert (version, licence) == (about["version"], about["license"])


@pytest.mark.parametrize("name", LIBRARIES)
def test_the_licence_lies_beside_each_library(name: str) -> None:
    files = [VENDOR / file for file in re.findall("`([^`]+)`", LIBRARIES[name][2])]
    assert files
    assert all(file.is_file() for file in files)
    for folder in {file.parent for file in files}:
        assert (
            "Copyright" in (folder / "LICENSE").read_text() or "copyright" in (folder / "LICENSE").read_text()
        )


def test_nothing_is_served_that_the_table_does_not_name() -> None:
    named = {file for _, _, files in LIBRARIES.values() for file in re.findall("`([^`]+)`", files)}
    texts = {"LICENSE", "NOTICE", "swagger-ui-bundle.js.LICENSE.txt"}
    there = {str(path.relative_to(VENDOR)) for path in VENDOR.rglob("*") if path.is_file()}
    extra = {path for path in there - named - OURS if Path(path).name not in texts and ".d." not in path}
    assert extra == set()


def test_what_checks_the_page_is_pinned_by_hash_and_by_no_particular_registry() -> None:
    for name, about in locked().items():
        assert about["integrity"].startswith("sha512-"), name
        assert "resolved" not in about, name
    wanted = json.loads((TOOLS / "package.json").read_text())["devDependencies"]
    assert all(re.fullmatch(r"\d+\.\d+\.\d+", version) for version in wanted.values()), wanted
    assert {name: locked()[name]["version"] for name in wanted} == wanted
