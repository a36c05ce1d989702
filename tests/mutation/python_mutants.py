"""Mutants of the Python that protects people and coils, made and tried by mutmut (configured in pyproject.toml)."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
SCRATCH = ROOT / "mutants"
SURVIVED = 0
"""mutmut notes the exit code of the tests: they passed although the line was changed."""


@dataclass(frozen=True, slots=True)
class Survivor:
    file: str
    function: str
    change: str


def run(workers: int) -> None:
    """Tries every mutant that has not been tried since its function changed; mutmut remembers."""
    log = SCRATCH.with_name("mutants.log")
    command = [sys.executable, "-m", "mutmut", "run", "--max-children", str(workers)]
    with log.open("w", encoding="utf-8") as sink:
        done = subprocess.run(
            command,
            cwd=ROOT,
            stdout=sink,
            stderr=subprocess.STDOUT,
            check=False,
            env={**os.environ, "CI": "true"},
        )
    if done.returncode != 0:
        raise SystemExit(f"mutmut failed; see {log}")


def count() -> int:
    return sum(len(_codes(meta)) for meta in _metas())


def survivors() -> Iterator[Survivor]:
    for meta in _metas():
        for name, code in sorted(_codes(meta).items()):
            if code in (None, SURVIVED) or code == 33:  # 33: no test ever calls it
                yield _survivor(name)


def _metas() -> list[Path]:
    return sorted(SCRATCH.rglob("*.py.meta"))


def _codes(meta: Path) -> dict[str, int | None]:
    return json.loads(meta.read_text(encoding="utf-8"))["exit_code_by_key"]


def _survivor(name: str) -> Survivor:
    command = [sys.executable, "-m", "mutmut", "show", name]
    shown = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    lines = shown.splitlines()
    file = next(line[4:] for line in lines if line.startswith("--- "))
    before = [line[1:].strip() for line in lines if line.startswith("-") and not line.startswith("---")]
    after = [line[1:].strip() for line in lines if line.startswith("+") and not line.startswith("+++")]
    function = re.sub(r"^.*\.(x_|xǁ)|__mutmut_\d+$", "", name).replace("ǁ", ".")
    return Survivor(file, function, f"{' '.join(before)} -> {' '.join(after) or '(nothing)'}")
