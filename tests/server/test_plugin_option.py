"""`--plugin`: a third-party controller on the command line."""

import json
import subprocess
import sys
from pathlib import Path

from typer.testing import CliRunner

from server.cli import app

EXAMPLE = Path(__file__).parents[1] / "examples" / "spiral_chaser.py"


def test_the_example_of_the_manual_walks() -> None:
    command = [
        sys.executable,
        "-m",
        "server",
        "run",
        "--plugin",
        str(EXAMPLE),
        "--controller",
        "spiral_chaser",
    ]
    more = ["--set", "controller.lead_s=0.8", "--sweep", "20", "--duration", "20", "--json"]
    answer = subprocess.run([*command, *more], capture_output=True, text=True, timeout=120, check=False)
    assert answer.returncode == 0, answer.stderr
    result = json.loads(answer.stdout)
    assert result["mean_error_mm"] < 3.0
    assert result["steps"] > 5


def test_a_broken_plugin_ends_the_command_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "mine.py"
    path.write_text("import math\nmath.no_such_thing\n")
    for command in (["run", "--json"], ["serve", "--sim", "--data", str(tmp_path)]):
        answer = CliRunner().invoke(app, [*command, "--plugin", str(path)])
        assert answer.exit_code == 2
        words = " ".join(answer.stderr.split())
        assert "mine.py, line 2: AttributeError" in words
        assert "Traceback" not in words
        assert answer.stdout == ""


def test_a_plugin_that_is_not_there_is_named() -> None:
    answer = CliRunner().invoke(app, ["run", "--plugin", "/nowhere/mine.py"])
    assert answer.exit_code == 2
    assert "/nowhere/mine.py" in answer.stderr
