"""What protects people and coils is tested line by line and branch by branch."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.timeout(200)
def test_every_line_and_branch_of_limiter_arbiter_and_framing_is_tested(tmp_path: Path) -> None:
    """The files and their tests are those that `make mutate` takes."""
    mutmut = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["mutmut"]
    files, tests = mutmut["only_mutate"], mutmut["pytest_add_cli_args_test_selection"]
    coverage = [sys.executable, "-m", "coverage"]
    data = f"--data-file={tmp_path / 'data'}"
    pytest_run = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *tests]
    run = [*coverage, "run", "--branch", data, f"--include={','.join(files)}", *pytest_run]
    tried = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert tried.returncode == 0, tried.stdout[-3000:]
    report = tmp_path / "report.json"
    subprocess.run([*coverage, "json", data, "-q", "-o", str(report)], cwd=ROOT, check=True)
    figures = json.loads(report.read_text(encoding="utf-8"))["files"]
    assert sorted(figures) == sorted(files)
    missing = {
        name: (found["missing_lines"], found["missing_branches"])
        for name, found in figures.items()
        if found["missing_lines"] or found["missing_branches"]
    }
    assert not missing, f"untested lines and branches: {missing}"
