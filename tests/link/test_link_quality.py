"""Figures of the line: shares of broken frames, round trips, counts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from link_bench import COMMAND, Rig, rig

from control.link.messages import Telemetry
from control.link.quality import FEWEST, MOST_ENTRIES, WINDOW, BoardCounts, BrokenShare, Echoes, RoundTrips

QUICK = settings(max_examples=150, deadline=None, derandomize=True)


@pytest.fixture
def bench() -> Iterator[Rig]:
    with rig() as made:
        yield made


entries = st.lists(st.tuples(st.floats(0.0, 0.5), st.integers(0, 20), st.integers(0, 20)), max_size=60)


@given(entries)
@QUICK
def test_the_share_is_that_of_the_last_second_alone(steps: list[tuple[float, int, int]]) -> None:
    share, now, seen = BrokenShare(), 0.0, []
    for gap, whole, broken in steps:
        now += gap
        share.add(now, whole, broken)
        seen.append((now, whole, broken))
        recent = [entry for entry in seen if entry[0] >= now - WINDOW]
        broken_recently = sum(entry[2] for entry in recent)
        total = broken_recently + sum(entry[1] for entry in recent)
        assert share.share(now) == broken_recently / max(total, FEWEST)


def test_the_share_of_a_quiet_line_is_zero_and_one_broken_frame_is_no_trend() -> None:
    share = BrokenShare()
    assert share.share(0.0) == 0.0
    share.add(0.0, 0, 1)
    assert share.share(0.5) == 1.0 / FEWEST
    assert share.share(WINDOW) == 1.0 / FEWEST
    assert share.share(WINDOW + 1e-9) == 0.0


def test_a_share_keeps_a_bounded_number_of_entries() -> None:
    share = BrokenShare()
    for number in range(2 * MOST_ENTRIES):
        share.add(1e-6 * number, 0, 1)
    assert share.share(0.1) == 1.0
    assert len(share._entries) == MOST_ENTRIES == share._broken


def test_a_line_is_as_late_as_its_reports_show_that_an_echo_is_missing() -> None:
    echoes = Echoes()
    echoes.heard(6, 0.0)
    echoes.sent(7, 0.0)
    for at in (0.1, 0.2):
        echoes.heard(6, at)
        assert echoes.lateness == at
        assert echoes.unheard(at + 0.05) == pytest.approx(at + 0.05)
    echoes.heard(7, 0.25)
    assert echoes.round_trips.newest == 0.25
    assert echoes.lateness == 0.2, "it may have come right after the last look"
    echoes.sent(8, 0.26)
    echoes.heard(8, 0.27)
    assert echoes.lateness == 0.0
    assert echoes.unheard(0.3) == 0.0


def test_a_line_is_not_late_where_nobody_looked_or_the_board_is_silent() -> None:
    echoes = Echoes()
    assert echoes.lateness == 0.0
    echoes.heard(6, 1.0)
    echoes.sent(7, 1.001)
    assert echoes.lateness == 0.0
    echoes.heard(7, 1.9)
    assert echoes.round_trips.newest == pytest.approx(0.899)
    assert echoes.lateness == 0.0


def test_an_arm_edge_forgets_how_late_the_line_was() -> None:
    echoes = Echoes()
    echoes.sent(7, 0.0)
    echoes.heard(6, 0.4)
    echoes.heard(7, 0.5)
    assert echoes.lateness == 0.4
    echoes.begin()
    assert echoes.lateness == 0.0
    echoes.sent(8, 1.0)
    echoes.begin()
    assert echoes.unheard(2.0) == 0.0


def test_there_are_no_figures_before_the_first_round_trip() -> None:
    assert RoundTrips().figures is RoundTrips().newest is None


@given(st.lists(st.floats(1e-4, 1.0), min_size=1, max_size=700))
@QUICK
def test_round_trip_figures_are_of_the_newest_ones(times: list[float]) -> None:
    trips = RoundTrips()
    for time in times:
        trips.add(time)
    kept = sorted(times[-512:])
    assert trips.newest == times[-1]
    assert trips.figures is not None
    median, p99 = trips.figures
    assert trips.figures == (median, p99)
    assert sum(time <= median for time in kept) >= len(kept) / 2 <= sum(time >= median for time in kept)
    assert sum(time > p99 for time in kept) <= 0.01 * len(kept)
    assert p99 in kept


def report(bad: int, good: int, refused: int, stale: int) -> Telemetry:
    zero = (0, 0, 0)
    return Telemetry(0, 0, 0, zero, zero, zero, 0, 0, 0, 0, good, bad, refused, stale, 0, 0)


def test_the_boards_counts_go_round_at_16_bits() -> None:
    counts = BoardCounts()
    assert counts.step(report(65530, 65000, 0, 65535)) == (0, 0)
    assert counts.step(report(4, 64, 3, 0)) == (600 + 3 + 1, 10)
    assert counts.step(report(4, 64, 3, 0)) == (0, 0)


def test_a_clean_line_counts_what_went_over_it(bench: Rig) -> None:
    bench.driving()
    bench.drive_on(60)
    status = bench.link.status
    assert status.bad_share == 0.0
    assert status.counts.sent == 73  # hello, configuration, arm edge, 10 and 60 drives
    assert status.counts.received == pytest.approx(100 * bench.now, abs=4)  # a report each 10 ms
    assert status.counts.reconnects == status.counts.resends == status.counts.board_bad == 0
    assert set(status.counts.broken.values()) == {0}
    assert status.round_trip_median is not None
    assert status.round_trip_p99 is not None
    assert 0.0 < status.round_trip_median <= status.round_trip_p99 <= 0.032


def test_a_refused_and_an_old_message_show_in_the_counts(bench: Rig) -> None:
    bench.ready()
    bench.link.drive(COMMAND)
    bench.tick()
    assert bench.link.status.counts.refused == 1
    bench.link._session._sequence -= 1
    bench.link.drive(replace(COMMAND, start_heading=0.0))
    bench.tick(2)
    assert bench.link.status.counts.stale == 1
    assert bench.board.drive_is_zero


def test_frames_that_arrive_broken_show_by_kind_and_share(bench: Rig) -> None:
    bench.driving()
    for _ in range(64):
        bench.board._outbox += b"\x00\x05ab\x00"
        bench.drive_on(1)
    status = bench.link.status
    assert status.bad_frames == sum(status.counts.broken.values()) >= 64
    assert status.counts.broken["encoding"] >= 60
    assert 0.35 < status.bad_share < 0.6  # 62 a second among 100 reports, some of which they cut in two
    bench.drive_on(70)
    assert bench.link.status.bad_share == 0.0
    assert bench.link.status.bad_frames == status.bad_frames


def test_frames_that_reach_the_board_broken_show_in_the_share_too(bench: Rig) -> None:
    bench.driving()
    for _ in range(64):
        bench.board.write(b"\x00\x05ab\x00")
        bench.drive_on(1)
    assert bench.link.status.counts.board_bad == 64
    assert bench.link.status.bad_frames == 0
    assert bench.link.bad_share == pytest.approx(0.5, abs=0.03)
