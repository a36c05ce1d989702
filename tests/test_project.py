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
