"""Row 33: a campaign whose program comes to an end in the middle of a run."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from control.studies.definition import StudyDefinition
from server.studies.study import RESULTS, Study
from tests.server.campaign_bench import HERE, SHORT, CampaignBench, indices

PATIENCE = 200.0
"""Seconds that a program may take to start and to walk two short runs, on a computer that has much else to do."""


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[CampaignBench]:
    bench = CampaignBench(tmp_path)
    yield bench
    bench.close()


@contextmanager
def walking(bench: CampaignBench, runs: int, **changes: Any) -> Iterator[subprocess.Popen[bytes]]:
    """`pivotrig study` on the simulated rig, once so many runs of it have begun."""
    definition = StudyDefinition.from_json({**SHORT, **HERE, **changes})
    file = bench.data / "study.toml"
    file.write_text(definition.to_toml(), encoding="utf-8")
    command = [sys.executable, "-m", "server", "study", str(file), "--data", str(bench.data), "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        try:
            _wait(
                process, lambda: max((len(bench.runs(each)) for each in bench.store.all()), default=0) >= runs
            )
            yield process
        finally:
            process.kill()


def _wait(process: subprocess.Popen[bytes], condition: Callable[[], bool]) -> None:
    give_up = time.monotonic() + PATIENCE
    while not condition():
        assert process.poll() is None, "the campaign is over"
        assert time.monotonic() < give_up
        time.sleep(0.1)


def the_study(bench: CampaignBench) -> Study:
    (study,) = bench.store.all()
    return study


def test_a_killed_campaign_goes_on_with_the_run_that_was_on(bench: CampaignBench) -> None:
    """When the program dies, finished runs stay as they are; resumed, the study goes on with the others."""
    with walking(bench, runs=2) as process:
        process.kill()
        process.wait(10)
    study = the_study(bench)
    assert study.state == "interrupted"
    kept = (study.folder / RESULTS).read_bytes()
    assert kept.count(b"\n") >= 1
    outcome, sitting = bench.sit(study)
    assert outcome.state == "finished"
    assert len(sitting.starts) <= 2
    assert (study.folder / RESULTS).read_bytes().startswith(kept)
    assert indices(study.rows()) == [0, 1, 2]
    assert sorted(run.settings["study_run"] for run in bench.runs(study, "finished")) == [0, 1, 2]


def test_a_campaign_that_is_told_to_end_stops_the_coils_and_can_be_resumed(bench: CampaignBench) -> None:
    with walking(bench, runs=1, duration_s=20.0) as process:
        process.terminate()
        answer, _ = process.communicate(timeout=PATIENCE)
        assert b'"interrupted"' in answer
    study = the_study(bench)
    assert (study.state, study.reason) == ("interrupted", "the program was ended")
    assert study.rows() == []
    (run,) = bench.runs(study)
    assert run.state == "aborted"
