"""The link and a board over `sim://`: greeting, driving, resets, unplugging, jams, stops."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from dataclasses import replace

import pytest
from link_bench import COMMAND, CONFIGURATION, Rig, drive_times, rig

from control.link import wire
from control.link.conversion import BoardState, LinkError
from control.link.line import SerialLine
from control.link.messages import Banner, BoardCode, Hello
from control.link.port import LAST_WORDS, MOST_BYTES, Link
from control.link.session import LinkState, Session


@pytest.fixture
def bench() -> Iterator[Rig]:
    with rig() as made:
        yield made


def test_a_link_is_closed_until_it_is_opened(bench: Rig) -> None:
    assert bench.link.status.state == "closed"
    assert bench.tick() is None
    with pytest.raises(LinkError, match="closed"):
        bench.link.drive(COMMAND)
    bench.link.stop()


def test_a_link_greets_and_configures_the_board_and_is_ready(bench: Rig) -> None:
    bench.link.open()
    assert bench.link.status.state == "greeting"
    states = []
    while bench.link.status.state != "ready":
        bench.tick()
        states.append(bench.link.status.state)
        assert len(states) < 10
    assert states == sorted(states, key=["greeting", "configuring", "ready"].index)
    assert bench.link.status.firmware == "0.1.0"
    assert bench.link.status.boot_id == 40
    assert bench.link.reason == ""
    assert bench.board.state == BoardCode.READY


def test_a_ready_board_reports_in_si(bench: Rig) -> None:
    report = bench.driving().tick(5)
    assert report is not None
    assert report.state == BoardState.DRIVING
    assert report.received_at == bench.now
    assert report.board_time == pytest.approx(bench.now, abs=0.02)
    assert report.elevation == pytest.approx(-COMMAND.tilt, abs=1e-4)
    assert report.heading == 0.0
    assert report.supply == pytest.approx(24.0, abs=0.054)  # one count
    assert report.currents[1] == pytest.approx(report.measured_currents[1], abs=0.2)
    assert bench.link.status.board_state == "driving"
    assert bench.link.status.board_faults == ()


def test_the_round_trip_is_measured_from_drive_to_echo(bench: Rig) -> None:
    bench.driving()
    assert bench.link.status.round_trip is not None
    assert 0.0 < bench.link.status.round_trip <= 0.032


def test_a_drive_before_the_board_is_ready_is_refused_with_the_reason(bench: Rig) -> None:
    bench.link.open()
    with pytest.raises(LinkError, match="greeting"):
        bench.link.drive(COMMAND)


def test_a_command_outside_the_limits_is_refused_and_the_board_hears_nothing(bench: Rig) -> None:
    bench.driving()
    bench.tick()
    waiting = bench.board.room
    for command in (replace(COMMAND, rate=2.1), replace(COMMAND, tilt=float("nan"))):
        with pytest.raises(LinkError, match="allowed is"):
            bench.link.drive(command)
    assert bench.board.room == waiting
    bench.drive_on(3)
    report = bench.tick()
    assert report is not None
    assert report.refused == report.stale == 0


def test_a_reset_board_is_greeted_again_and_not_armed_again(bench: Rig) -> None:
    bench.driving()
    bench.board.reset()
    bench.tick()
    assert "boot id 40 -> 41" in bench.link.reason
    with pytest.raises(LinkError, match="reset"):
        bench.link.drive(COMMAND)
    bench.tick(6)
    assert bench.link.is_ready
    assert "boot id 40 -> 41" in bench.link.incident
    bench.drive_on(10)
    assert bench.board.state == BoardCode.READY
    assert bench.board.drive_is_zero
    bench.link.drive(replace(COMMAND, start_heading=0.0))
    bench.tick()
    assert bench.board.state == BoardCode.DRIVING
    assert bench.link.incident == ""


def test_a_reset_whose_banner_is_lost_is_noticed_by_the_silence(bench: Rig) -> None:
    bench.driving()
    bench.board.reset()
    bench.board.advance(5)
    bench.board.read(4096)
    bench.tick(40)
    assert "no telemetry" in bench.link.incident
    assert bench.link.is_ready
    assert bench.link.status.boot_id == 41
    assert bench.board.drive_is_zero


def test_an_unplugged_port_closes_the_link_and_the_board_zeroes_itself(bench: Rig) -> None:
    bench.driving()
    bench.board.unplug()
    assert bench.tick() is None
    assert bench.link.status.state == "closed"
    assert "unplugged" in bench.link.reason
    with pytest.raises(LinkError, match="unplugged"):
        bench.link.drive(COMMAND)
    bench.tick(12)
    assert bench.board.drive_is_zero
    assert bench.board.state == BoardCode.EXPIRED


def test_a_port_that_is_plugged_in_again_is_found_again_and_stays_at_rest(bench: Rig) -> None:
    bench.driving()
    bench.board.unplug()
    bench.tick(100)
    bench.board.plug()
    bench.tick(400)
    assert bench.link.is_ready
    assert bench.board.state == BoardCode.READY
    assert bench.board.drive_is_zero


def test_attempts_to_reopen_a_port_become_rare_but_never_end(bench: Rig) -> None:
    """0.5 s after the loss, then after 1, 2, 4 and 5 s: nothing is found in between."""
    bench.ready()
    bench.board.unplug()
    bench.tick()
    lost_at = bench.now
    tried_at = []
    while bench.now - lost_at < 30.0:
        before = bench.link._retry_at
        bench.tick()
        if bench.link._retry_at != before:
            tried_at.append(bench.now - lost_at)
    assert tried_at == pytest.approx([0.5, 1.5, 3.5, 7.5, 12.5, 17.5, 22.5, 27.5], abs=0.15)


def test_a_closed_link_does_not_reopen_its_port(bench: Rig) -> None:
    bench.driving()
    bench.link.close()
    bench.tick(1000)
    assert bench.link.status.state == "closed"
    assert bench.board.drive_is_zero


def test_closing_stops_the_board_first(bench: Rig) -> None:
    bench.driving()
    bench.link.close()
    bench.board.advance(2)
    assert bench.board.state == BoardCode.STOPPED


def test_a_stop_from_another_thread_zeroes_the_board(bench: Rig) -> None:
    bench.driving()
    thread = threading.Thread(target=bench.link.stop)
    thread.start()
    thread.join()
    bench.board.advance(3)
    assert bench.board.drive_is_zero
    bench.drive_on(5)
    assert bench.board.state == BoardCode.STOPPED


def test_a_stop_during_a_write_is_sent_by_the_writer(bench: Rig) -> None:
    """The stop finds the line taken, does not wait, and goes out when the write ends."""
    bench.driving()
    bench.tick()
    original = bench.board.write

    def write_and_be_stopped(data: bytes) -> None:
        bench.board.write = original
        before = time.monotonic()
        thread = threading.Thread(target=bench.link.stop)
        thread.start()
        thread.join(1.0)
        assert time.monotonic() - before < 0.5
        original(data)

    bench.board.write = write_and_be_stopped
    bench.link.drive(COMMAND)
    bench.board.advance(3)
    assert bench.board.state == BoardCode.STOPPED


def test_closing_sends_the_stop_although_somebody_is_writing(bench: Rig) -> None:
    """The port is closed as soon as the writer lets go of it; the stop must not be left to the writer."""
    bench.driving()
    bench.tick()
    original = bench.board.write
    closing = threading.Thread(target=bench.link.close)

    def write_while_closing(data: bytes) -> None:
        bench.board.write = original
        closing.start()
        closing.join(0.1)
        original(data)
        bench.link._send_due_stop = lambda: None  # this writer is too slow to send the stop itself

    bench.board.write = write_while_closing
    bench.link.drive(COMMAND)
    closing.join(5.0)
    bench.board.advance(3)
    assert bench.board.state == BoardCode.STOPPED


def test_a_port_in_use_is_refused_by_name(bench: Rig) -> None:
    bench.ready()
    other = Link(bench.link.port, 500000, CONFIGURATION, lambda: 0.0)
    with pytest.raises(LinkError, match=rf"{bench.link.port}.*in use"):
        other.open()
    assert other.status.state == "closed"
    other.stop()
    other.close()


@pytest.mark.parametrize("port", ["sim://nobody", "/dev/tty-that-is-not", "nonsense://x", ""])
def test_a_port_that_cannot_be_opened_is_an_error_that_names_it(port: str, bench: Rig) -> None:
    link = Link(port, 500000, CONFIGURATION, lambda: bench.now)
    with pytest.raises(LinkError, match="cannot open"):
        link.open()
    assert link.poll() is None


def test_a_jammed_port_is_let_go_of_and_found_again(bench: Rig) -> None:
    bench.driving()
    with pytest.raises(LinkError, match="jammed"):
        drive_times(bench.link, 200)
    assert bench.link.status.state == "closed"
    bench.tick(100)
    assert bench.link.is_ready
    assert bench.board.drive_is_zero


def test_a_board_that_heard_none_of_many_messages_is_greeted_again(bench: Rig) -> None:
    bench.ready()
    for _ in range(600):
        bench.link.drive(COMMAND)
        bench.board._inbox.clear()
    bench.tick(6)
    assert "missed" in bench.link.incident
    assert bench.link.is_ready


def test_refused_drives_do_not_make_the_numbers_run_away(bench: Rig) -> None:
    bench.ready()
    bench.drive_on(1100)
    assert bench.link.is_ready
    bench.link.drive(replace(COMMAND, start_heading=0.0))
    bench.tick()
    assert bench.board.state == BoardCode.DRIVING


def test_garbage_from_the_board_is_counted_and_costs_no_report(bench: Rig) -> None:
    bench.driving()
    bench.board._outbox += b"\x07garbage\x00\x02x"
    bench.drive_on(3)
    assert bench.link.is_ready
    assert bench.link.status.bad_frames >= 1


def test_a_board_of_another_version_is_named_and_never_ready() -> None:
    session = Session(CONFIGURATION)
    session.open()
    hello = wire.Decoder().feed(session.due(0.0))[0]
    assert hello.message == Hello()
    session.receive(wire.encode(Banner((9, 0, 0), 1, 0), hello.sequence, 5, version=2), 0.01)
    assert session.state is LinkState.GREETING
    assert "protocol version 2" in session.reason
    with pytest.raises(LinkError, match="flash"):
        session.drive(COMMAND, 0.02)


def test_only_the_answer_to_our_own_hello_counts() -> None:
    """A banner at boot, or an answer that an earlier program had asked for, does not end the greeting."""
    session = Session(CONFIGURATION)
    session.open()
    number = wire.Decoder().feed(session.due(0.0))[0].sequence
    for sequence in (0, number + 5):
        session.receive(wire.encode(Banner((0, 1, 0), 1, 0), sequence, 5), 0.01)
        assert session.state is LinkState.GREETING
    session.receive(wire.encode(Banner((0, 1, 0), 1, 0), number, 5), 0.02)
    assert session.state is LinkState.CONFIGURING


def test_questions_are_repeated_until_they_are_answered() -> None:
    session = Session(CONFIGURATION)
    session.open()
    times = [k * 0.016 for k in range(100) if session.due(k * 0.016)]
    assert times == pytest.approx([0.0, 0.304, 0.608, 0.912, 1.216, 1.52])


def test_another_configuration_than_ours_is_not_ready() -> None:
    session = Session(CONFIGURATION)
    session.open()
    number = wire.Decoder().feed(session.due(0.0))[0].sequence
    session.receive(wire.encode(Banner((0, 1, 0), 1, 0), number, 5), 0.01)
    number = wire.Decoder().feed(session.due(0.02))[0].sequence
    session.receive(wire.encode(Banner((0, 1, 0), 1, 4711), number, 5), 0.03)
    assert session.state is LinkState.CONFIGURING


def test_opening_twice_is_opening_once(bench: Rig) -> None:
    bench.ready()
    bench.link.open()
    assert bench.link.is_ready


def test_greeting_a_closed_link_does_nothing(bench: Rig) -> None:
    bench.link.greet()
    assert bench.link.status.state == "closed"


class StuckLine:
    """Before a port: keeps what it is given, and complains when it is closed."""

    def __init__(self, port: SerialLine) -> None:
        self._port = port
        self.out_waiting = 0
        self.thrown_away = False

    @property
    def in_waiting(self) -> int:
        return self._port.in_waiting

    def read(self, size: int = 1, /) -> bytes:
        return self._port.read(size)

    def write(self, b: bytes, /) -> int | None:
        self.out_waiting += len(b)
        return len(b)

    def reset_output_buffer(self) -> None:
        self.thrown_away = True

    def close(self) -> None:
        self._port.close()
        raise OSError("gone")


def test_a_line_that_keeps_the_last_words_is_waited_for_briefly_and_closed(bench: Rig) -> None:
    lines: list[StuckLine] = []

    def stick(port: SerialLine) -> StuckLine:
        lines.append(StuckLine(port))
        return lines[-1]

    bench.link.put_before(stick)
    bench.link.open()
    bench.tick()
    before = time.monotonic()
    bench.link.close()
    assert LAST_WORDS <= time.monotonic() - before < 0.5
    assert lines[0].thrown_away
    assert bench.link.status.state == "closed"


def test_a_port_that_fails_while_it_takes_a_command_is_lost(bench: Rig) -> None:
    bench.driving()
    bench.board.unplug()
    with pytest.raises(LinkError, match=r"lost.*unplugged"):
        bench.link.drive(COMMAND)
    assert bench.link.status.state == "closed"


def test_a_stop_that_a_lost_port_does_not_take_is_left_to_the_boards_dead_man(bench: Rig) -> None:
    bench.driving()
    bench.board.unplug()
    bench.link.stop()
    assert "did not take the stop" in bench.link.reason
    bench.tick(12)
    assert bench.board.drive_is_zero


def test_a_poll_reads_a_bounded_number_of_bytes_however_many_wait(bench: Rig) -> None:
    bench.ready()
    bench.board._outbox += bytes(100_000)
    bench.link.poll()
    assert len(bench.board._outbox) >= 100_000 - MOST_BYTES
