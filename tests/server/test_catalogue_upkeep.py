"""Runs are deleted whole, and kept as long as they should be, with what a person has written about them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from catalogue_bench import record

from server.catalogue.deleting import delete_run, finish_deletions
from server.catalogue.edits import edit
from server.catalogue.errors import CatalogueError, NoSuchRun, NotNow
from server.catalogue.records import RunRecord
from server.catalogue.retention import Policy, prunable, prune
from server.catalogue.shelf import EDITS, RECORDING, OpenShelf, file_of

NOW = datetime(2026, 6, 1, tzinfo=UTC)
MB = 1_000_000


@pytest.fixture
def shelf(tmp_path: Path) -> Iterator[OpenShelf]:
    opened = OpenShelf.open(tmp_path)
    opened.folder.mkdir()
    yield opened
    opened.close()


def put(shelf: OpenShelf, index: int, **changes: object) -> RunRecord:
    """A run `index` days before now, with a file."""
    values = {
        "started_at": NOW - timedelta(days=index),
        "state": "finished",
        "pinned": False,
        "size_bytes": 100 * MB,
    }
    run = record(index, **{**values, **changes})
    shelf.catalogue.add(run)
    file_of(shelf.folder, run.id).write_bytes(b"recording")
    return run


def files(shelf: OpenShelf) -> set[str]:
    return {path.name for path in shelf.folder.iterdir()}


# Deleting ----------------------------------------------------------------------------------------


def test_a_run_is_deleted_with_everything_that_belongs_to_it(shelf: OpenShelf) -> None:
    run, other = put(shelf, 1), put(shelf, 2)
    edit(shelf, run.id, {"notes": "to go"})
    assert delete_run(shelf, run.id).notes == "to go"
    assert files(shelf) == {f"{other.id}{RECORDING}"}
    with pytest.raises(NoSuchRun):
        delete_run(shelf, run.id)


def test_what_is_pinned_or_goes_on_is_not_deleted(shelf: OpenShelf) -> None:
    for index, changes in enumerate(({"pinned": True}, {"state": "running"}, {"recording_state": "writing"})):
        run = put(shelf, index, **changes)
        with pytest.raises(NotNow, match=run.id):
            delete_run(shelf, run.id)
        assert shelf.catalogue.get(run.id).id == run.id
        assert f"{run.id}{RECORDING}" in files(shelf)


def test_a_recording_that_cannot_go_keeps_its_row(shelf: OpenShelf) -> None:
    run = put(shelf, 1)
    path = file_of(shelf.folder, run.id)
    path.unlink()
    path.mkdir()  # which cannot be unlinked, whoever one is
    with pytest.raises(CatalogueError, match=f"the recording of run {run.id} cannot be deleted"):
        delete_run(shelf, run.id)
    assert shelf.catalogue.page().total == 1


@pytest.mark.parametrize("file_has_gone", [False, True])
def test_a_deletion_that_was_cut_short_is_finished(shelf: OpenShelf, file_has_gone: bool) -> None:
    run = put(shelf, 1)
    shelf.catalogue.hide(run.id, lambda _: None)
    if file_has_gone:
        file_of(shelf.folder, run.id).unlink()
    assert finish_deletions(shelf) == 1
    assert (files(shelf), shelf.catalogue.known([run.id])) == (set(), set())


class InterruptedShelf:
    """Another program starts, and finishes deletions, just when files are about to be removed."""

    def __init__(self, shelf: OpenShelf) -> None:
        self.catalogue = shelf.catalogue
        self._shelf = shelf

    @property
    def folder(self) -> Path:
        finish_deletions(self._shelf)
        return self._shelf.folder


def test_two_programs_may_finish_the_same_deletion(shelf: OpenShelf) -> None:
    run = put(shelf, 1)
    assert delete_run(InterruptedShelf(shelf), run.id).id == run.id
    assert (files(shelf), shelf.catalogue.known([run.id])) == (set(), set())


# Keeping -----------------------------------------------------------------------------------------


def test_runs_go_by_their_age(shelf: OpenShelf) -> None:
    young, old = put(shelf, 29), put(shelf, 31)
    pinned, running = put(shelf, 40, pinned=True), put(shelf, 50, state="running")
    policy = Policy(keep_days=30.0)
    assert [run.id for run in prunable(shelf, policy, NOW)] == [old.id]
    assert shelf.catalogue.page().total == 4
    assert [run.id for run in prune(shelf, policy, NOW)] == [old.id]
    assert [run.id for run in shelf.catalogue.page().runs] == [young.id, pinned.id, running.id]
    assert f"{old.id}{RECORDING}" not in files(shelf)


def test_the_oldest_go_until_the_rest_is_small_enough(shelf: OpenShelf) -> None:
    runs = [put(shelf, index) for index in range(5)]
    put(shelf, 9, pinned=True)
    put(shelf, 8, size_bytes=0, recording_state="none")
    gone = prune(shelf, Policy(keep_GB=0.35), NOW)
    assert [run.id for run in gone] == [run.id for run in reversed(runs[2:])]
    assert shelf.catalogue.totals().size == 300 * MB


def test_without_a_policy_everything_stays(shelf: OpenShelf) -> None:
    put(shelf, 30_000)
    assert prune(shelf, Policy(), NOW) == []


# What a person writes ----------------------------------------------------------------------------


def test_an_edit_stands_in_the_catalogue_and_beside_the_recording(shelf: OpenShelf) -> None:
    run = put(shelf, 1)
    changed = edit(shelf, run.id, {"label": "  a  walk ", "tags": ["x ", "y", "x", " "], "pinned": True})
    assert (changed.label, changed.tags, changed.pinned, changed.notes) == (
        "a walk",
        ("x", "y"),
        True,
        run.notes,
    )
    beside = json.loads(file_of(shelf.folder, run.id, EDITS).read_text())
    assert beside == {"label": "a walk", "tags": ["x", "y"], "notes": run.notes, "pinned": True}


def test_an_edit_that_cannot_be_kept_changes_nothing(shelf: OpenShelf) -> None:
    run = put(shelf, 1)
    file_of(shelf.folder, run.id, EDITS).mkdir()
    with pytest.raises(CatalogueError, match="cannot be saved beside the recording"):
        edit(shelf, run.id, {"label": "new"})
    assert shelf.catalogue.get(run.id).label == run.label


def test_a_run_without_a_recording_is_edited_in_the_catalogue_alone(shelf: OpenShelf) -> None:
    run = put(shelf, 1, recording_state="none")
    edit(shelf, run.id, {"label": "new"})
    assert shelf.catalogue.get(run.id).label == "new"
    assert files(shelf) == {f"{run.id}{RECORDING}"}
