"""The recorder as the rig uses it: what is recorded of a run and what is not, and that nothing of it is left behind."""

from __future__ import annotations

import math
import os
import threading
import time
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.metrics import MetricsTally
from control.model import Frame
from control.news import Announcement
from control.runs import Choice, Run, RunRequest, RunState, Selection
from control.snapshot import NOT_RECORDED
from server.archive import Archive
from server.recording.clock import RunClock
from server.recording.reading.recording import Recording
from server.recording.recovery.recover import recover
from server.recording.writing import pictures, session
from server.recording.writing.overview import Overview
from server.recording.writing.pictures import FrameRate
from server.recording.writing.recorder import TAIL
from tests.server.recorded_walk import outcome_of
from tests.server.recordings_bench import LENGTH, ZERO, RecordingsBench, Walk
from vision.encoding import encode_jpeg

RATE = 60.0
STARTED = datetime(2026, 4, 1, 8, 30, tzinfo=UTC)


@pytest.fixture(scope="module")
def bench():
    return RecordingsBench()


@pytest.fixture
def archive(tmp_path):
    archive = Archive.open(tmp_path)
    yield archive
    archive.close()


@pytest.fixture
def hand(bench, archive):
    return Hand(bench, archive)


class Hand:
    """Hands ticks over as the rig does."""

    def __init__(self, bench, archive):
        self.bench = bench
        self.recorder = archive.recorder
        self.tick = 0

    def begin(self, id, **recording):
        run = Run(id, RunRequest(Selection(), label="by hand"), RunState.RUNNING, STARTED)
        made = self.bench.conditions(Walk(frame_rate=0.0))
        section = made.settings.recording.model_copy(update=recording)
        rig_file = made.settings.model_copy(update={"recording": section})
        self.recorder.begin(run, replace(made, settings=rig_file))
        return run

    def walk(self, run, duration):
        for _ in range(round(duration * RATE)):
            self.tick += 1
            self.recorder.tick(
                self.bench.snapshot(run, self.tick, self.tick / RATE, MetricsTally(LENGTH)), None
            )

    def end(self, run):
        self.recorder.end(replace(run, state=RunState.STOPPED, reason="stopped by the operator"))


def topics_of(archive, id, topic):
    with Recording.open(archive.path_of(id)) as recording:
        return [entry.data for entry in recording.messages([topic]) if isinstance(entry.data, dict)]


def test_a_run_is_recorded_for_half_a_second_after_its_end(hand, archive):
    run = hand.begin("tail")
    hand.walk(run, 1.0)
    hand.end(run)
    assert not archive.recorder.written("tail", 0.05)
    hand.walk(run, 2.0)
    assert archive.recorder.written("tail", 10.0)
    with Recording.open(archive.path_of("tail")) as recording:
        assert recording.is_whole
        assert recording.duration == pytest.approx(1.0 + TAIL, abs=2.5 / RATE)
    assert outcome_of(archive.path_of("tail"))["state"] == "stopped"


def test_the_next_run_ends_the_recording_of_the_last_one(hand, archive):
    first = hand.begin("first")
    hand.walk(first, 0.5)
    hand.end(first)
    second = hand.begin("second")
    hand.walk(second, 0.5)
    assert archive.recorder.written("first", 10.0)
    assert archive.recorder.status.run == "second"
    hand.end(second)
    archive.recorder.close()
    for id in ("first", "second"):
        with Recording.open(archive.path_of(id)) as recording:
            assert recording.is_whole
            assert recording.duration <= 0.5 + 1.5 / RATE or id == "second"


def test_closing_finishes_what_is_recorded(hand, archive):
    run = hand.begin("closed")
    hand.walk(run, 1.0)
    archive.recorder.close()
    archive.recorder.close()
    with Recording.open(archive.path_of("closed")) as recording:
        assert recording.is_whole
        assert len(list(recording.ticks())) == 60


def test_nothing_is_recorded_without_a_run(hand, archive):
    run = Run("nobody", RunRequest(Selection()), RunState.RUNNING, STARTED)
    hand.walk(run, 0.5)
    hand.recorder.event(Announcement(ZERO, "info", "armed", "ready to start"))
    hand.end(run)
    assert archive.recorder.status is NOT_RECORDED
    assert archive.recorder.written("nobody", 0.0)
    assert not list(archive.folder.iterdir())


def test_a_run_that_is_not_to_be_recorded_is_listed_all_the_same(hand, archive):
    run = hand.begin("listed", enabled=False)
    hand.walk(run, 0.5)
    assert archive.recorder.status is NOT_RECORDED
    hand.end(run)
    hand.walk(run, 1.0)
    assert archive.recorder.written("listed", 10.0)
    row = archive.catalogue.get("listed")
    assert (row.recording_state, row.state, row.reason) == ("none", "stopped", "stopped by the operator")
    assert len(row.sparkline) > 10
    assert not list(archive.folder.iterdir())


