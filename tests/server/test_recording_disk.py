"""What becomes of a recording when the disk does not do its part: it ends, says so, and what was written is kept."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import resource
import stat
import time

import pytest
from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader

from control.safety import Refused
from control.simulation.disk_faults import DiskFaults
from server.archive import Archive
from server.faulty_disk import FaultyDisk
from server.recording.reading.recording import Recording
from server.recording.writing.disk import LocalDisk, LocalFile
from server.recording.writing.recorder import LONGEST_WAIT
from server.recording_section import RecordingSection
from tests.server.mcap_doctor import examine
from tests.server.recorded_walk import outcome_of
from tests.server.recordings_bench import RecordingsBench, Walk
from tests.server.stuck_disk import Stuck

LOST_AT_MOST = 0.25 + 2.0 / 60.0
"""Of a run whose disk fails, s: the open chunk, and a tick on its way."""
TOLD_WITHIN = 1.0


@pytest.fixture(scope="module")
def bench():
    return RecordingsBench()


@pytest.fixture
def archive(tmp_path):
    archive = Archive.open(tmp_path)
    yield archive
    archive.close()


def last_tick(path):
    """Time of the newest tick of a recording, since the run's start, s."""
    with Recording.open(path) as recording:
        return recording.duration


def wait_for(condition, within=5.0):
    give_up = time.monotonic() + within
    while not condition():
        assert time.monotonic() < give_up
        time.sleep(0.002)


class AtPace:
    """Told of each tick: lets the recorder's thread keep up, and does something at one of them."""

    def __init__(self, recorder, at=0, do=lambda: None):
        self._recorder = recorder
        self._at = at
        self._do = do
        self.failed_at = None

    def __call__(self, snapshot):
        wait_for(lambda: self._recorder.status.ticks_waiting == 0)
        if snapshot.tick == self._at:
            self._do()
        if self._recorder.failure and self.failed_at is None:
            self.failed_at = snapshot


@pytest.mark.parametrize(("fault", "words"), [("full", "No space left"), ("read_only", "Read-only")])
def test_a_disk_that_fills_up_or_turns_read_only_ends_the_recording(bench, archive, fault, words):
    faults = DiskFaults(time.monotonic)
    archive.recorder.disk = FaultyDisk(LocalDisk(), faults)
    failures = []
    watch = AtPace(archive.recorder, at=120, do=lambda: setattr(faults, fault, True))

    def watched(snapshot):
        watch(snapshot)
        failures.append(archive.recorder.failure)

    id = bench.record_in(archive, Walk(duration=4.0), watched)

    assert words in failures[-1]
    assert failures.index(failures[-1]) <= 120 + TOLD_WITHIN * 60
    assert last_tick(archive.path_of(id)) >= 2.0 - LOST_AT_MOST
    assert archive.catalogue.get(id).recording_state == "recovered"


class Shrinking(LocalDisk):
    """A disk on which somebody else writes."""

    left = 1 << 40

    def free(self, folder):
        return min(self.left, super().free(folder))


def test_a_recording_ends_before_the_disk_is_full_and_is_whole(bench, archive):
    disk = archive.recorder.disk = Shrinking()
    watch = AtPace(archive.recorder, at=60, do=lambda: setattr(disk, "left", 499_000_000))
    failures = []

    def watched(snapshot):
        watch(snapshot)
        if snapshot.tick > 60 and not archive.recorder.failure:
            time.sleep(0.02)
        failures.append(archive.recorder.failure)

    id = bench.record_in(archive, Walk(duration=4.0), watched)

    assert "499 MB are free" in failures[-1]
    assert "keep_free_MB = 500" in failures[-1]
    examine(archive.path_of(id))
    outcome = outcome_of(archive.path_of(id))
    assert (outcome["failure"], outcome["state"]) == (failures[-1], "finished")


