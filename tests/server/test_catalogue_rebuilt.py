"""The catalogue is made anew from the recordings, and loses nothing that they or it know."""

from __future__ import annotations

import fcntl
import os
import shutil
from pathlib import Path

import pytest
from catalogue_bench import record
from recordings_bench import RecordingsBench, Walk

from server.catalogue.deleting import delete_run
from server.catalogue.edits import edit
from server.catalogue.opening import NAME
from server.catalogue.rebuilding import put_in_order, rebuild
from server.catalogue.records import RunRecord
from server.catalogue.shelf import OpenShelf, file_of


@pytest.fixture(scope="module")
def three_runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    bench, data = RecordingsBench(), tmp_path_factory.mktemp("recorded")
    for index in range(3):
        bench.record(
            data, Walk(duration=0.5, frame_rate=4.0, index=index, label=f"walk {index}", tags=("t",))
        )
    return data


@pytest.fixture
def recorded(three_runs: Path, tmp_path: Path) -> Path:
    """A data folder with three short runs."""
    return Path(shutil.copytree(three_runs, tmp_path / "data"))


def catalogued(data: Path) -> dict[str, RunRecord]:
    shelf = OpenShelf.open(data)
    try:
        return {run.id: shelf.catalogue.get(run.id) for run in shelf.catalogue.page().runs}
    finally:
        shelf.close()


def lose_catalogue(data: Path) -> None:
    for path in data.glob(f"{NAME}*"):
        path.unlink()


def test_a_lost_catalogue_is_made_anew_from_the_recordings(recorded: Path) -> None:
    shelf = OpenShelf.open(recorded)
    edited, *_ = [run.id for run in shelf.catalogue.page().runs]
    edit(shelf, edited, {"notes": "worth keeping", "tags": ["mine"], "pinned": True})
    shelf.close()
    before = catalogued(recorded)
    lose_catalogue(recorded)
    shelf = OpenShelf.open(recorded)
    assert shelf.catalogue.is_new
    assert put_in_order(shelf) == "there was no catalogue of runs: it was made anew from 3 recordings"
    assert (rebuild(shelf).renewed, put_in_order(shelf) is None) == (3, False)
    shelf.close()
    assert catalogued(recorded) == before


def test_a_start_with_a_catalogue_rebuilds_nothing(recorded: Path) -> None:
    shelf = OpenShelf.open(recorded)
    assert put_in_order(shelf) == ""
    shelf.close()


def test_a_broken_catalogue_is_named_where_it_is_made_anew(recorded: Path) -> None:
    lose_catalogue(recorded)
    (recorded / NAME).write_bytes(b"no database" * 99)
    shelf = OpenShelf.open(recorded)
    assert "was damaged (kept as catalogue.sqlite.broken-" in put_in_order(shelf)
    assert shelf.catalogue.page().total == 3
    shelf.close()


def test_a_rebuild_keeps_what_stands_in_the_catalogue_alone(recorded: Path) -> None:
    shelf = OpenShelf.open(recorded)
    first = shelf.catalogue.page().runs[0]
    shelf.catalogue.update(first.id, notes="only here")
    unrecorded = record(5, recording_state="none", state="finished", size_bytes=0)
    shelf.catalogue.add(unrecorded)
    done = rebuild(shelf)
    assert (done.added, done.renewed, done.lost, done.told) == (0, 3, 0, [])
    assert shelf.catalogue.get(first.id).notes == "only here"
    assert shelf.catalogue.get(unrecorded.id) == unrecorded
    shelf.close()


def test_a_rebuild_keeps_a_run_in_its_study(recorded: Path) -> None:
    shelf = OpenShelf.open(recorded)
    first = shelf.catalogue.page().runs[0]
    shelf.catalogue.update(first.id, study="later")
    rebuild(shelf)
    assert shelf.catalogue.get(first.id).study == "later"
    shelf.close()


def test_a_start_lists_recordings_that_the_catalogue_does_not_know(recorded: Path) -> None:
    """Such as those of a catalogue that was lost, and that a command has made anew before the server came."""
    before = catalogued(recorded)
    lose_catalogue(recorded)
    assert catalogued(recorded) == {}
    shelf = OpenShelf.open(recorded)
    file_of(shelf.folder, "just-begun").touch()
    assert put_in_order(shelf) == "3 recordings were not in the catalogue of runs, and came into it"
    assert put_in_order(shelf) == ""
    shelf.close()
    assert catalogued(recorded) == before


def test_a_rebuild_leaves_alone_what_is_being_deleted_or_written(recorded: Path) -> None:
    shelf = OpenShelf.open(recorded)
    hidden, written, _ = [run.id for run in shelf.catalogue.page().runs]
    shelf.catalogue.delete(written)
    path = file_of(shelf.folder, written)
    os.truncate(path, path.stat().st_size - 100)
    with path.open("rb") as recorder:
        fcntl.flock(recorder, fcntl.LOCK_EX)
        shelf.catalogue.hide(hidden, lambda _: None)
        shelf.catalogue.renew(hidden, lambda _: record(1))
        assert shelf.catalogue.hidden() == [hidden]
        done = rebuild(shelf)
    assert (done.added, done.renewed, done.told) == (0, 1, [])
    shelf.close()


def test_a_rebuild_says_what_is_gone_and_what_cannot_be_read(recorded: Path) -> None:
    shelf = OpenShelf.open(recorded)
    gone, *_ = [run.id for run in shelf.catalogue.page().runs]
    file_of(shelf.folder, gone).unlink()
    file_of(shelf.folder, "20260101-000000-beef").write_bytes(b"no recording")
    done = rebuild(shelf)
    assert (done.renewed, done.lost) == (2, 1)
    assert shelf.catalogue.get(gone).recording_state == "lost"
    [told] = done.told
    assert "20260101-000000-beef" in told
    shelf.close()


def test_a_deleted_run_does_not_come_back_with_a_rebuild(recorded: Path) -> None:
    shelf = OpenShelf.open(recorded)
    gone, cut_short, kept = [run.id for run in shelf.catalogue.page().runs]
    delete_run(shelf, gone)
    shelf.catalogue.hide(cut_short, lambda _: None)
    rebuild(shelf)
    shelf.close()
    assert list(catalogued(recorded)) == [kept]