def listed(archive, id):
    """The run, once the recorder has come to listing it."""
    give_up = time.monotonic() + 10.0
    while not archive.catalogue.known([id]):
        assert time.monotonic() < give_up
        time.sleep(0.005)
    return archive.catalogue.get(id)


@pytest.mark.parametrize("enabled", [True, False])
def test_a_run_that_goes_on_is_never_taken_for_one_that_was_interrupted(hand, archive, enabled):
    """Another program that starts meanwhile looks for what was left behind."""
    run = hand.begin("alive", enabled=enabled)
    assert listed(archive, "alive").is_going_on
    hand.walk(run, 0.2)
    assert recover(archive.folder, archive.catalogue) == []
    hand.end(run)
    hand.walk(run, 1.0)
    assert archive.recorder.written("alive", 10.0)
    assert recover(archive.folder, archive.catalogue) == []
    assert archive.catalogue.get("alive").state == "stopped"


@pytest.mark.parametrize("enabled", [True, False])
def test_a_run_whose_row_was_lost_is_listed_again_at_its_end(hand, archive, enabled):
    run = hand.begin("lost", enabled=enabled)
    before = listed(archive, "lost")
    archive.catalogue.delete("lost")
    hand.walk(run, 0.5)
    hand.end(run)
    hand.walk(run, 1.0)
    assert archive.recorder.written("lost", 10.0)
    row = archive.catalogue.get("lost")
    assert (row.state, row.recording_state) == ("stopped", "complete" if enabled else "none")
    assert (row.label, row.selection, row.settings) == (before.label, before.selection, before.settings)
    assert row.ended_at is not None


def test_what_is_told_before_the_first_tick_is_recorded_too(hand, archive):
    run = hand.begin("early")
    hand.recorder.event(Announcement(ZERO, "warn", "heat", "a coil is warm"))
    hand.walk(run, 0.5)
    archive.recorder.close()
    (line,) = topics_of(archive, "early", "/events")
    assert (line["name"], line["level"], line["message"]) == ("heat", 3, "a coil is warm")


def test_another_selection_on_the_way_is_recorded_with_its_path(hand, archive):
    run = hand.begin("changed")
    hand.walk(run, 0.5)
    circle = replace(run.request, selection=Selection(trajectory=Choice("circle")))
    hand.recorder.change(replace(run, request=circle))
    hand.walk(run, 0.5)
    archive.recorder.close()
    before, after = topics_of(archive, "changed", "/selection")
    assert (before["trajectory"], after["trajectory"]) == ("eight", "circle")
    assert before["reference_x_mm"] != after["reference_x_mm"]
    assert before["time_s"] < after["time_s"]
    assert archive.catalogue.get("changed").trajectory == "circle"


def test_no_thread_and_no_file_is_left_open(hand, archive):
    handles = set(os.listdir("/proc/self/fd"))
    threads = set(threading.enumerate())
    run = hand.begin("gone")
    hand.walk(run, 0.5)
    archive.recorder.close()
    assert set(threading.enumerate()) <= threads
    left = [os.readlink(f"/proc/self/fd/{each}") for each in set(os.listdir("/proc/self/fd")) - handles
            if os.path.lexists(f"/proc/self/fd/{each}")]  # fmt: skip
    assert not [name for name in left if name.endswith(".mcap")]


def test_a_broken_picture_is_left_out_and_counted(hand, archive):
    run = hand.begin("odd", frames_Hz=10.0)
    snapshot = hand.bench.snapshot(run, 1, 1.0 / RATE, MetricsTally(LENGTH))
    hand.recorder.tick(snapshot, Frame(np.zeros((0, 0, 3), np.uint8), snapshot.time, 1))
    hand.walk(run, 0.5)
    archive.recorder.close()
    outcome = outcome_of(archive.path_of("odd"))
    assert (outcome["frames"], outcome["frames_left_out"]) == (0, 1)
    assert outcome["failure"] == ""


@given(
    camera=st.floats(10.0, 240.0),
    wanted=st.floats(0.5, 240.0),
    seed=st.integers(0, 1000),
)
@settings(deadline=None, max_examples=50)
def test_pictures_are_chosen_evenly_at_the_rate_that_is_asked_for(camera, wanted, seed):
    rate = FrameRate(wanted)
    jitter = np.random.default_rng(seed).uniform(-0.3, 0.3, 400)
    times = [(index + shift) / camera for index, shift in enumerate(jitter.tolist())]
    taken = [time for time in times if rate.takes(time)]
    expected = min(wanted, camera) * (times[-1] - times[0])
    assert len(taken) == pytest.approx(expected, rel=0.02, abs=2.0) or wanted > 0.9 * camera
    assert len(taken) <= expected * 1.02 + 2.0


