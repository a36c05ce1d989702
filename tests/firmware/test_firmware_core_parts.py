"""The C++ core's small parts: the sine, the boot count, the cause of a reset."""

from __future__ import annotations

import pytest
from core_library import BootMemory, reset_cause, reset_cause_handed_over, sine

from control.link.messages import ResetCause
from control.simulation.fixed_point import SINE


def test_the_sine_is_the_twins_for_every_angle() -> None:
    assert [sine(angle) for angle in range(65536)] == list(SINE)


def test_a_fresh_board_boots_with_one_and_counts_on() -> None:
    memory = BootMemory()
    assert [memory.boot() for _ in range(300)] == list(range(1, 301))


def test_the_boot_count_passes_over_zero() -> None:
    memory = BootMemory()
    memory.words[0], memory.words[1] = 0xFFFE, 0x0001
    assert [memory.boot() for _ in range(4)] == [0xFFFF, 1, 2, 3]
    assert [memory.boot() for _ in range(500)][-1] == 503


def test_no_cell_is_written_more_often_than_once_in_128_boots() -> None:
    memory = BootMemory()
    writes = [0] * 128
    for _ in range(1280):
        before = list(memory.words)
        memory.boot()
        for slot in range(128):
            writes[slot] += before[2 * slot : 2 * slot + 2] != memory.words[2 * slot : 2 * slot + 2]
    assert writes == [10] * 128


@pytest.mark.parametrize("cut", [(9, 0xFFFF), (0, 0xFFFF), (0xFFFF, 0xFFF0)])
def test_a_record_that_was_cut_short_by_a_power_failure_is_passed_over(cut: tuple[int, int]) -> None:
    memory = BootMemory()
    for _ in range(8):
        memory.boot()
    memory.words[16], memory.words[17] = cut
    assert memory.boot() == 9
    assert memory.boot() == 10


@pytest.mark.parametrize(
    ("flags", "cause"),
    [
        (0, ResetCause.UNKNOWN),
        (1, ResetCause.POWER_ON),
        (0b0111, ResetCause.POWER_ON),
        (0b0110, ResetCause.BROWN_OUT),
        (0b0010, ResetCause.EXTERNAL),
        (0b1010, ResetCause.EXTERNAL),
        (0b1000, ResetCause.WATCHDOG),
    ],
)
def test_the_cause_of_a_reset_is_the_first_that_happened(flags: int, cause: ResetCause) -> None:
    assert reset_cause(flags) == cause


@pytest.mark.parametrize(
    ("bootloader", "flags", "cause"),
    [
        (0x0404, 8, ResetCause.UNKNOWN),
        (0x0405, 1, ResetCause.UNKNOWN),
        (0x0406, 1, ResetCause.POWER_ON),
        (0x0406, 8, ResetCause.UNKNOWN),
        (0x0602, 8, ResetCause.UNKNOWN),
        (0x0602, 0b1100, ResetCause.BROWN_OUT),
        (0x0700, 8, ResetCause.WATCHDOG),
        (0x0803, 0b1010, ResetCause.EXTERNAL),
        (0xFFFF, 8, ResetCause.UNKNOWN),
    ],
)
def test_a_bootloader_is_believed_as_far_as_its_version_can_know(
    bootloader: int, flags: int, cause: ResetCause
) -> None:
    """Before 7.0 Optiboot reports an external reset as the watchdog's, which the doctor would warn of."""
    assert reset_cause_handed_over(bootloader, flags) == cause
