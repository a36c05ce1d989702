"""The house rules that a machine can check."""

import subprocess
import sys
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest

import server.environment as environment

ROOT = Path(__file__).parent.parent


def test_the_folders_import_only_what_they_may() -> None:
    lint = Path(sys.executable).with_name("lint-imports")
    answer = subprocess.run([lint], cwd=ROOT, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stdout


@pytest.mark.parametrize("package", ["control", "vision", "server", "web"])
def test_the_folders_are_import_packages(package: str) -> None:
    assert (ROOT / package / "__init__.py").is_file()


def test_no_folder_is_named_after_nothing() -> None:
    names = {path.stem for folder in ("control", "vision", "server") for path in (ROOT / folder).rglob("*")}
    assert not names & {"utils", "helpers", "common", "misc", "core", "manager"}


def test_another_package_called_control_is_named_at_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(environment, "distribution", lambda _: distribution("numpy"))
    with pytest.raises(SystemExit, match="python-control"):
        environment.check_environment()


def test_this_environment_has_no_other_package_called_control() -> None:
    with pytest.raises(PackageNotFoundError):
        distribution("control")
    environment.check_environment()


HEAVY = ["cv2", "scipy", "magpylib", "fastapi", "viser"]
LIGHT = f"import sys, server.cli, server.rig_file; print(*(name for name in {HEAVY} if name in sys.modules))"


def test_what_only_some_commands_need_is_loaded_by_those_alone() -> None:
    """`pivotrig --help` and a look into the rig file take a second, not four."""
    answer = subprocess.run(
        [sys.executable, "-c", LIGHT], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert answer.stdout.split() == []


@pytest.mark.parametrize("order", ["cv2, vision.sources.opening", "vision.sources.opening, cv2"])
def test_opencv_works_in_one_thread_and_says_nothing(order: str) -> None:
    look = f"import {order}; print(cv2.getNumThreads(), cv2.utils.logging.getLogLevel())"
    answer = subprocess.run(
        [sys.executable, "-c", look], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert answer.stdout.split() == ["1", "0"]