def test_a_run_that_cannot_be_recorded_is_refused_early(archive):
    settings = RecordingSection()
    archive.recorder.check(settings)

    with pytest.raises(Refused, match="are needed"):
        archive.recorder.check(RecordingSection(keep_free_MB=1_000_000))

    faults = DiskFaults(time.monotonic, read_only=True)
    archive.recorder.disk = FaultyDisk(LocalDisk(), faults)
    with pytest.raises(Refused, match="Read-only file system"):
        archive.recorder.check(settings)
    archive.recorder.check(RecordingSection(enabled=False))


def test_a_folder_that_cannot_be_made_is_refused_early(tmp_path):
    archive = Archive.open(tmp_path)
    try:
        archive.folder.rmdir()
        archive.folder.write_text("a file where the folder should be")
        with pytest.raises(Refused, match="nothing can be written"):
            archive.recorder.check(RecordingSection())
    finally:
        archive.close()


def test_a_disk_that_hangs_for_a_while_loses_nothing(bench, archive):
    disk = archive.recorder.disk = Stuck()
    held = []

    def watch(snapshot):
        if snapshot.tick == 30:
            disk.may_go_on.clear()
            time.sleep(1.1)  # the next second of the disk comes, and hangs
        if snapshot.tick == 200:
            wait_for(lambda: archive.recorder.status.ticks_waiting > 100)
            held.append(archive.recorder.failure)
            disk.may_go_on.set()

    id = bench.record_in(archive, Walk(duration=5.0), watch)

    assert held == [""]
    assert outcome_of(archive.path_of(id))["failure"] == ""
    with Recording.open(archive.path_of(id)) as recording:
        assert len(list(recording.ticks(topics=["/state"]))) >= 300


def test_a_disk_that_hangs_for_long_ends_the_recording_and_keeps_what_was_handed_over(bench, archive):
    disk = archive.recorder.disk = Stuck()
    failures = []

    def watch(snapshot):
        if snapshot.tick == 1:
            wait_for(lambda: archive.recorder.status.size > 0 and archive.recorder.status.ticks_waiting == 0)
            disk.may_go_on.clear()
            time.sleep(1.1)
        failures.append(archive.recorder.failure)
        if snapshot.tick == 1000:
            disk.may_go_on.set()

    id = bench.record_in(archive, Walk(duration=17.0, frame_rate=0.0), watch)

    first = next(index for index, failure in enumerate(failures) if failure)
    assert "the disk is too slow" in failures[first]
    assert first / 60.0 == pytest.approx(LONGEST_WAIT, abs=0.2)
    examine(archive.path_of(id))
    assert last_tick(archive.path_of(id)) >= LONGEST_WAIT
    assert outcome_of(archive.path_of(id))["failure"] == failures[first]


def test_a_recording_never_takes_the_place_of_another_file(bench, archive):
    walk = Walk(duration=1.0)
    path = archive.path_of(walk.id)
    path.write_text("somebody's own")
    watch = AtPace(archive.recorder)
    bench.record_in(archive, walk, watch)
    assert path.read_text() == "somebody's own"
    assert watch.failed_at is not None
    assert archive.catalogue.get(walk.id).state == "finished"


def test_a_file_is_locked_while_it_is_written_and_only_then(bench, archive):
    held = []

    def is_locked(path):
        with path.open("rb") as file:
            try:
                fcntl.flock(file.fileno(), fcntl.LOCK_SH | fcntl.LOCK_NB)
            except BlockingIOError:
                return True
            return False

    def watch(snapshot):
        if snapshot.tick == 30:
            wait_for(lambda: archive.recorder.status.size > 0)
            held.append(is_locked(archive.path_of(Walk().id)))

    id = bench.record_in(archive, Walk(duration=1.0), watch)
    assert held == [True]
    assert not is_locked(archive.path_of(id))


