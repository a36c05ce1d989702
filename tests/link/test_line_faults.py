"""What a bad line may do to a rig: nothing that an operator did not ask for. On a simulated clock."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from link_bench import COMMAND, TICK, Rig, rig

from control.link import wire
from control.link.conversion import LinkError
from control.link.line import SerialLine
from control.link.messages import ARM, BoardCode, Drive, Hello, Message, Stop
from control.link.wire import encode
from control.simulation.line_faults import MOST_PARTIAL, Lane, LineFaults

QUICK = settings(max_examples=100, deadline=None, derandomize=True)
LIFE = round(COMMAND.time_to_live * 1e3)
"""Of one drive command, ms."""


@pytest.fixture
def bench() -> Iterator[Bench]:
    with faulty() as made:
        yield made


class Bench:
    """A driving rig behind a line that can be spoilt, and everything that its host has tried to send."""

    def __init__(self, inner: Rig, seed: int = 1) -> None:
        self.rig = inner
        self.link, self.board = inner.link, inner.board
        self.faults = LineFaults(lambda: inner.now, seed)
        self.sent: list[Message] = []
        self.link.put_before(self.faults.wrap)
        self.link.put_before(lambda port: Witness(port, self.sent))

    def attempt(self, edge: bool = False) -> bool:
        """Sends a drive command if the link takes it."""
        try:
            self.link.drive(replace(COMMAND, start_heading=0.0) if edge else COMMAND)
        except LinkError:
            return False
        return True

    def drive_on(self, ticks: int) -> None:
        for _ in range(ticks):
            self.rig.tick()
            self.attempt()

    def until_ready(self, ticks: int = 1000) -> int:
        """Ticks that it took."""
        for tick in range(ticks):
            if self.link.is_ready:
                return tick
            self.rig.tick()
        raise TimeoutError(self.link.reason)


@contextmanager
def faulty(seed: int = 1) -> Iterator[Bench]:
    with rig() as inner:
        yield Bench(inner, seed)


class Witness:
    """Notes the messages that pass to the board."""

    def __init__(self, port: SerialLine, sent: list[Message]) -> None:
        self._port = port
        self._sent = sent
        self.read = port.read
        self.reset_output_buffer = port.reset_output_buffer
        self.close = port.close

    @property
    def in_waiting(self) -> int:
        return self._port.in_waiting

    @property
    def out_waiting(self) -> int:
        return self._port.out_waiting

    def write(self, b: bytes) -> int | None:
        self._sent += [packet.message for packet in wire.Decoder().feed(b)]
        return self._port.write(b)


# ---- the injector itself


@given(st.lists(st.binary(max_size=90)))
@QUICK
def test_a_lane_without_faults_passes_every_byte_at_once(pieces: list[bytes]) -> None:
    lane = Lane(LineFaults(lambda: 0.0), "1")
    for piece in pieces:
        lane.put(piece)
        assert lane.take() == piece


@given(st.lists(st.integers(1, 60), min_size=1, max_size=40), st.integers(0, 1000))
@QUICK
def test_what_a_lane_held_back_comes_out_when_its_faults_are_switched_off(cuts: list[int], seed: int) -> None:
    now = 0.0
    faults = LineFaults(lambda: now, delay=1.0)
    lane = Lane(faults, str(seed))
    stream = b"".join(encode(Hello(), number, 1) for number in range(1, 30))
    given_, rest = b"", stream
    for cut in cuts:
        lane.put(rest[:cut])
        given_, rest = given_ + rest[:cut], rest[cut:]
        assert lane.take() == b""
    faults.clear()
    now = 2.0
    lane.put(rest)
    sequences = [packet.sequence for packet in wire.Decoder().feed(lane.take())]
    assert sequences == list(range(1, 30))


@pytest.mark.parametrize("fault", ["lost", "repeated", "reordered", "garbage"])
@pytest.mark.parametrize("share", [0.1, 0.5, 1.0])
def test_a_share_of_the_frames_meets_with_the_fault(fault: str, share: float) -> None:
    faults = LineFaults(lambda: 0.0)
    setattr(faults, fault, share)
    lane = Lane(faults, "1")
    heard: list[int] = []
    decoder = wire.Decoder()
    for number in range(1, 2001):
        lane.put(encode(Hello(), number, 1))
        heard += [packet.sequence for packet in decoder.feed(lane.take())]
    met = faults.met[fault]
    if fault != "reordered":
        assert met == pytest.approx(2000 * share, abs=100)
    expected = {"lost": 2000 - met, "repeated": 2000 + met, "reordered": 2000}
    if fault == "garbage":
        assert len(heard) == pytest.approx(2000 - 0.5 * met, rel=0.1)
        assert heard == sorted(set(heard))
    else:
        assert len(heard) == pytest.approx(expected[fault], abs=1)
    assert (heard == sorted(heard)) is (fault in ("lost", "garbage"))


def test_what_an_earlier_fault_let_pass_is_not_repeated_by_a_later_one() -> None:
    """The board may have booted anew meanwhile; what it said before would look like another boot."""
    faults = LineFaults(lambda: 0.0, repeated=1.0)
    lane = Lane(faults, "1")
    for number in range(1, 50):
        lane.put(encode(Hello(), number, 1))
    faults.clear()
    lane.put(encode(Hello(), 50, 1))
    lane.take()
    faults.repeated = 1.0
    for number in range(1, 50):
        lane.put(encode(Hello(), number, 2))
    assert {packet.boot_id for packet in wire.Decoder().feed(lane.take())} == {2}


def test_the_same_seed_does_the_same() -> None:
    def passed(seed: str) -> bytes:
        lane = Lane(LineFaults(lambda: 0.0, lost=0.3, repeated=0.3, reordered=0.3, garbage=0.3), seed)
        for number in range(1, 200):
            lane.put(encode(Stop(), number, 1))
        return lane.take()

    assert passed("a") == passed("a") != passed("b")


def test_a_lane_holds_a_bounded_number_of_bytes() -> None:
    lane = Lane(LineFaults(lambda: 0.0, delay=9.0), "1")
    for _ in range(5000):
        lane.put(b"x" * 50)
    assert len(lane._queue) <= 1024
    assert len(lane._partial) <= MOST_PARTIAL


# ---- promises of the link and the board


def test_a_line_without_faults_is_as_if_there_were_none(bench: Bench) -> None:
    bench.rig.driving()
    bench.drive_on(100)
    assert bench.board.state is BoardCode.DRIVING
    assert bench.link.status.bad_frames == 0
    assert sum(isinstance(message, Drive) for message in bench.sent) == 111


def test_garbage_both_ways_is_dropped_and_counted_and_the_rig_drives_on(bench: Bench) -> None:
    """Three in ten messages meet with noise, one in six is spoilt: the next whole one is heard."""
    bench.rig.driving()
    bench.faults.garbage = 0.3
    for _ in range(300):
        bench.drive_on(1)
        assert bench.board.state is BoardCode.DRIVING
    assert bench.link.status.bad_frames > 50
    assert bench.link.status.counts.board_bad > 30
    assert bench.link.bad_share > 0.1
    assert bench.link.status.counts.refused == bench.link.status.counts.stale == 0


@given(st.binary(max_size=300))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_both_ends_understand_the_first_message_after_garbage(noise: bytes) -> None:
    with faulty() as bench:
        bench.rig.driving()
        bench.board.advance(20)
        bench.board.write(noise)
        bench.attempt()
        bench.board.advance(12)
        assert bench.board.twin._last_sequence == bench.link._session._sequence
        bench.board.read(4096)
        bench.board._outbox += noise
        bench.board.advance(20)
        bench.rig.now += 0.032
        assert bench.link.poll() is not None


@given(st.integers(0, 10_000), st.floats(0.0, 0.6), st.floats(0.0, 0.6), st.floats(0.0, 0.6))
@settings(max_examples=30, deadline=None)
def test_lost_repeated_and_swapped_messages_never_renew_an_old_command(
    seed: int, lost: float, repeated: float, reordered: float
) -> None:
    """The host falls silent; whatever the line repeats, the coils are zero one lifetime after its last command,
    and stay so."""
    with faulty(seed) as bench:
        bench.rig.driving()
        bench.faults.lost, bench.faults.repeated, bench.faults.reordered = lost, repeated, reordered
        bench.drive_on(20)
        for millisecond in range(400):
            if millisecond % TICK == 0:
                bench.link.poll()
                bench.board.write(encode_last(bench))
            bench.board.advance(1)
            assert bench.board.drive_is_zero or millisecond < LIFE + TICK
        assert bench.board.drive_is_zero


def encode_last(bench: Bench) -> bytes:
    """The last drive once more, as a line that repeats it would deliver it."""
    session = bench.link._session
    last = next(message for message in reversed(bench.sent) if isinstance(message, Drive))
    return encode(last, session._sequence, session.boot_id)


def test_a_stop_that_is_overtaken_by_an_old_drive_still_stops(bench: Bench) -> None:
    bench.rig.driving()
    bench.faults.reordered = 1.0
    bench.attempt()  # held back by the line
    bench.link.stop()  # arrives first
    bench.board.advance(5)
    assert bench.board.state is BoardCode.STOPPED
    assert bench.link._session._sequence == bench.board.twin._last_sequence
    bench.rig.tick(2)
    assert bench.link.status.counts.stale == 1


def test_a_delayed_line_measures_its_delay_and_drives(bench: Bench) -> None:
    bench.faults.delay = 0.032
    bench.link.open()
    bench.until_ready()
    bench.attempt(edge=True)
    bench.drive_on(60)
    assert bench.board.state is BoardCode.DRIVING
    assert bench.link.status.round_trip_median is not None
    assert 0.064 <= bench.link.status.round_trip_median <= 0.064 + 3 * TICK * 1e-3


def test_a_line_that_became_so_slow_that_a_stop_would_be_late_is_driven_no_more(bench: Bench) -> None:
    bench.rig.driving()
    bench.faults.delay = 0.5
    taken = 0
    for _ in range(60):
        bench.rig.tick()
        taken += bench.attempt()
    assert 15 <= taken <= 20  # 0.3 s
    bench.rig.tick(30)
    assert bench.board.drive_is_zero


def test_a_silent_line_is_noticed_and_nothing_is_driven_when_it_speaks_again(bench: Bench) -> None:
    bench.rig.driving()
    bench.faults.silent = True
    bench.drive_on(60)
    assert not bench.link.is_ready
    assert "no telemetry" in bench.link.incident
    assert bench.board.drive_is_zero
    bench.faults.silent = False
    bench.until_ready()
    bench.drive_on(30)
    assert bench.board.drive_is_zero
    assert bench.board.state is BoardCode.READY


def test_a_jammed_line_is_let_go_of_at_once_and_tried_again_ever_more_rarely(bench: Bench) -> None:
    bench.rig.driving()
    bench.faults.jammed = True
    with pytest.raises(LinkError, match="jammed"):
        bench.link.drive(COMMAND)
    attempts = 0
    before = bench.link.status.counts.reconnects
    for _ in range(600):
        bench.rig.tick()
    attempts = bench.link.status.counts.reconnects - before
    assert 3 <= attempts <= 5  # after 0.5, 1, 2 and 4 s
    assert bench.board.drive_is_zero
    bench.faults.jammed = False
    bench.until_ready()
    bench.drive_on(30)
    assert bench.board.drive_is_zero


def test_an_unplugged_line_is_found_again_and_stays_disarmed(bench: Bench) -> None:
    bench.rig.driving()
    bench.faults.unplugged = True
    assert bench.rig.tick() is None
    assert bench.link.status.state == "closed"
    assert "unplugged" in bench.link.reason
    bench.drive_on(100)
    assert bench.board.drive_is_zero
    assert bench.link.status.counts.reconnects == 0
    bench.faults.unplugged = False
    bench.until_ready()
    bench.drive_on(30)
    assert bench.link.status.counts.reconnects == 1
    assert bench.board.state is BoardCode.READY
    assert bench.board.drive_is_zero


def test_an_unplugged_line_cannot_be_opened(bench: Bench) -> None:
    bench.faults.unplugged = True
    with pytest.raises(LinkError, match="unplugged"):
        bench.link.open()
    assert bench.link.status.state == "closed"
    bench.faults.clear()
    bench.link.open()
    bench.until_ready()


# ---- for every interleaving

LONGEST_DELAY = 500
"""Milliseconds that a command may still be on its way."""

actions = st.sampled_from(
    (
        *("tick", "tick", "tick", "ticks", "drive", "drive", "edge", "stop", "greet"),
        *("lost", "repeated", "reordered", "garbage", "delay", "clear"),
        *("unplugged", "jammed", "silent", "reset", "noise in", "noise out"),
    )
)


@given(st.lists(actions, min_size=5, max_size=120), st.integers(0, 1000))
@settings(max_examples=100, deadline=None)
def test_whatever_happens_to_the_line_poll_never_raises_and_only_the_operator_arms(
    plan: list[str], seed: int
) -> None:
    """No drive leaves before the board is ready, and no arm edge but those that were asked for."""
    with faulty(seed) as bench:
        bench.link.open()
        for number, action in enumerate(plan):
            bench.sent.clear()
            was_ready = bench.link.is_ready
            act(bench, action, (number * 37 + seed) % 100 / 100)
            drives = [message for message in bench.sent if isinstance(message, Drive)]
            if action not in ("drive", "edge"):
                assert drives == []
            assert was_ready or drives == []
            assert [drive.flags for drive in drives] == [ARM if action == "edge" else 0] * len(drives)
        bench.faults.clear()
        bench.until_ready()
        bench.rig.tick((LONGEST_DELAY + LIFE) // TICK + 2)
        assert bench.board.drive_is_zero


def act(bench: Bench, action: str, share: float) -> None:
    faults = bench.faults
    if action == "ticks":
        bench.rig.tick(40)
    elif action in ("drive", "edge"):
        bench.attempt(edge=action == "edge")
    elif action in ("lost", "repeated", "reordered", "garbage"):
        setattr(faults, action, share)
    elif action in ("unplugged", "jammed", "silent"):
        setattr(faults, action, not getattr(faults, action))
    elif action == "delay":
        faults.delay = 1e-3 * LONGEST_DELAY * share
    elif action == "noise in":
        bench.board._outbox += bytes(range(round(200 * share)))
    elif action == "noise out":
        bench.board.write(bytes(range(round(200 * share))))
    else:
        {
            "tick": bench.rig.tick,
            "stop": bench.link.stop,
            "greet": bench.link.greet,
            "clear": faults.clear,
            "reset": bench.board.reset,
        }[action]()
