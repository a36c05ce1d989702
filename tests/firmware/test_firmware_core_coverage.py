"""The differential tests reach all of the firmware's core."""

from __future__ import annotations

from pathlib import Path

from core_coverage import measured


def test_every_line_and_branch_of_the_core_is_compared_with_the_twin(tmp_path: Path) -> None:
    coverage = measured(tmp_path)
    assert coverage.branches > 100
    assert not coverage.missed, "\n".join(coverage.missed)