def test_a_camera_at_the_rate_that_is_asked_for_loses_no_picture_to_its_jitter():
    rate = FrameRate(60.0)
    times = [index / 60.0 + (0.004 if index % 2 else -0.004) for index in range(600)]
    assert all(rate.takes(time) for time in times)


def test_no_pictures_are_taken_at_a_rate_of_zero():
    assert not FrameRate(0.0).takes(1.0)


@given(st.lists(st.floats(0.0, 1e5), min_size=1, max_size=20))
@settings(deadline=None, max_examples=50)
def test_log_times_go_on_even_where_rig_time_stands_still(steps):
    clock = RunClock(STARTED, 5.0)
    newest = clock.start - 1
    time = 5.0
    for step in steps:
        time += step
        utc = clock.tick(time)
        assert utc > newest
        assert utc - clock.start == pytest.approx((time - 5.0) * 1e9, abs=len(steps) + 1)
        newest = utc


@given(st.integers(1, 5_000), st.integers(10, 100))
@settings(deadline=None, max_examples=50)
def test_an_overview_is_small_evenly_spread_and_complete_at_both_ends(count, most):
    overview = Overview(most)
    for index in range(count):
        overview.add(index * 0.1, lambda index=index: {"error_mm": float(index)})
    found = overview.as_json()
    times = [time for time in found["time_s"] if time is not None]
    assert len(times) <= most
    assert len(times) >= min(count, most // 2 - 1)
    assert times[0] == 0.0
    assert times[-1] == pytest.approx((count - 1) * 0.1)
    strides = {round((later - earlier) * 10) for earlier, later in pairwise(times[:-1])}
    assert len(strides) <= 1
    assert found["error_mm"] == pytest.approx([time * 10 for time in times])
    assert len(overview.sparkline()) == min(len(times), 60)


@pytest.mark.parametrize("stamp", [math.inf, -math.inf, math.nan, 1e9, -1e9])
def test_a_picture_whose_stamp_is_wrong_costs_neither_the_recording_nor_the_pictures_after_it(
    hand, archive, stamp
):
    run = hand.begin("stamped", frames_Hz=60.0)
    for tick in range(1, 31):
        snapshot = hand.bench.snapshot(run, tick, tick / RATE, MetricsTally(LENGTH))
        captured = stamp if tick == 10 else snapshot.time - 0.02
        hand.recorder.tick(snapshot, Frame(np.zeros((48, 64, 3), np.uint8), captured, tick))
        time.sleep(0.002)
    assert archive.recorder.failure == ""
    archive.recorder.close()
    outcome = outcome_of(archive.path_of("stamped"))
    assert (outcome["ticks"], outcome["failure"]) == (30, "")
    assert 27 <= outcome["frames"] + outcome["frames_left_out"] <= 30


def test_a_rig_that_becomes_another_one_ends_the_recording_of_its_last_run(hand, archive):
    """Its clock starts anew, and its ticks are not those of the run."""
    run = hand.begin("former")
    hand.walk(run, 0.5)
    hand.end(run)
    hand.recorder.finish()
    hand.tick = 0
    hand.walk(run, 0.2)
    assert archive.recorder.written("former", 10.0)
    assert archive.recorder.status is NOT_RECORDED
    ticks = [state["tick"] for state in topics_of(archive, "former", "/state")]
    assert ticks == list(range(1, 31))


def test_the_end_of_a_run_is_dated_by_the_time_since_its_start_whoever_sets_the_clock(hand, archive):
    """The start is of another year: as if this computer's clock had been set meanwhile."""
    run = hand.begin("dated")
    hand.walk(run, 0.5)
    hand.end(run)
    archive.recorder.close()
    ended = archive.catalogue.get("dated").ended_at
    assert ended is not None
    assert timedelta(0) <= ended - STARTED < timedelta(seconds=20)


def test_a_picture_that_comes_after_the_end_is_counted_and_touches_no_closed_file(
    hand, archive, monkeypatch, caplog
):
    monkeypatch.setattr(session, "LAST_PICTURES", 0.05)
    may_go_on = threading.Event()

    def encode(image, quality):
        may_go_on.wait(10.0)
        return encode_jpeg(image, quality)

    monkeypatch.setattr(pictures, "encode_jpeg", encode)
    run = hand.begin("late", frames_Hz=60.0)
    snapshot = hand.bench.snapshot(run, 1, 1.0 / RATE, MetricsTally(LENGTH))
    hand.recorder.tick(snapshot, Frame(np.zeros((48, 64, 3), np.uint8), snapshot.time, 1))
    hand.walk(run, 0.5)
    hand.end(run)
    hand.walk(run, 1.0)
    assert archive.recorder.written("late", 10.0)
    may_go_on.set()
    archive.recorder.close()
    assert "mistake" not in caplog.text
    assert caplog.records == []
    outcome = outcome_of(archive.path_of("late"))
    assert (outcome["frames"], outcome["frames_left_out"]) == (0, 1)
