"""The raw traffic log: everything is in it, it is bounded, and the rig does not notice it."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from link_bench import COMMAND, Rig, rig, until

from control.link.traffic import (
    KEPT_FILES,
    LAST_NOTES,
    MAGIC,
    MOST_NOTES,
    Entry,
    Kind,
    NotATrafficLog,
    TrafficLog,
    in_words,
    packed,
    read_log,
    rotate,
)
from control.link.wire import Decoder


@pytest.fixture
def bench() -> Iterator[Rig]:
    with rig() as made:
        yield made


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "not yet there" / "link-traffic.log"


def logged(bench: Rig, file: Path) -> TrafficLog:
    traffic = TrafficLog(file, lambda: bench.now)
    bench.link.put_before(traffic.wrap)
    return traffic


def words(file: Path) -> list[str]:
    return list(in_words(read_log(file)))


def test_every_message_of_a_conversation_is_in_the_log_in_its_order(bench: Rig, file: Path) -> None:
    traffic = logged(bench, file)
    bench.driving()
    bench.link.stop()
    bench.tick(2)
    bench.link.close()
    traffic.close()
    entries = list(read_log(file))
    assert [entry.time for entry in entries] == sorted(entry.time for entry in entries)
    for kind, count in ((Kind.TO_BOARD, bench.link.status.counts.sent), (Kind.FROM_BOARD, None)):
        stream = b"".join(entry.data for entry in entries if entry.kind is kind)
        packets = Decoder().feed(stream)
        assert len(packets) == (count or bench.link.status.counts.received)
    lines = words(file)
    assert "board ->  #0 boot 40  Banner(" in lines[0]
    assert "-> board  #1 boot 0  Hello()" in lines[1]
    assert sum("Drive(" in line for line in lines) == 11
    assert "Stop()" in lines[-1]
    assert sum("board ->" in line and "Banner(" in line for line in lines) == 3


def test_a_line_that_is_opened_again_goes_on_in_the_same_file(bench: Rig, file: Path) -> None:
    traffic = logged(bench, file)
    bench.ready()
    bench.board.unplug()
    bench.tick(60)
    bench.board.plug()
    bench.tick(60)
    bench.link.close()
    traffic.close()
    assert sum("Hello()" in line for line in words(file)) == 2
    assert not file.with_name("link-traffic.log.1").exists()


def test_a_log_of_before_is_kept(bench: Rig, file: Path) -> None:
    for _ in range(2):
        traffic = TrafficLog(file, lambda: bench.now)
        traffic.note(Kind.TO_BOARD, b"\x05")
        traffic.wrap(bench.link._serial or NO_PORT)
        traffic.close()
    assert len(list(read_log(file))) == len(list(read_log(file.with_name("link-traffic.log.1")))) == 1


class _NoPort:
    """A line that nothing is asked of."""

    in_waiting = out_waiting = 0

    def read(self, _size: int = 1, /) -> bytes:
        return b""

    def write(self, b: bytes, /) -> int:
        return len(b)

    def reset_output_buffer(self) -> None: ...
    def close(self) -> None: ...


NO_PORT = _NoPort()


def test_files_are_bounded_and_the_oldest_goes(file: Path) -> None:
    traffic = TrafficLog(file, time.monotonic, largest=1000)
    port = traffic.wrap(NO_PORT)
    for number in range(KEPT_FILES + 2):
        for _ in range(5):
            port.write(bytes([number]) * 250)
        assert until(lambda n=number: not traffic._notes and n >= 0)
    traffic.close()
    kept = sorted(path.name for path in file.parent.iterdir())
    assert kept == ["link-traffic.log", *(f"link-traffic.log.{n}" for n in range(1, KEPT_FILES))]
    assert all(path.stat().st_size < 1000 + 5 * 300 for path in file.parent.iterdir())


def test_rotation_moves_each_file_one_on(tmp_path: Path) -> None:
    file = tmp_path / "log"
    for number in range(KEPT_FILES + 1):
        file.write_text(str(number))
        rotate(file)
        assert not file.exists()
    there = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert there == {f"log.{n}": str(KEPT_FILES + 1 - n) for n in range(1, KEPT_FILES)}


def test_a_writer_that_cannot_keep_up_loses_notes_counts_them_and_says_so(file: Path) -> None:
    traffic = TrafficLog(file, lambda: 1.5)
    for _ in range(MOST_NOTES + 7):
        traffic.note(Kind.TO_BOARD, b"\x05")
    traffic.wrap(NO_PORT)
    traffic.close()
    assert len(list(read_log(file))) == MOST_NOTES + 1
    assert words(file)[-1].endswith("7 entries are missing here")


def test_a_disk_that_hangs_does_not_hold_up_the_end_of_the_rig(file: Path) -> None:
    disk_comes_back = threading.Event()

    def clock() -> float:
        """The writer itself asks for the time only when it notes that entries are missing."""
        if threading.current_thread().name == "traffic log":
            disk_comes_back.wait()
        return 1.5

    traffic = TrafficLog(file, clock)
    for _ in range(MOST_NOTES + 1):
        traffic.note(Kind.TO_BOARD, b"\x05")
    traffic.wrap(NO_PORT)
    begin = time.monotonic()
    traffic.close()
    assert LAST_NOTES <= time.monotonic() - begin < LAST_NOTES + 1.0
    disk_comes_back.set()


@pytest.mark.exclusive
def test_a_note_takes_no_time_worth_mentioning(file: Path) -> None:
    """A tick has two; a microsecond each on a quiet computer."""
    traffic = TrafficLog(file, time.monotonic)
    port = traffic.wrap(NO_PORT)
    begin = time.perf_counter()
    for _ in range(2000):
        port.write(b"\x05" * 57)
    took = time.perf_counter() - begin
    traffic.close()
    assert took / 2000 < 50e-6


def test_a_folder_that_cannot_be_written_stops_the_log_and_not_the_rig(bench: Rig, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    traffic = logged(bench, tmp_path / "file" / "link-traffic.log")
    bench.driving()
    bench.link.close()
    traffic.close()
    assert "the traffic log stopped" in traffic.problem
    assert len(traffic._notes) <= MOST_NOTES


def test_broken_frames_show_with_their_bytes(file: Path) -> None:
    file.parent.mkdir()
    entries = [Entry(1.0, Kind.FROM_BOARD, b"\x00\x05ab\x00"), Entry(2.0, Kind.TO_BOARD, b"\x05" * 65)]
    file.write_bytes(MAGIC + b"".join(map(packed, entries)))
    first, second = words(file)
    assert "board ->  1 broken (encoding) in 00 05 61 62 00" in first
    assert "-> board  1 broken (oversize)" in second


@given(
    st.lists(st.tuples(st.sampled_from((Kind.FROM_BOARD, Kind.TO_BOARD)), st.binary(max_size=80))), st.data()
)
@settings(max_examples=60, deadline=None, derandomize=True)
def test_a_torn_file_gives_every_whole_entry(
    tmp_path_factory: pytest.TempPathFactory, pieces: list[tuple[Kind, bytes]], data: st.DataObject
) -> None:
    entries = [Entry(float(number), kind, piece) for number, (kind, piece) in enumerate(pieces)]
    ends = [len(MAGIC)]
    for entry in entries:
        ends.append(ends[-1] + len(packed(entry)))
    cut = data.draw(st.integers(len(MAGIC), ends[-1]))
    file = tmp_path_factory.getbasetemp() / "torn.log"
    file.write_bytes((MAGIC + b"".join(map(packed, entries)))[:cut])
    assert list(read_log(file)) == entries[: sum(end <= cut for end in ends[1:])]


def test_an_entry_of_an_unknown_kind_ends_the_reading(file: Path) -> None:
    file.parent.mkdir()
    good = Entry(1.0, Kind.TO_BOARD, b"\x05")
    file.write_bytes(MAGIC + packed(good) + packed(replace(good, kind=9)) + packed(good))  # type: ignore[arg-type]
    assert list(read_log(file)) == [good]


def test_the_command_prints_a_log_and_refuses_another_file(bench: Rig, file: Path) -> None:
    traffic = logged(bench, file)
    bench.ready()
    bench.link.drive(replace(COMMAND, start_heading=0.0))
    bench.link.close()
    traffic.close()
    command = [sys.executable, "-m", "control.link.traffic"]
    printed = subprocess.run([*command, str(file)], capture_output=True, text=True, check=True).stdout
    assert printed.splitlines() == words(file)
    other = file.with_name("other")
    other.write_text("hello, world")
    for wrong, complaint in ((other, "is no traffic log"), (file.with_name("gone"), "No such file")):
        refused = subprocess.run([*command, str(wrong)], capture_output=True, text=True, check=False)
        assert refused.returncode == 1
        assert complaint in refused.stderr
    with pytest.raises(NotATrafficLog):
        list(read_log(other))
