"""A recording is read anywhere, in little time and little memory, also while it grows."""

import time
import tracemalloc

import cv2
import numpy as np
import pytest
from mcap.reader import make_reader
from recordings_bench import ZERO, RecordingsBench, Walk
from torn_files import is_recording

from server.archive import Archive
from server.recording.reading.recording import Recording, Unreadable

DURATION, RATE, FRAME_RATE = 5.0, 60.0, 10.0
OPENS_WITHIN = 1.0
"""s on a busy computer; an hour with 14 400 chunks takes 0.15 s."""
READING_TAKES = 48 << 20
"""Bytes at most, however long the recording: the chunks at hand, and where the others are."""


@pytest.fixture(scope="module")
def bench():
    return RecordingsBench()


@pytest.fixture(scope="module")
def path(bench, tmp_path_factory):
    data = tmp_path_factory.mktemp("data")
    id = bench.record(data, Walk(DURATION, RATE, FRAME_RATE))
    return data / "recordings" / f"{id}.mcap"


@pytest.fixture
def recording(path):
    with Recording.open(path) as opened:
        yield opened


@pytest.fixture(scope="module")
def hour(bench, tmp_path_factory, full):
    """An hour, in 14 400 chunks as the rig's or, to be quick, in 1 800; there is one tick in each."""
    data = tmp_path_factory.mktemp("hour")
    id = bench.record(data, Walk(duration=3600.0, rate=4.0 if full else 0.5, frame_rate=0.1))
    return data / "recordings" / f"{id}.mcap"


def times(ticks):
    return [tick["/state"]["time_s"] - ZERO for tick in ticks]


def test_what_is_read_is_what_the_public_reader_reads(path, recording):
    with path.open("rb") as file:
        public = [
            (channel.topic, message.log_time, message.data)
            for _, channel, message in make_reader(file).iter_messages(log_time_order=False)
        ]
    ours = [(entry.topic, entry.log_time) for entry in recording.messages()]
    assert ours == [(topic, log_time) for topic, log_time, _ in public]
    assert recording.damaged_chunks == recording.unread_messages == 0


def test_the_facts_of_the_run_stand_in_the_file(recording):
    walk = Walk(DURATION, RATE, FRAME_RATE)
    assert recording.is_whole
    assert recording.started_at == walk.started
    assert recording.settings["run"]["id"] == recording.metadata["run"] == walk.id
    assert recording.outcome["state"] == "finished"
    assert recording.outcome["ticks"] == len(list(recording.ticks()))
    assert recording.duration == pytest.approx(DURATION + 0.5, abs=2 / RATE)
    assert recording.overview["time_s"][-1] == pytest.approx(recording.duration, abs=1e-6)


def test_ticks_come_one_by_one_with_all_that_belongs_to_them(recording):
    ticks = list(recording.ticks())
    assert [tick["/state"]["tick"] for tick in ticks] == list(range(1, len(ticks) + 1))
    for tick in ticks[: round(DURATION * RATE)]:
        assert {"/state", "/estimate", "/reference", "/command", "/currents", "/link"} <= set(tick)
        assert not {"/camera", "/events", "/selection"} & set(tick)
        assert {message["tick"] for topic, message in tick.items() if topic != "/link"} == {
            tick["/state"]["tick"]
        }


def test_a_part_of_the_run_begins_and_ends_where_it_is_told(recording):
    part = times(recording.ticks(start=1.0, end=2.0))
    assert part[0] == pytest.approx(1.0, abs=1 / RATE)
    assert part[-1] == pytest.approx(2.0 - 1 / RATE, abs=1 / RATE)
    assert len(part) == RATE
    assert times(recording.ticks()) == [
        time for first in range(6) for time in times(recording.ticks(start=first, end=first + 1))
    ]


def test_some_topics_of_a_tick_are_those_of_the_whole_tick(recording):
    some = list(recording.ticks(topics=["/estimate"]))
    assert some == [{"/estimate": tick["/estimate"]} for tick in recording.ticks()]


