"""The compiled firmware and its twin, byte for byte: what the emulated board did is done again by the twin.

The recording holds, in order, the bytes that the firmware's decoder took, the ADC counts that each millisecond used,
the PWM registers after it, and every byte that was sent.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Sequence

from board_contact import SteppedContact, Terminal

from control.link import wire
from control.link.messages import ARM, BoardCode, Drive, Hello, ResetCause, Stop
from control.simulation.emulated import EmulatedBoard, prepare
from control.simulation.emulator_port import Consumed, Duty, Event, Reset, Sent, Tick
from control.simulation.twin import FirmwareTwin
from tests.simulation.board_bench import CONFIGURE, windings


class Recording:
    """An emulated board whose host does all that a host can do, right and wrong."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._board = EmulatedBoard(prepare(), windings(), 24.0, realtime=False)
        self._board.trace()
        self._terminal = Terminal(self._board.port)
        self.contact = SteppedContact(self._terminal, self._board)
        self.events: list[Event] = []
        self.contact.run(30)

    def close(self) -> None:
        self._terminal.close()
        self._board.close()

    def run(self, milliseconds: int) -> None:
        self.contact.run(milliseconds)
        self.events += self._board.traced()

    def walk(self, steps: int) -> None:
        """Drives most of the time."""
        for _ in range(steps):
            if self.contact.board.state()["state"] != "driving" and self._random.random() < 0.8:
                self.contact.ready_again()
            self._do_something()
            self.run(self._random.choice((1, 3, 10, 10, 16, 16, 40)))

    def _do_something(self) -> None:
        contact, chance = self.contact, self._random.random()
        if chance < 0.86:
            contact.send(self._drive())
        elif chance < 0.90:
            contact.put(self._random.randbytes(self._random.randint(1, 90)))
        elif chance < 0.92:
            contact.put(wire.encode(self._drive(), contact.sequence, contact.boot_id))
        elif chance < 0.94:
            contact.send(self._random.choice((Stop(), Hello(), CONFIGURE)))
        elif chance < 0.95:
            contact.send(self._drive(), boot_id=self._random.randrange(65536))
        else:
            self._harm()

    def _harm(self) -> None:
        chance = self._random.random()
        coil = self._random.randint(1, 3)
        if chance < 0.4:
            self._board.set_condition("supply_mV", self._random.choice((24000, 24000, 17000, 30000)))
        elif chance < 0.7:
            self._board.set_condition("sense_permille", self._random.choice((1000, 1000, 700, 1200, 0)), coil)
        elif chance < 0.8:
            self._board.set_condition("driver_fault", 1, coil)
            self.run(5)
            self._board.set_condition("driver_fault", 0, coil)
        elif chance < 0.85:
            self._board.reset()
        else:
            self._board.set_condition("resistance_mohm", self._random.choice((2000, 2500, 3000)), coil)

    def _drive(self) -> Drive:
        """Mostly allowed; every limit is met and passed now and then."""
        draw = self._random
        rate_limit, entry = CONFIGURE.max_rate, draw.choice((6000, 13107, 13107, 20000))
        return Drive(
            flags=draw.choice((0, 0, 0, 0, 0, 0, 0, ARM, 0, 2) if draw.random() < 0.2 else (0,)),
            pivot=draw.choice((1, 1, -1, 1) if draw.random() < 0.9 else (0, 2)),
            rate=draw.choice((0, rate_limit, -rate_limit, draw.randint(-rate_limit - 9, rate_limit + 9))),
            heading_goal=draw.getrandbits(32),
            start_heading=draw.getrandbits(32),
            tilt=draw.choice((0, 4551, CONFIGURE.max_tilt, CONFIGURE.max_tilt + draw.randint(0, 1))),
            field=draw.choice((0, 10000, 10000, 15000, CONFIGURE.max_field + draw.randint(0, 1))),
            allocation=(entry, draw.randint(-500, 500), 0, 0, entry, 0, -300, 0, entry),
            time_to_live=draw.choice((200, 150, 150, 60, 1, 65535)),
        )


def replayed(events: Sequence[Event], boot_id: int) -> Counter[str]:
    """The twin does the same; how much there was to compare."""
    twin = FirmwareTwin(boot_id, ResetCause.POWER_ON)
    compared: Counter[str] = Counter()
    duty = (0, 0, 0)
    for place, event in enumerate(events):
        match event:
            case Consumed(data):
                twin.receive(data)
            case Tick(counts, supply_count, fault):
                twin.driver_fault = fault
                duty = twin.tick(counts, supply_count)
                compared["driven"] += twin.state is BoardCode.DRIVING
            case Duty(steps):
                assert steps == duty, f"event {place}: {steps}, and the twin {duty}"
            case Sent(data):
                assert twin.transmit(len(data)) == data, f"event {place}"
                compared["bytes"] += len(data)
            case Reset():
                twin = FirmwareTwin(twin.boot_id % 0xFFFF + 1, ResetCause.EXTERNAL)
                compared["resets"] += 1
    return compared


def test_an_exchange_with_the_compiled_firmware_is_the_twins_byte_for_byte(full: bool) -> None:
    for seed in range(10 if full else 2):
        compared, contact = recorded(seed, 1500 if full else 700)
        assert compared["bytes"] > 20_000
        assert compared["driven"] > 2_000
        assert compared["resets"] >= 1
        states = {report.state for report in contact.reports}
        assert states == set(BoardCode), f"{set(BoardCode) - states} did not occur"


def recorded(seed: int, steps: int) -> tuple[Counter[str], SteppedContact]:
    recording = Recording(seed)
    try:
        boot_id = recording.contact.boot_id
        recording.walk(steps)
        return replayed(recording.events, boot_id), recording.contact
    finally:
        recording.close()
