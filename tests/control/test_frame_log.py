"""How late frames come and how many a second, as the page is told."""

import pytest

from control.frame_log import FrameLog
from control.snapshot import CameraTiming


def test_before_the_first_frame_nothing_is_known() -> None:
    assert FrameLog().figures == CameraTiming(latency=None, rate=None)


def test_latency_and_rate_are_those_of_the_stamps_whatever_single_frames_do() -> None:
    log = FrameLog()
    for number in range(60):
        captured_at = number / 60.0
        log.came(captured_at, captured_at + (0.120 if number == 30 else 0.035))
    assert log.figures.latency == pytest.approx(0.035)
    assert log.figures.rate == pytest.approx(60.0)


def test_only_the_last_second_counts() -> None:
    log = FrameLog()
    for number in range(200):
        log.came(number / 60.0, number / 60.0 + 0.100)
    for number in range(100):
        log.came(4.0 + number / 30.0, 4.0 + number / 30.0 + 0.020)
    assert log.figures.latency == pytest.approx(0.020)
    assert log.figures.rate == pytest.approx(30.0)


def test_a_stamp_that_is_repeated_or_goes_back_makes_no_endless_rate() -> None:
    log = FrameLog()
    for captured_at in (1.0, 1.0, 0.9):
        log.came(captured_at, 1.1)
    assert log.figures.rate is None
