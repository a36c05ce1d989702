"""The emulated board below its firmware: pins, timers, coils, ADC, UART, watchdog, seen with a program that pokes."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Iterator
from contextlib import closing
from itertools import pairwise
from pathlib import Path

import pytest
from board_contact import Terminal

from control.simulation.bridges import Winding
from control.simulation.emulated import EmulatedBoard, Emulation, prepare
from control.simulation.emulator_port import Consumed, Reset, Tick
from control.simulation.lockstep import Sample

COILS = (Winding(2.5, 0.125), Winding(2.0, 0.055), Winding(1.5, 0.014))
STEPS = (800, 800, 100)
DDR_B, PORT_B, DDR_C, PIN_C, DDR_D, PORT_D, PIN_D = 0x24, 0x25, 0x27, 0x26, 0x2A, 0x2B, 0x29
TCCR_1A, TCCR_1B, ICR_1L, ICR_1H, TCCR_2A, TCCR_2B, OCR_2A = 0x80, 0x81, 0x86, 0x87, 0xB0, 0xB1, 0xB3
OCR = (0x88, 0x8A, 0xB4)
"""OCR1AL, OCR1BL, OCR2B."""
ENABLE = ((DDR_D, 6), (DDR_B, 4), (DDR_C, 3))
"""Coil 1 to 3: its EN/DIAG line is pulled low by an output that is zero."""
WATCHDOG, EXTERNAL, POWER_ON = 8, 2, 1


class Probe:
    """The board with the poking program, stepped."""

    def __init__(self, elf: Path) -> None:
        program = prepare().program
        self.board = EmulatedBoard(Emulation(program, elf), COILS, 24.0, realtime=False)
        self.terminal = Terminal(self.board.port)
        self.now = 0

    def close(self) -> None:
        self.terminal.close()
        self.board.close()

    def step(self, milliseconds: int = 1) -> list[Sample]:
        samples = self.board.step(milliseconds)
        self.now = samples[-1].milliseconds
        return samples

    def write(self, address: int, value: int) -> None:
        self.terminal.write(bytes((ord("w"), address, value)))
        self.step()

    def read(self, address: int) -> int:
        self.terminal.read()
        self.terminal.write(bytes((ord("r"), address)))
        self.step(2)
        return self.terminal.read()[0]

    def begin(self) -> None:
        """Pins and timers as the wiring table says; the bridges enabled, forwards, at zero."""
        for address, value in (
            (DDR_B, 0b101111),
            (DDR_D, 0b10111100),
            (PORT_D, 0b10000100),
            (PORT_B, 0b1000),
        ):
            self.write(address, value)
        for address, value in ((ICR_1H, 799 >> 8), (ICR_1L, 799 & 255), (TCCR_1B, 0b11001), (OCR_2A, 99)):
            self.write(address, value)
        self.write(TCCR_2B, 0b1010)

    def drive(self, compares: tuple[int, int, int]) -> None:
        for address, value in zip(OCR, compares, strict=True):
            if address != OCR[2]:
                self.write(address + 1, value >> 8)
            self.write(address, value & 255)
        self.write(TCCR_1A, 0b10100010)
        self.write(TCCR_2A, 0b00100011)


@pytest.fixture(scope="session")
def probe_elf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    elf = tmp_path_factory.mktemp("probe") / "probe.elf"
    source = Path(__file__).parent / "probe" / "probe.c"
    flags = ["-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Os", "-Wall", "-Wextra", "-Werror"]
    subprocess.run(["avr-gcc", *flags, str(source), "-o", str(elf)], check=True)
    return elf


@pytest.fixture
def probe(probe_elf: Path) -> Iterator[Probe]:
    with closing(Probe(probe_elf)) as probe:
        probe.step(3)
        yield probe


def test_the_coils_follow_the_compare_registers_by_the_exact_exponential(probe: Probe) -> None:
    probe.begin()
    probe.drive((399, 199, 24))
    samples = probe.step(50)
    assert samples[-1].duty == (400, 200, 25)
    for before, after in pairwise(samples):
        for k, coil in enumerate(COILS):
            decay = math.exp(-1e-3 * coil.resistance / coil.inductance)
            settled = after.duty[k] / STEPS[k] * 24.0 / coil.resistance
            expected = settled + (before.currents[k] - settled) * decay
            assert after.currents[k] == pytest.approx(expected, abs=2e-5 + 1e-3 * abs(settled - expected))


def test_a_cut_off_compare_output_is_zero_and_a_pin_that_is_left_high_is_full_drive(probe: Probe) -> None:
    probe.begin()
    probe.drive((399, 399, 49))
    probe.write(TCCR_1A, 0b00000010)
    probe.write(TCCR_2A, 0b00000011)
    assert probe.step()[-1].duty == (0, 0, 0)
    probe.write(PORT_B, 0b1010)
    assert probe.step()[-1].duty == (800, 0, 0)


def test_a_timer_that_stands_still_counts_as_full_drive(probe: Probe) -> None:
    probe.begin()
    probe.drive((399, 399, 49))
    probe.write(TCCR_1B, 0b11000)
    assert probe.step()[-1].duty == (800, 800, 50)


def test_the_direction_pins_turn_the_current_round_and_both_alike_brake(probe: Probe) -> None:
    probe.begin()
    probe.drive((399, 0, 0))
    probe.write(PORT_D, 0b10010000)
    assert probe.step(400)[-1].currents[0] == pytest.approx(-4.8, abs=0.05)
    probe.write(PORT_D, 0b10010100)
    assert abs(probe.step(300)[-1].currents[0]) < 0.02


@pytest.mark.parametrize("coil", [1, 2, 3])
def test_a_bridge_whose_enable_line_is_low_gives_nothing(probe: Probe, coil: int) -> None:
    probe.begin()
    probe.drive((399, 399, 49))
    register, bit = ENABLE[coil - 1]
    port = {DDR_B: 0b101111, DDR_C: 0, DDR_D: 0b10111100}[register]
    probe.write(register, port | 1 << bit)
    sample = probe.step(400)[-1]
    assert [abs(current) > 3.0 for current in sample.currents] == [k != coil for k in (1, 2, 3)]
    assert sample.duty == (400, 400, 50)


@pytest.mark.parametrize(("coil", "register", "bit"), [(1, PIN_D, 6), (2, 0x23, 4), (3, PIN_C, 3)])
def test_a_released_enable_line_is_up_until_its_driver_pulls_it_down(
    probe: Probe, coil: int, register: int, bit: int
) -> None:
    probe.begin()
    assert probe.read(register) >> bit & 1
    probe.board.set_condition("driver_fault", 1, coil)
    assert not probe.read(register) >> bit & 1
    probe.board.set_condition("driver_fault", 0, coil)
    assert probe.read(register) >> bit & 1


def test_the_adc_shows_every_coils_current_and_the_supply(probe: Probe) -> None:
    probe.begin()
    probe.drive((399, 199, 24))
    probe.board.trace()
    samples = probe.step(300)
    ticks = [event for event in probe.board.traced() if isinstance(event, Tick)]
    for sample, tick in zip(samples[200:], ticks[199:], strict=False):
        for current, count in zip(sample.currents, tick.counts, strict=True):
            assert count == pytest.approx(abs(current) * 0.14 / 5.0 * 1024.0, abs=1.5)
    assert ticks[-1].supply_count == int(24.0 / 55.0 * 1024)
    probe.board.set_condition("supply_mV", 60000)
    probe.board.set_condition("sense_permille", 10000, 1)
    probe.step(3)
    last = [event for event in probe.board.traced() if isinstance(event, Tick)][-1]
    assert (last.counts[0], last.supply_count) == (1023, 1023)


def test_conditions_of_the_coils_show_in_their_currents(probe: Probe) -> None:
    probe.begin()
    probe.drive((399, 399, 49))
    probe.board.set_condition("open_coil", 1, 1)
    probe.board.set_condition("swapped", 1, 2)
    probe.board.set_condition("resistance_mohm", 3000, 3)
    x, y, z = probe.step(500)[-1].currents
    assert x == 0.0
    assert y == pytest.approx(-6.0, abs=0.01)
    assert z == pytest.approx(4.0, abs=0.01)


def test_the_line_carries_fifty_bytes_a_millisecond(probe: Probe) -> None:
    probe.board.trace()
    probe.terminal.write(b"x" * 500)
    probe.step(9)
    consumed = sum(len(event.data) for event in probe.board.traced() if isinstance(event, Consumed))
    assert 430 <= consumed <= 450


def test_a_receiver_that_is_not_read_in_time_loses_bytes_and_they_are_counted(probe: Probe) -> None:
    probe.board.cycles()
    probe.terminal.write(b"x" * 50 + b"d" + b"x" * 200)
    probe.step(8)
    cycles = probe.board.cycles()
    assert cycles.receiver_depth == 3
    assert 100 - 3 <= cycles.overruns <= 100 + 12  # and the interrupt that was due meanwhile


def test_cycles_are_counted_between_the_marks_and_over_the_whole_interrupt(probe: Probe) -> None:
    probe.board.cycles()
    probe.step(100)
    cycles = probe.board.cycles()
    assert cycles.tick.count == pytest.approx(100, abs=1)
    assert cycles.tick.worst == pytest.approx(320, abs=3)
    assert cycles.tick.mean == pytest.approx(cycles.tick.worst, abs=1)
    assert cycles.interrupt.worst > cycles.tick.worst + 4 * 13 * 16
    assert cycles.tick.worst_share == pytest.approx(cycles.tick.worst / cycles.period, abs=1e-4)


def test_the_first_reset_is_the_power_switch_and_the_button_and_the_watchdog_say_who_they_are(
    probe: Probe,
) -> None:
    assert probe.terminal.read() == bytes((POWER_ON,))
    probe.board.reset()
    probe.step(3)
    assert probe.terminal.read() == bytes((EXTERNAL,))
    probe.board.trace()
    probe.terminal.write(b"h")
    probe.step(240)
    assert probe.terminal.read() == b""
    probe.step(40)
    assert probe.terminal.read() == bytes((WATCHDOG,))
    assert Reset() in probe.board.traced()


def test_a_reset_leaves_every_bridge_without_drive(probe: Probe) -> None:
    probe.begin()
    probe.drive((399, 399, 49))
    probe.step(100)
    probe.board.reset()
    assert probe.step()[-1].duty == (0, 0, 0)
    assert max(abs(current) for current in probe.step(300)[-1].currents) < 0.02


def test_a_stepped_board_does_the_same_each_time(probe_elf: Path) -> None:
    assert _told(probe_elf) == _told(probe_elf)


def _told(elf: Path) -> tuple[list[Sample], bytes]:
    with closing(Probe(elf)) as probe:
        samples = probe.step(5)
        probe.begin()
        probe.drive((399, 199, 24))
        for number in range(40):
            probe.terminal.write(bytes((ord("w"), OCR[0], number, ord("r"), OCR[0])))
            samples += probe.step(7)
        return samples, probe.terminal.read()
