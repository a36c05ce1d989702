"""A recording that was cut or damaged anywhere: what is whole is read, and nothing else happens."""

import os
import random
import shutil
import time
import tracemalloc
from pathlib import Path

import pytest
from mcap.records import Chunk
from mcap_doctor import placed
from recordings_bench import RecordingsBench, Walk
from torn_files import (
    HUGE,
    damaged,
    is_recording,
    newest_tick,
    read_all,
    small_recording,
    ticks_of,
    with_lengths,
)

SMALL = 100_000
"""Bytes of the file that is cut at every offset: settings and schemas of a whole recording are 60 kB already."""
MEMORY = 16 << 20
"""Bytes that reading a small file may take at most, whatever it claims: a decompressed chunk and a window."""
READ_WITHIN = 10.0
"""s, on a busy computer; it takes 2 ms."""


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    path = small_recording(tmp_path_factory.mktemp("small"))
    assert path.stat().st_size <= SMALL
    return path


@pytest.fixture(scope="module")
def long(tmp_path_factory):
    data = tmp_path_factory.mktemp("long")
    id = RecordingsBench().record(data, Walk(duration=60.0, rate=12.0, frame_rate=0.5))
    return data / "recordings" / f"{id}.mcap"


def ends_of_chunks(path):
    """Where each chunk ends, and how many ticks stand in the file until there, by the public library."""
    times = [utc_of(tick) for tick in read_all(path)]
    chunks = [(at + length, record) for at, length, record in placed(path) if isinstance(record, Chunk)]
    return [(end, sum(time <= chunk.message_end_time for time in times)) for end, chunk in chunks]


def utc_of(tick):
    """UTC of a tick, ns: its pose carries it."""
    stamp = tick["/pose"]["timestamp"]
    return stamp["sec"] * 1_000_000_000 + stamp["nsec"]


def ticks_before(ends, cut):
    return max((ticks for end, ticks in ends if end <= cut), default=0)


def check_cut(whole, ends, path, cut, read):
    """Exactly the ticks of the chunks before the cut are read."""
    os.truncate(path, cut)
    began = time.monotonic()
    found = read(path)
    assert time.monotonic() - began < READ_WITHIN
    assert found == whole[: ticks_before(ends, cut)], f"cut at {cut}"


def every(step, size):
    """Places to cut at, from the end of a file to its beginning."""
    return range(size - 1, -1, -step)


@pytest.mark.timeout(1200)
def test_a_file_cut_anywhere_keeps_every_chunk_before_the_cut(small, tmp_path, full):
    whole, ends, path = read_all(small), ends_of_chunks(small), copied(small, tmp_path)
    assert len(whole) == ends[-1][1] > 20
    for cut in every(1 if full else 401, small.stat().st_size):
        check_cut(whole, ends, path, cut, read_all if cut % 50 == 0 else ticks_of)


def test_a_file_cut_around_the_end_of_each_chunk_keeps_it_once_it_is_whole(small, tmp_path):
    whole, ends, path = read_all(small), ends_of_chunks(small), copied(small, tmp_path)
    for end, _ in reversed(ends):
        for cut in (end + 1, end, end - 1):
            check_cut(whole, ends, path, cut, read_all)


def copied(path, folder):
    return Path(shutil.copy(path, folder / "cut.mcap"))


def test_a_long_file_cut_anywhere_ends_with_the_last_whole_chunk(long, tmp_path, full):
    whole, ends, path = read_all(long), ends_of_chunks(long), copied(long, tmp_path)
    chance, size = random.Random(24), long.stat().st_size
    for cut in sorted((chance.randrange(size) for _ in range(1000 if full else 100)), reverse=True):
        os.truncate(path, cut)
        ticks = ticks_before(ends, cut)
        assert newest_tick(path) == (whole[ticks - 1] if ticks else {}), f"cut at {cut}"


def measured(path):
    """Most bytes that were taken while a file was read."""
    tracemalloc.start()
    try:
        began = time.monotonic()
        read_all(path)
        assert time.monotonic() - began < READ_WITHIN
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_damaged_file_is_read_as_far_as_it_makes_sense_and_takes_little_memory(small, tmp_path, full):
    path = tmp_path / "damaged.mcap"
    for data in damaged(small.read_bytes(), 3000 if full else 60, seed=23):
        path.write_bytes(data)
        assert measured(path) < MEMORY


@pytest.mark.parametrize("length", HUGE)
def test_a_record_that_claims_any_length_takes_little_memory(small, tmp_path, length, full):
    path = tmp_path / "claims.mcap"
    for number, data in enumerate(with_lengths(small, length)):
        if full or number % 16 == length % 13:
            path.write_bytes(data)
            assert measured(path) < MEMORY


def test_a_file_that_is_no_recording_is_none(tmp_path):
    path = tmp_path / "other.mcap"
    for content in (b"", b"\x89", b"PNG and so on" * 100, bytes(5000)):
        path.write_bytes(content)
        assert not is_recording(path)
        assert read_all(path) == []
    assert not is_recording(tmp_path / "missing.mcap")
    assert not is_recording(tmp_path)