def test_the_tick_at_a_time_is_the_newest_that_is_not_later(recording):
    ticks = list(recording.ticks())
    for index in (0, 1, 14, 15, 16, 100, len(ticks) - 1):
        at = times(ticks)[index]
        assert recording.tick_at(at + 1e-4) == ticks[index]
    assert recording.tick_at(1e9) == ticks[-1]
    assert recording.tick_at(-1.0) is None
    assert recording.tick_at(float("nan")) is None


def test_the_frame_at_a_time_is_the_newest_picture_that_is_not_later(recording):
    frames = list(recording.frames())
    assert len(frames) == pytest.approx(DURATION * FRAME_RATE, abs=2)
    for frame in (frames[0], frames[17], frames[-1]):
        assert recording.frame_at(frame.time_s + 1e-4) == frame
        assert frame.captured_s == pytest.approx(frame.time_s - 0.035, abs=1e-4)
    assert recording.frame_at(frames[0].time_s - 1e-3) is None
    image = cv2.imdecode(np.frombuffer(frames[3].jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert image is not None
    assert image.shape == (480, 640, 3)


def test_events_are_told_in_the_words_of_the_event_log(recording):
    first, last = recording.events()
    assert (first["severity"], first["code"], first["message"]) == ("info", "running", "running")
    assert last["message"] == "run finished"
    assert last["time_s"] == pytest.approx(DURATION, abs=2 / RATE)


def test_a_growing_file_is_read_up_to_what_was_written(bench, tmp_path):
    """Each look sees more, never something else, and never waits."""
    archive = Archive.open(tmp_path, patient=True)
    walk, seen = Walk(duration=20.0, rate=30.0, frame_rate=0.0), []  # more ticks than may wait

    def look(snapshot):
        path = archive.path_of(walk.id)
        if snapshot.tick % 50 == 0 and is_recording(path):
            with Recording.open(path) as recording:
                assert not recording.is_whole
                seen.append(times(recording.ticks()))

    try:
        bench.record_in(archive, walk, look)
    finally:
        archive.close()
    with Recording.open(archive.path_of(walk.id)) as recording:
        whole = times(recording.ticks())
    assert max(map(len, seen)) > 30
    for part in seen:
        assert part == whole[: len(part)]
    assert [len(part) for part in seen] == sorted(len(part) for part in seen)


def test_an_hour_opens_and_shows_its_first_tick_and_picture_at_once(hour):
    began = time.monotonic()
    with Recording.open(hour) as recording:
        assert recording.tick_at(2.5) is not None
        assert recording.frame_at(5.0) is not None
        assert time.monotonic() - began < OPENS_WITHIN
        assert recording.duration > 3600.0


def test_a_time_in_an_hour_is_found_by_reading_a_chunk_or_two(hour):
    with Recording.open(hour) as recording:
        for at in (3599.5, 2.5, 1800.5, 900.5):
            before = recording.chunks_read
            tick = recording.tick_at(at)
            assert tick is not None
            assert tick["/state"]["time_s"] - ZERO == pytest.approx(at, abs=2.0)
            assert recording.chunks_read - before <= 2


def test_reading_an_hour_takes_the_memory_of_seconds(hour):
    tracemalloc.start()
    try:
        with Recording.open(hour) as recording:
            assert sum(1 for _ in recording.ticks(topics=["/state"])) >= 1800
        assert tracemalloc.get_traced_memory()[1] < READING_TAKES
    finally:
        tracemalloc.stop()


def test_what_is_no_recording_is_said_in_words(tmp_path):
    path = tmp_path / "other.mcap"
    path.write_bytes(b"something else")
    with pytest.raises(Unreadable, match=r"other\.mcap is no recording"):
        Recording.open(path)
    with pytest.raises(Unreadable, match="cannot be opened: No such file"):
        Recording.open(tmp_path / "missing.mcap")
