"""A disk that does not come back: neither the rig nor the program's end waits for it."""

from __future__ import annotations

import threading
import time
from dataclasses import replace

import pytest

from control.metrics import MetricsTally
from control.runs import Choice, RunRequest, Selection
from control.safety import Refused
from server.archive import Archive
from server.assembly import build_machine
from server.commands.walk import HeadlessWalk, _archive
from server.recording.reading.recording import Recording
from server.recording.writing import disk_answer, recorder
from server.recording.writing.recorder import CLOSE_WITHIN
from server.run_recording import RunRecording
from server.settings import RigFile
from tests.server.recordings_bench import LENGTH, RecordingsBench, Walk, _run
from tests.server.stuck_disk import Silent, Stuck

TICK = 1.0 / 60.0
WITHIN = 0.5
"""A disk has this long to answer, s."""


@pytest.fixture(scope="module")
def bench():
    return RecordingsBench()


@pytest.fixture
def disk():
    stuck = Stuck()
    yield stuck
    stuck.may_go_on.set()


def hang(bench, archive, disk, ticks=200):
    """Hand over ticks of a run whose disk hangs from the second one on; how long the slowest took to hand over, s."""
    run, tally, slowest = _run(Walk(frame_rate=0.0)), MetricsTally(LENGTH), 0.0
    archive.recorder.disk = disk
    archive.recorder.begin(run, bench.conditions(Walk(frame_rate=0.0)))
    for index in range(1, ticks + 1):
        began = time.monotonic()
        archive.recorder.tick(bench.snapshot(run, index, index * TICK, tally), None)
        slowest = max(slowest, time.monotonic() - began)
        if index == 1:
            while archive.recorder.status.size == 0 or archive.recorder.status.ticks_waiting > 0:
                time.sleep(0.002)
            disk.may_go_on.clear()
            time.sleep(1.1)  # the next second of the disk comes, and hangs
    return slowest


def test_the_end_of_the_program_waits_for_a_hanging_disk_once_and_not_for_long(bench, tmp_path, disk):
    archive = Archive.open(tmp_path)
    hang(bench, archive, disk)
    began = time.monotonic()
    archive.recorder.close()
    archive.close()
    assert time.monotonic() - began < CLOSE_WITHIN + 0.5
    with Recording.open(archive.path_of(Walk().id)) as torn:
        assert not torn.is_whole
        assert torn.tick_at(1.0) is not None
    disk.may_go_on.set()
    assert archive.recorder.written(Walk().id, 10.0)


def test_a_simulated_run_that_waits_for_its_disk_ends_when_that_hangs(bench, tmp_path, disk, monkeypatch):
    monkeypatch.setattr(recorder, "LONGEST_WAIT", 0.5)
    archive = Archive.open(tmp_path, patient=True)
    slowest = hang(bench, archive, disk)
    assert "the disk hangs" in archive.recorder.failure
    assert 0.5 <= slowest < 2.0
    disk.may_go_on.set()
    archive.close()


@pytest.mark.parametrize(("camera", "port"), [("sim://", "sim://"), ("file:///plate.avi", "/dev/ttyACM0")])
def test_only_a_simulated_rig_of_the_command_line_waits_for_a_disk(
    bench, tmp_path, disk, camera, port, monkeypatch
):
    monkeypatch.setattr(recorder, "LONGEST_WAIT", 0.5)
    rig_file = RigFile.model_validate({"camera": {"uri": camera}, "link": {"port": port}})
    with _archive(HeadlessWalk(rig_file, RunRequest(Selection(Choice("geometric"))), tmp_path)) as archive:
        assert archive is not None
        slowest = hang(bench, archive, disk)
        assert (slowest > 0.3) is rig_file.is_simulated
        disk.may_go_on.set()


def test_a_disk_that_does_not_answer_refuses_each_start_and_keeps_no_thread_for_each(tmp_path, monkeypatch):
    monkeypatch.setattr(disk_answer, "WITHIN", WITHIN)
    archive = Archive.open(tmp_path)
    disk = Silent()
    machine = replace(build_machine(RigFile(), realtime=False), disk=disk)
    recording = RunRecording(archive.recorder)
    before = threading.active_count()
    for _ in range(2):
        began = time.monotonic()
        with pytest.raises(Refused, match="has not answered"):
            recording.check(machine)
        assert WITHIN <= time.monotonic() - began < WITHIN + 1.0
    assert threading.active_count() == before + 1
    disk.may_answer.set()
    recording.check(machine)
    machine.close()
    archive.close()


def test_two_starts_at_once_are_both_answered(tmp_path):
    archive = Archive.open(tmp_path)
    machine = build_machine(RigFile(), realtime=False)
    recording, refused = RunRecording(archive.recorder), []

    def ask():
        for _ in range(50):
            try:
                recording.check(machine)
            except Refused as error:
                refused.append(str(error))

    askers = [threading.Thread(target=ask) for _ in range(2)]
    for asker in askers:
        asker.start()
    for asker in askers:
        asker.join()
    assert refused == []
    assert list(archive.folder.iterdir()) == []
    machine.close()
    archive.close()
