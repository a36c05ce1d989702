"""What a hand, a bad disk or another program does to a study's folder is noticed, told, and mended where it can be."""

import json
import os
import resource
import shutil
import signal
from contextlib import contextmanager, suppress
from fcntl import LOCK_SH, flock
from threading import Timer

import pytest
from study_bench import CLUELESS, carried_out, definition

from control.controllers import controllers
from control.plugins import load_file
from control.studies.errors import StudyError
from server.studies.carrying_out import Carried
from server.studies.condition import Claim, is_claimed
from server.studies.errors import NoSuchStudy, StudyStoreError
from server.studies.store import StudyStore


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The data folder of a study of 3 runs that is finished."""
    data = tmp_path_factory.mktemp("finished")
    carried_out(StudyStore(data).create(definition(1)))
    return data


@pytest.fixture
def study(finished, tmp_path):
    """A copy of it that may be spoilt."""
    shutil.copytree(finished, tmp_path / "data")
    [study] = StudyStore(tmp_path / "data").all()
    return study


@pytest.fixture
def clueless(tmp_path):
    """A controller all of whose runs fail."""
    path = tmp_path / "clueless.py"
    path.write_text(CLUELESS)
    load_file(path)
    yield {"name": "clueless"}
    with suppress(KeyError):
        controllers.forget("clueless")


@pytest.mark.parametrize(
    "changes", [{"index": -1}, {"index": 10**15}, {"metrics": {"normalized_mean_error": "much"}}]
)
def test_a_row_that_cannot_be_costs_its_run_alone_and_is_no_reason_to_call_a_study_complete(study, changes):
    path = study.folder / "results.jsonl"
    *whole, last = path.read_bytes().splitlines(keepends=True)
    expected = study.table().csv()
    path.write_bytes(b"".join((*whole, json.dumps({**json.loads(last), **changes}).encode(), b"\n")))
    assert (study.tally().done, study.state, study.is_complete) == (2, "finished", False)
    carried_out(study)
    assert (study.table().csv(), study.is_complete) == (expected, True)


def test_a_definition_that_was_changed_by_hand_is_not_carried_on(study):
    path = study.folder / "definition.json"
    before = path.read_text()
    path.write_text(json.dumps({**json.loads(before), "seed": 2}))
    changed = StudyStore(study.folder.parents[1]).open(study.id)
    with pytest.raises(StudyStoreError, match=r"definition.json .* changed since .* put it back"):
        carried_out(changed)
    assert not is_claimed(study.folder)
    path.write_text(json.dumps(json.loads(before), indent=4))  # it says the same
    assert carried_out(StudyStore(study.folder.parents[1]).open(study.id)).state == "finished"


def test_a_study_that_cannot_be_planned_any_more_says_why(tmp_path, clueless):
    study = StudyStore(tmp_path / "data").create(definition(1, controller=clueless))
    controllers.forget("clueless")
    with pytest.raises(StudyError, match="clueless"):
        carried_out(study)
    assert study.state == "interrupted"
    assert "clueless" in study.reason


def test_a_study_whose_folder_is_gone_is_told_in_words(study):
    shutil.rmtree(study.folder)
    with pytest.raises(NoSuchStudy):
        _ = study.state
    with pytest.raises(NoSuchStudy):
        carried_out(study)


@contextmanager
def no_room():
    """No file of this process grows."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_keeps_no_claim_and_leaves_no_half_made_study(study):
    assert signal.getsignal(signal.SIGXFSZ) is signal.SIG_IGN
    (study.folder / "lock").unlink()
    store = StudyStore(study.folder.parents[1])
    with no_room():
        with pytest.raises(StudyStoreError, match="make room"):
            carried_out(study)
        with pytest.raises(StudyStoreError, match="choose another folder"):
            store.create(definition(1))
    assert not is_claimed(study.folder)
    assert [folder.name for folder in store.folder.iterdir()] == [study.id]


def test_who_only_looks_is_never_taken_for_who_carries_it_out(study):
    looks = os.open(study.folder / "lock", os.O_RDONLY)
    flock(looks, LOCK_SH)
    timer = Timer(0.3, os.close, (looks,))  # a processor that was busy with somebody else
    timer.start()
    Claim(study.folder, "three tilts").release()
    timer.join()


def test_a_rule_ends_a_study_at_the_same_run_however_often_it_was_interrupted(tmp_path, clueless):
    study = StudyStore(tmp_path / "data").create(definition(3, controller=clueless))
    three = Carried("failed", "3 runs in a row failed")
    for done in (3, 6):  # a person who goes on starts anew
        assert (carried_out(study), study.tally().done) == (three, done)
        state = study.folder / "state.json"
        state.write_text(state.read_text().replace('"failed"', '"running"'))  # killed before that was said
        assert (carried_out(study), study.tally().done) == (three, done)


def test_a_study_whose_last_run_outlasts_its_hours_is_finished(tmp_path):
    study = StudyStore(tmp_path).create(definition(1, stop={"hours": 1e-9}))
    states = [carried_out(study) for _ in range(3)]
    assert [each.state for each in states] == ["stopped", "stopped", "finished"]
