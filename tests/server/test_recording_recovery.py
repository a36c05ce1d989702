"""What a program that was killed leaves behind is made whole again, once, and nothing that can be read is lost."""

import contextlib
import fcntl
import multiprocessing
import os
import random
import signal
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from mcap.reader import make_reader
from mcap_doctor import examine, placed
from recordings_bench import RecordingsBench, Walk
from torn_files import (
    frames_by_public_reader,
    newest_tick,
    outcome_of,
    overview_of,
    read_all,
    statistics_of,
    ticks_by_public_reader,
)

from server.archive import Archive
from server.catalogue.catalogue import Catalogue
from server.catalogue.deleting import delete_run
from server.recording.presence import Presence
from server.recording.reading.recording import Recording
from server.recording.recovery.recover import is_being_written, recover

DURATION = 4.0
RUNNING = {"state": "running", "recording_state": "writing", "metrics": None, "ended_at": None, "frames": 0}
"""What the catalogue says of a run whose program was killed."""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Data folder and id of a whole recording."""
    data = tmp_path_factory.mktemp("recorded")
    id = RecordingsBench().record(data, Walk(duration=DURATION, rate=30.0, frame_rate=5.0, label="first"))
    return data / "recordings" / f"{id}.mcap"


@pytest.fixture
def archive(tmp_path):
    archive = Archive.open(tmp_path)
    yield archive
    archive.close()


@pytest.fixture
def torn(archive, recorded):
    """The file as it is when its program is killed after about 3 s, with its row in the catalogue."""
    path = archive.folder / recorded.name
    path.write_bytes(recorded.read_bytes()[: recorded.stat().st_size * 3 // 4])
    with Catalogued(recorded) as record:
        archive.catalogue.add(replace(record, **RUNNING))
    return path


class Catalogued:
    """The row of a whole recording."""

    def __init__(self, path):
        self._catalogue = Catalogue.open(path.parent.parent)
        self._id = path.stem

    def __enter__(self):
        return self._catalogue.get(self._id)

    def __exit__(self, *_):
        self._catalogue.close()


def test_a_torn_recording_becomes_whole_with_every_tick_that_it_had(archive, torn):
    before = read_all(torn)
    (done,) = recover(archive.folder, archive.catalogue)
    assert done.is_recovered
    assert torn.stem in str(done)
    with Recording.open(torn) as recording:
        assert recording.is_whole
        assert recording.is_recovered
        assert list(recording.ticks()) == before
    assert examine(torn).message_count > len(before) > 60


def test_the_public_reader_reads_a_torn_recording_as_it_is_and_seeks_in_a_recovered_one(archive, torn):
    ticks = len(read_all(torn))
    assert ticks_by_public_reader(torn) == ticks
    recover(archive.folder, archive.catalogue)
    assert statistics_of(torn).chunk_count > 8
    with torn.open("rb") as file:
        assert sum(1 for _ in make_reader(file, validate_crcs=True).iter_messages("/state")) == ticks


def test_the_run_is_listed_as_interrupted_with_the_figures_of_what_was_walked(archive, torn, recorded):
    recover(archive.folder, archive.catalogue)
    record = archive.catalogue.get(torn.stem)
    assert (record.state, record.recording_state) == ("interrupted", "recovered")
    assert record.size_bytes == torn.stat().st_size
    assert record.frames == frames_by_public_reader(torn) > 10
    assert len(record.sparkline) == 60
    last = newest_tick(torn)["/state"]["run"]
    assert outcome_of(torn)["metrics"] == record.metrics
    assert record.metrics is not None
    assert set(record.metrics) == set(outcome_of(recorded)["metrics"])
    assert set(overview_of(torn)) == set(overview_of(recorded))
    assert record.metrics["mean_error_mm"] == pytest.approx(last["mean_error_mm"], abs=1e-6)
    assert record.metrics["duration_s"] == pytest.approx(last["elapsed_s"], abs=1e-3)
    assert record.metrics["steps"] == last["steps"]


def test_figures_counted_again_from_the_ticks_are_those_of_the_run(archive, recorded):
    """Only the end was lost: nobody knows the outcome, but every tick of the run is there."""
    path = archive.folder / recorded.name
    outcome = next(at for at, _, record in placed(recorded) if getattr(record, "name", "") == "overview.json")
    path.write_bytes(recorded.read_bytes()[:outcome])
    recover(archive.folder, archive.catalogue)
    assert outcome_of(path)["metrics"] == pytest.approx(outcome_of(recorded)["metrics"], abs=2e-6)
    counted = overview_of(path)
    for name, series in overview_of(recorded).items():
        assert counted[name] == pytest.approx(series, abs=1e-9)


def test_a_run_that_had_ended_keeps_its_outcome(archive, torn, recorded):
    with Catalogued(recorded) as record:
        archive.catalogue.renew(record.id, lambda _: replace(record, recording_state="writing"))
    recover(archive.folder, archive.catalogue)
    found = archive.catalogue.get(torn.stem)
    assert (found.state, found.metrics, found.ended_at) == ("finished", record.metrics, record.ended_at)
    assert outcome_of(torn)["state"] == "finished"


def test_a_recording_that_the_catalogue_does_not_know_is_added_to_it(archive, torn, recorded):
    archive.catalogue.delete(torn.stem)
    recover(archive.folder, archive.catalogue)
    record = archive.catalogue.get(torn.stem)
    with Catalogued(recorded) as known:
        assert (record.label, record.controller, record.selection) == ("first", "geometric", known.selection)
        assert record.started_at == known.started_at


def test_recovering_again_changes_nothing(archive, torn):
    recover(archive.folder, archive.catalogue)
    data, record = torn.read_bytes(), archive.catalogue.get(torn.stem)
    assert recover(archive.folder, archive.catalogue) == []
    assert torn.read_bytes() == data
    assert archive.catalogue.get(torn.stem) == record
    assert [path.name for path in archive.folder.iterdir()] == [torn.name]


def test_a_file_that_somebody_writes_is_left_alone(archive, torn):
    data = torn.read_bytes()
    with torn.open("rb") as writer:
        fcntl.flock(writer, fcntl.LOCK_EX)
        assert is_being_written(torn)
        assert recover(archive.folder, archive.catalogue) == []
    assert torn.read_bytes() == data
    assert archive.catalogue.get(torn.stem).state == "running"


def test_a_run_that_is_walked_unrecorded_is_left_alone_as_long_as_its_program_lives(archive, torn):
    torn.unlink()
    archive.catalogue.update(torn.stem, recording_state="none")
    with walked_by_another_program(archive.folder, torn.stem):
        assert recover(archive.folder, archive.catalogue) == []
        assert archive.catalogue.get(torn.stem).state == "running"
    (done,) = recover(archive.folder, archive.catalogue)
    assert done.id == torn.stem
    assert archive.catalogue.get(torn.stem).state == "interrupted"
    assert list(archive.folder.iterdir()) == []


def test_a_run_that_began_before_the_clock_was_put_back_is_ended_all_the_same(archive, torn):
    archive.catalogue.update(torn.stem, started_at=datetime.now(UTC) + timedelta(days=3))
    torn.unlink()
    assert len(recover(archive.folder, archive.catalogue)) == 1
    assert archive.catalogue.get(torn.stem).state == "interrupted"


def test_a_run_that_is_deleted_while_it_is_recovered_stays_deleted(archive, torn):
    archive.catalogue.update(torn.stem, state="interrupted", recording_state="recovered")

    def delete_once():
        if archive.catalogue.known([torn.stem]):
            delete_run(archive, torn.stem)

    (done,) = recover(archive.folder, archive.catalogue, delete_once)
    assert "was deleted while" in str(done)
    assert (list(archive.folder.iterdir()), archive.catalogue.page().total) == ([], 0)


def test_a_file_of_which_nothing_can_be_read_is_kept_under_another_name(archive, torn):
    torn.write_bytes(torn.read_bytes()[:400])
    (done,) = recover(archive.folder, archive.catalogue)
    assert not done.is_recovered
    kept = torn.with_name(f"{torn.name}.torn")
    assert str(kept) in str(done)
    assert kept.stat().st_size == 400
    assert not torn.exists()
    record = archive.catalogue.get(torn.stem)
    assert (record.state, record.recording_state, record.size_bytes) == ("interrupted", "lost", 400)


def test_a_damaged_piece_is_left_out_and_said(archive, torn):
    ticks = len(read_all(torn))
    with torn.open("r+b") as file:
        file.seek(torn.stat().st_size // 2)
        file.write(bytes(64))
    (done,) = recover(archive.folder, archive.catalogue)
    assert "damaged" in str(done)
    assert ticks - 10 <= len(read_all(torn)) < ticks
    with torn.open("rb") as file:
        messages = sum(1 for _ in make_reader(file, validate_crcs=True).iter_messages())
    assert messages == statistics_of(torn).message_count


def test_rows_of_runs_that_nobody_walks_any_more_are_ended(archive, torn, recorded):
    torn.unlink()
    with Catalogued(recorded) as record:
        archive.catalogue.add(replace(record, **RUNNING | {"id": "no-file", "recording_state": "none"}))
    done = recover(archive.folder, archive.catalogue)
    assert {each.id for each in done} == {torn.stem, "no-file"}
    assert archive.catalogue.get(torn.stem).recording_state == "lost"
    ended = archive.catalogue.get("no-file")
    assert (ended.state, ended.recording_state) == ("interrupted", "none")


def test_a_whole_recording_that_the_catalogue_takes_for_open_is_listed_as_it_is(archive, torn, recorded):
    torn.write_bytes(recorded.read_bytes())
    (done,) = recover(archive.folder, archive.catalogue)
    assert done.id == torn.stem
    with Catalogued(recorded) as record:
        assert archive.catalogue.get(torn.stem) == replace(record, size_bytes=torn.stat().st_size)


def test_a_full_disk_leaves_the_torn_file_as_it_is_and_says_so(archive, torn):
    data = torn.read_bytes()
    assert _in_child(_recover_with_little_room, torn) == 0
    assert torn.read_bytes() == data
    assert [path.name for path in archive.folder.iterdir()] == [torn.name]
    meanwhile = archive.catalogue.get(torn.stem)
    assert (meanwhile.state, meanwhile.is_going_on) == (
        "interrupted",
        False,
    )  # so it may be deleted to make room
    assert meanwhile.size_bytes == len(data)
    assert recover(archive.folder, archive.catalogue)[0].is_recovered
    assert archive.catalogue.get(torn.stem).metrics == outcome_of(torn)["metrics"]
    assert archive.catalogue.get(torn.stem).ended_at is not None


def _recover_with_little_room(torn):
    """A file may have half of the size that it needs."""
    import resource

    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (torn.stat().st_size // 2,) * 2)
    catalogue = Catalogue.open(torn.parent.parent)
    (done,) = recover(torn.parent, catalogue)
    catalogue.close()
    assert not done.is_recovered
    assert "File too large" in str(done)


def test_a_recovery_that_is_killed_while_it_copies_changes_nothing(archive, torn, full):
    data, ticks = torn.read_bytes(), read_all(torn)
    for chunk in range(0, 12, 1 if full else 5):
        assert _in_child(_die_at, torn, chunk) == -signal.SIGKILL
        assert torn.read_bytes() == data
    recover(archive.folder, archive.catalogue)
    assert read_all(torn) == ticks
    assert [path.name for path in archive.folder.iterdir()] == [torn.name]


def test_a_recovery_that_is_killed_at_any_moment_leaves_the_torn_file_or_the_whole_one(archive, torn, full):
    data, ticks, chance = torn.read_bytes(), read_all(torn), random.Random()
    for _ in range(50 if full else 3):
        torn.write_bytes(data)
        child = multiprocessing.get_context("fork").Process(target=_die_at, args=(torn, 1000))
        child.start()
        child.join(chance.uniform(0.0, 0.15))
        child.kill()
        child.join()
        with Recording.open(torn) as recording:
            assert recording.is_whole or torn.read_bytes() == data
        assert read_all(torn) == ticks
    recover(archive.folder, archive.catalogue)
    assert archive.catalogue.get(torn.stem).recording_state == "recovered"
    assert [path.name for path in archive.folder.iterdir()] == [torn.name]


def _die_at(torn, chunk):
    left = iter(range(chunk))

    def between():
        if next(left, None) is None:
            os.kill(os.getpid(), signal.SIGKILL)

    catalogue = Catalogue.open(torn.parent.parent)
    recover(torn.parent, catalogue, between)


@contextlib.contextmanager
def walked_by_another_program(folder, id):
    """One that records nothing, and that is killed in the end."""
    context = multiprocessing.get_context("fork")
    begun = context.Event()

    def walk():
        presence = Presence(folder, id)
        begun.set()
        signal.pause()
        presence.close()

    child = context.Process(target=walk)
    child.start()
    try:
        assert begun.wait(30.0)
        yield
    finally:
        child.kill()
        child.join()


def _in_child(work, *arguments):
    """Exit status of a process of its own that does the work; forked, since importing takes longer than the work."""
    child = multiprocessing.get_context("fork").Process(target=work, args=arguments)
    child.start()
    child.join(60.0)
    return child.exitcode
