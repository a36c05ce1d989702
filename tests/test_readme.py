"""What the README tells people to type works as it stands."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from control.studies.checking import survey
from control.studies.definition import StudyDefinition
from server.rig_file import load_rig_file
from server.settings import RigFile
from tests.processes import served

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


def commands(beginning: str) -> list[str]:
    lines = "\n".join(blocks("sh")).splitlines()
    return [line.split("#")[0].strip() for line in lines if line.startswith(beginning)]


@pytest.mark.parametrize("line", commands("pivotrig run "))
def test_each_run_of_the_readme_works(line: str) -> None:
    command = [sys.executable, "-m", "server", *shlex.split(line)[1:], "--duration", "3"]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert answer.returncode == 0, answer.stderr


@pytest.mark.parametrize("line", commands("pivotrig runs "))
def test_each_look_at_the_runs_of_the_readme_works(line: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "server", *shlex.split(line)[1:], "--data", str(tmp_path)]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert answer.returncode == 0, answer.stderr


def test_the_script_of_the_readme_works(tmp_path: Path) -> None:
    (script,) = (block for block in blocks("python") if "httpx" in block)
    with served(tmp_path, "--sim") as server:
        server.until(lambda state: state["tracking"] == "locked" and not state["faults"])
        here = script.replace("http://127.0.0.1:8000", server.address)
        answer = subprocess.run(
            [sys.executable, "-c", here], capture_output=True, text=True, timeout=60, check=False
        )
        assert answer.returncode == 0, answer.stderr
        assert "x_mm" in answer.stdout
        assert server.get("/state")["rig"] == "fault"


def test_what_the_readme_asks_with_curl_is_answered(tmp_path: Path) -> None:
    whole = "\n".join(blocks("sh")).replace("\\\n", " ").splitlines()
    asked = [line.split("   #")[0] for line in whole if line.startswith("curl ")]
    assert len(asked) >= 8
    with served(tmp_path, "--sim") as server:
        server.until(lambda state: state["tracking"] == "locked" and not state["faults"])
        for line in asked:
            here = line.replace("localhost:8000", server.address) + " --fail-with-body"
            answer = subprocess.run(
                ["bash", "-c", here], capture_output=True, text=True, timeout=60, check=False
            )
            assert answer.returncode == 0, line + answer.stdout


def test_the_rig_file_of_the_readme_is_valid(tmp_path: Path) -> None:
    (text,) = (block for block in blocks("toml") if "[limits]" in block)
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text(text)
    assert load_rig_file(rig_file).name == "Bench 2"


def test_the_study_of_the_readme_can_be_carried_out() -> None:
    (text,) = (block for block in blocks("toml") if "[[axes]]" in block)
    found = survey(StudyDefinition.from_toml(text))
    assert (found.sets, found.runs, list(found.problems)) == (21, 210, [])


def test_the_example_rig_file_shows_every_default() -> None:
    example = load_rig_file(ROOT / "rig.example.toml")
    assert example == RigFile()
    text = (ROOT / "rig.example.toml").read_text(encoding="utf-8")
    for section in RigFile().model_dump().values():
        if isinstance(section, dict):
            assert all(f"{name} =" in text or f".{name}]" in text or f".{name}." in text for name in section)


def test_the_make_targets_of_the_readme_exist() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in set(re.findall(r"make ([a-z-]+)", README)) - {"it"}:
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
