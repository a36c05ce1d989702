"""Rows 23 and 24: the disk that recordings go to. Viewing and recording may fail; what must be recorded stops."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from control.news import Announcement
from control.safety import Refused
from control.simulation.faults.promises import FRAME
from control.snapshot import RigState
from server.archive import Archive
from server.recording.reading.recording import Recording
from server.recording.writing.recorder import LONGEST_WAIT, Recorder
from server.settings import RigFile
from tests.faults.fault_bench import FaultBench, recorded
from tests.faults.invariants import (
    check_announced,
    check_limits,
    check_period,
    check_recording,
    check_stays_zero,
    check_zero,
    nothing_left_behind,
)
from tests.faults.trial import keeps_its_promise

SIMULATED = RigFile().with_simulation(seed=3)


def test_a_full_disk_ends_the_run_with_what_was_recorded_kept() -> None:
    """When the disk becomes full half-way through a run, the run ends, says why, and keeps its recording so far."""
    keeps_its_promise("disk_full")


def test_a_disk_that_becomes_read_only_ends_the_run_with_what_was_recorded_kept() -> None:
    """When the folder of the recordings cannot be written to any more, the run ends, and says why."""
    keeps_its_promise("disk_read_only")


def test_a_slow_disk_is_waited_for_without_the_robot_noticing() -> None:
    """A disk that takes three seconds to write delays nothing: the run waits for it in memory."""
    keeps_its_promise("disk_slow")


@pytest.mark.parametrize(("fault", "reason"), [("disk_full", "free"), ("disk_read_only", "Read-only")])
def test_a_run_that_could_not_be_recorded_is_refused_before_anything_moves(
    bench: FaultBench, fault: str, reason: str
) -> None:
    """When there is no room for the recording, or no right to write it, no run starts; the rig stays as it is."""
    bench.arm()
    bench.inject(fault)
    with pytest.raises(Refused, match=reason):
        bench.walk_on()
    assert bench.loop.state is RigState.ARMED
    assert bench.archive is not None
    assert list(bench.archive.folder.iterdir()) == []


def test_a_disk_that_falls_too_far_behind_ends_the_run_before_memory_runs_out() -> None:
    """When the disk does not answer for half a minute, ten seconds of the run wait in memory; then the run ends,
    with that cause, and what is written opens."""
    with nothing_left_behind(), recorded(SIMULATED, patient=False) as bench:
        bench.walk()
        fault = bench.inject("disk_slow", delay_s=60.0)
        stopped = bench.until(lambda snapshot: snapshot.rig is not RigState.RUNNING, within=40.0)
        assert stopped.rig is RigState.DISARMED
        assert "the disk is too slow" in stopped.reason
        assert stopped.time - fault * 1e-3 >= LONGEST_WAIT
        bench.run_for(0.5)
        check_stopped(bench, stopped.time)
        bench.mend("disk_slow")
        check_recording(bench.recording_at_the_end(), fault * 1e-3)


def check_stopped(bench: FaultBench, noticed: float) -> None:
    """I1 to I4, and I6. noticed: rig time, s."""
    trace, electrics = bench.trace, bench.electrics
    check_limits(trace.samples, electrics)
    zero = check_zero(trace, electrics, round(noticed * 1e3) - FRAME)
    check_stays_zero(trace, zero)
    check_announced(trace, "recording", noticed - 0.1)
    check_period(trace.snapshots, lambda _: False)


@pytest.mark.parametrize("fault", ["disk_full", "disk_read_only", "disk_slow"])
def test_where_nothing_is_recorded_the_disk_does_not_matter(fault: str) -> None:
    """With recording switched off in the rig file the robot walks whatever the disk does."""
    settings = RigFile.model_validate({"recording": {"enabled": False}}).with_simulation(seed=3)
    with nothing_left_behind(), recorded(settings) as bench:
        bench.inject(fault)
        bench.walk()
        assert bench.react(fault).after is RigState.RUNNING
        assert bench.archive is not None
        assert list(bench.archive.folder.glob("*.mcap")) == []


class Mistaken(Recorder):
    """A recorder with a mistake in it."""

    def event(self, line: Announcement) -> None:
        if line.code == "injected":
            raise ZeroDivisionError("a mistake of the program")
        super().event(line)


def test_a_recorder_with_a_mistake_ends_the_run_and_nothing_else() -> None:
    """When the recorder itself fails, no tick is missed; a run that must be recorded ends, and says why."""
    with nothing_left_behind(), TemporaryDirectory() as folder:
        archive = Archive.open(Path(folder))
        recorder = Mistaken(archive.folder, archive.catalogue, patient=True)
        bench = FaultBench(SIMULATED, replace(archive, recorder=recorder))
        bench.walk()
        reaction = bench.react("flicker")
        assert (reaction.after, reaction.code) == (RigState.DISARMED, "recording"), reaction
        assert "ZeroDivisionError" in reaction.reason
        check_stopped(bench, reaction.fault * 1e-3 + FRAME * 1e-3)
        (id,) = bench.runs
        assert recorder.written(id, 10.0)
        record = archive.catalogue.get(id)
        assert (record.state, record.recording_state) == ("aborted", "complete")
        bench.machine.close()
        recorder.close()
        archive.close()


def test_a_run_that_lost_its_recording_says_so_in_it(bench: FaultBench) -> None:
    """What was kept of such a run names the cause of its end, where the disk still takes that."""
    bench.walk()
    bench.inject("disk_full")
    bench.until(lambda snapshot: snapshot.rig is RigState.DISARMED)
    assert bench.snapshot.recording.state == "failed"
    assert bench.snapshot.recording.failure in bench.snapshot.reason
    bench.mend("disk_full")
    with Recording.open(bench.recording_at_the_end()) as recording:
        assert recording.duration > 0.5