def test_what_is_flushed_is_readable_while_the_run_goes_on(bench, archive):
    """As everybody's reader sees it who does not need the end of the file."""
    found = []

    def watch(snapshot):
        if snapshot.tick == 120:
            wait_for(lambda: archive.recorder.status.ticks_waiting == 0)
            with archive.path_of(Walk().id).open("rb") as file, contextlib.suppress(EndOfFile):
                found.extend(NonSeekingReader(file).iter_messages(log_time_order=False))

    bench.record_in(archive, Walk(duration=3.0, frame_rate=0.0), watch)
    assert (found[-1][2].log_time - found[0][2].log_time) * 1e-9 >= 2.0 - LOST_AT_MOST


def test_pictures_are_left_out_when_there_is_no_time_for_them_and_ticks_never(bench, archive):
    """Two seconds of pictures are handed over in a tenth of one."""
    id = bench.record_in(archive, Walk(duration=2.0, frame_rate=60.0))
    outcome = outcome_of(archive.path_of(id))
    assert outcome["frames_left_out"] > 0
    assert outcome["frames"] + outcome["frames_left_out"] == pytest.approx(120, abs=2)
    assert outcome["ticks"] >= 120
    with Recording.open(archive.path_of(id)) as recording:
        assert len(list(recording.ticks())) == outcome["ticks"]


@pytest.fixture
def file_limit():
    """No file of this process may become larger, bytes; a limit of the system, not one of ours."""
    limit, (soft, hard) = 400_000, resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, hard)) or limit
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_file_that_may_not_grow_any_further_keeps_all_that_fitted(bench, archive, file_limit):
    limit = file_limit()
    watch = AtPace(archive.recorder)
    id = bench.record_in(archive, Walk(duration=4.0), watch)

    assert watch.failed_at is not None
    path = archive.path_of(id)
    assert 0.5 * limit < path.stat().st_size <= limit
    with Recording.open(path) as recording:
        assert len(list(recording.ticks())) > 30
        assert recording.settings["run"]["id"] == id


class Unsure(LocalDisk):
    """A disk of another computer: what it did not take whole cannot even be cut off, until it is back."""

    def __init__(self):
        self.is_away = False

    def create(self, path):
        return UnsureFile(path, self)


class UnsureFile(LocalFile):
    def __init__(self, path, disk):
        super().__init__(path)
        self._disk = disk

    def write(self, data):
        if self._disk.is_away:
            super().write(data[: len(data) // 2])
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return super().write(data)

    def fileno(self):
        if self._disk.is_away:
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return super().fileno()


def test_half_a_chunk_is_cut_off_before_anything_else_is_written(bench, archive):
    disk = archive.recorder.disk = Unsure()
    watch = AtPace(archive.recorder, at=120, do=lambda: setattr(disk, "is_away", True))

    def watched(snapshot):
        watch(snapshot)
        if archive.recorder.failure:
            disk.is_away = False

    id = bench.record_in(archive, Walk(duration=4.0), watched)
    assert watch.failed_at is not None
    examine(archive.path_of(id))
    assert "Input/output error" in outcome_of(archive.path_of(id))["failure"]


@pytest.mark.parametrize(("number", "is_kept"), [(errno.EINVAL, True), (errno.EIO, False)])
def test_a_folder_that_cannot_be_synced_leaves_no_open_file_behind(
    bench, archive, monkeypatch, number, is_kept
):
    """Some network disks refuse to be asked; others are broken."""
    real = os.fsync

    def fsync(file):
        if stat.S_ISDIR(os.fstat(file).st_mode):
            raise OSError(number, os.strerror(number))
        real(file)

    monkeypatch.setattr(os, "fsync", fsync)
    watch = AtPace(archive.recorder)
    id = bench.record_in(archive, Walk(duration=0.5), watch)
    path = archive.path_of(id)
    assert (watch.failed_at is None) is is_kept
    assert path.exists() is is_kept
    names = [os.path.realpath(f"/proc/self/fd/{each}") for each in os.listdir("/proc/self/fd")]
    assert str(path) not in [name.removesuffix(" (deleted)") for name in names]
