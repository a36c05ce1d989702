"""A study carried out on the complete simulated rig, run by run, with nobody beside it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from control.snapshot import RigState, Snapshot
from server.recording.reading.recording import Recording
from server.studies.campaign.way_back import ID as WAY_BACK
from server.studies.study import RESULTS, Study
from tests.server.campaign_bench import CIRCLE, HERE, CampaignBench, Sitting, indices, off, start_of

GRID = [
    {"of": "gait.tilt_deg", "values": [20, 25, 30]},
    {"of": "gait.sweep_deg", "values": [20, 30, 40]},
]
ONE, TWO = ([{"of": "gait.tilt_deg", "values": values}] for values in ([25], [20, 25]))
WHOLE_EIGHTS = {"trajectory": {"name": "eight"}, "gait": {"path_step_s": 0.3}, "duration_s": None}
"""One each, of 20 s."""


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[CampaignBench]:
    bench = CampaignBench(tmp_path)
    yield bench
    bench.close()


@pytest.mark.timeout(1800)
def test_a_campaign_returns_to_its_start_each_time_though_the_camera_fails_in_the_middle(
    bench: CampaignBench, full: bool
) -> None:
    """Start a campaign and go home. When the camera is unplugged for a while, the run that was on is made again.

    A grid of 3 x 3 x 2 whole eights under `make test-full`, 3 x 2 short walks otherwise.
    """
    real = {**WHOLE_EIGHTS, "axes": GRID, "repeats": 2} if full else {"repeats": 2}
    study, runs = bench.study(name="unattended", **real), 18 if full else 6

    def unplug(sitting: Sitting, snapshot: Snapshot) -> None:
        is_fifth = len(sitting.starts) == 5 and sitting.run
        if is_fifth and snapshot.run is not None and 0.3 <= snapshot.run.elapsed < 0.32:
            sitting.inject("camera_unplugged", duration=2.0)

    outcome, sitting = bench.sit(study, unplug)
    assert (outcome.state, outcome.reason) == ("finished", "")
    rows = study.rows()
    assert [row.state for row in rows] == runs * ["finished"]
    assert sorted(row.attempts for row in rows) == [*((runs - 1) * [1]), 2]
    assert len(sitting.starts) == runs + 1
    for begun in sitting.starts:
        place, turn = off(begun, start_of(study))
        assert place <= 1.0
        assert turn <= 5.0
    assert sitting.driven_while_held == 0, "I3: the coils are off until the camera is back"
    assert sitting.has_said("attempt 1 of 3 failed: no frame")
    _every_run_is_in_the_catalogue(bench, study)


def _every_run_is_in_the_catalogue(bench: CampaignBench, study: Study) -> None:
    rows = {row.run_id: row for row in study.rows()}
    finished, aborted = bench.runs(study, "finished"), bench.runs(study, "aborted")
    assert {run.id for run in finished} == set(rows)
    assert len(aborted) == 1
    for run in finished:
        row = rows[run.id]
        assert run.settings["study_run"] == row.index
        assert run.metrics == row.metrics
        assert run.unattended
        assert run.recording_state == "complete"
        gait = run.selection["gait"]
        assert {axis: gait[axis.removeprefix("gait.")] for axis in row.values} == row.values
    with Recording.open(bench.archive.path_of(aborted[0].id)) as recording:
        assert recording.settings["study"] == study.id
    assert all(run.id != WAY_BACK for run in [*finished, *aborted])


def test_what_is_stopped_in_the_middle_of_a_run_goes_on_with_that_run(bench: CampaignBench) -> None:
    study = bench.study(axes=TWO, **HERE)

    def stop(sitting: Sitting, snapshot: Snapshot) -> None:
        if (
            len(sitting.starts) == 2
            and sitting.run
            and snapshot.run is not None
            and snapshot.run.elapsed > 0.3
        ):
            sitting.stop("stopped by the operator")

    outcome, sitting = bench.sit(study, stop)
    assert (outcome.state, study.state, study.reason) == ("stopped", "stopped", "stopped by the operator")
    assert sitting.machine.loop.state is RigState.DISARMED
    assert sitting.board.drive_is_zero
    before = (study.folder / RESULTS).read_bytes()
    assert before.count(b"\n") == 1
    outcome, sitting = bench.sit(study)
    assert outcome.state == study.state == "finished"
    assert len(sitting.starts) == 1, "one run was finished before"
    assert (study.folder / RESULTS).read_bytes().startswith(before)
    assert indices(study.rows()) == [0, 1]
    assert len(bench.runs(study, "finished")) == 2


def test_a_finished_run_whose_row_was_lost_in_a_crash_is_not_walked_again(bench: CampaignBench) -> None:
    """The program may die after the catalogue knows of a run's end and before the study's table does."""
    study = bench.study(axes=ONE, **HERE)
    bench.sit(study)
    path, runs = study.folder / RESULTS, bench.runs(study)
    whole = path.read_bytes()
    lines = whole.splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:-1]) + lines[-1][:20])
    outcome, sitting = bench.sit(study)
    assert outcome.state == "finished"
    assert path.read_bytes() == whole
    assert bench.runs(study) == runs
    assert sitting.starts == []


def test_a_run_that_never_comes_to_its_end_fails_and_the_other_is_walked(bench: CampaignBench) -> None:
    study = bench.study(axes=TWO, **HERE, rig={"rest_s": 0.1, "attempts": 2})
    afflicted: list[str] = []

    def hide(sitting: Sitting, _: Snapshot) -> None:
        if sitting.run and len(sitting.starts) <= 2 and sitting.run not in afflicted:
            afflicted.append(sitting.run)
            sitting.inject("robot_hidden", duration=0.5)

    outcome, sitting = bench.sit(study, hide)
    assert outcome.state == "finished"
    assert len(sitting.seen_for) == 2
    assert min(sitting.seen_for) >= 0.9, "the coils come on once the robot has been seen for a second"
    failed, other = sorted(study.rows(), key=lambda row: row.state == "finished")
    assert (failed.state, failed.attempts, dict(failed.metrics)) == ("failed", 2, {})
    assert "not seen" in failed.reason
    assert other.state == "finished"
    assert len(bench.runs(study, "aborted")) == 2


def test_a_campaign_whose_runs_all_fail_ends_by_its_rule(bench: CampaignBench) -> None:
    study = bench.study(
        controller={"name": "sequence", "parameters": {"table": "A 10 60"}},
        trajectory={"name": "circle", "parameters": {**CIRCLE, "centre_x_mm": 59.0}},
        stop={"failed_in_a_row": 2},
    )
    outcome, _ = bench.sit(study)
    assert outcome.state == study.state == "failed"
    assert outcome.reason == "2 runs in a row failed"
    assert len(study.rows()) == 2
