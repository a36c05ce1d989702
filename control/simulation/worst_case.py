"""The heaviest load that a host can put on the board, for counting the cycles of its 1 kHz interrupt.

The board drives a field that turns, with an elevation ramp every tenth of a second, currents that are scaled back
and a supply that is sensed anew at every millisecond, and telemetry; the commands come at 100/s, or as fast as the
line carries them.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

from control.link import messages, wire
from control.simulation.bridges import Winding
from control.simulation.emulated import EmulatedBoard, Emulation
from control.simulation.emulator_port import Cycles

COILS = (Winding(2.5, 0.125), Winding(2.0, 0.055), Winding(1.5, 0.014))
SUPPLY = 24.0
"""The paper's rig: ohm, H, V."""

RIPPLE = (24000, 23800)
"""The supply at even and at odd milliseconds, mV: a few counts of the ADC, as a switched one has."""

COMMAND_PERIOD = 10
"""Milliseconds between two commands: 100/s, where a camera gives 60/s."""

FLOOD = 9
"""Commands in 10 ms that fill a line of 50 bytes a millisecond."""

_LIMIT = 8000
_STEEP = 9000
_ENTRY = 20000
"""More than a coil may carry at full field (1.2 mA/uT), from each of the three axes."""

CONFIGURE = messages.Configure(
    current_limits=(_LIMIT, _LIMIT, _LIMIT),
    dead_man=200,
    ramp=50,
    field_slew=8533,
    resistances=(2500, 2000, 1500),
    inductances=(12500, 5500, 1400),
    supply=24000,
    max_field=20000,
    max_rate=0x0FFFFFFF,
    max_tilt=10923,
    sense_gains=(8929, 8929, 8929, 8929, 8929, 8929),
    supply_scale=55000,
)


@dataclass(frozen=True, slots=True)
class WorstCase:
    """Cycles at 100 commands a second, and with the line full of commands."""

    busy: Cycles
    flooded: Cycles
    state: str
    """Of the board at the end: "driving", or the load was none."""


class _Host:
    """Sends what it likes; hears nothing."""

    def __init__(self, port: str) -> None:
        self._port = os.open(port, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self._sequence = 0
        self.boot_id = 0

    def say(self, message: messages.Message) -> None:
        self._sequence += 1
        os.write(self._port, wire.encode(message, self._sequence, self.boot_id))

    def listen_away(self) -> None:
        """Takes what came, so that the line does not fill up."""
        while self._read():
            pass

    def _read(self) -> bytes:
        try:
            return os.read(self._port, 4096)
        except BlockingIOError:
            return b""

    def close(self) -> None:
        os.close(self._port)


def measure(emulation: Emulation, busy: int = 5000, flooded: int = 1000) -> WorstCase:
    """Loads an emulated board for so many of its milliseconds each, as fast as the emulator goes."""
    board = EmulatedBoard(emulation, COILS, SUPPLY, realtime=False)
    host = _Host(board.port)
    try:
        _arm(board, host)
        board.cycles()
        _drive(board, host, busy, 1)
        at_work = board.cycles()
        _drive(board, host, flooded, FLOOD)
        return WorstCase(at_work, board.cycles(), str(board.state()["state"]))
    finally:
        host.close()
        board.close()


def _arm(board: EmulatedBoard, host: _Host) -> None:
    board.advance(20)
    host.boot_id = int(str(board.state()["boot_id"]))
    for message in (messages.Hello(), CONFIGURE, _command(0, messages.ARM)):
        host.say(message)
        board.advance(5)


def _drive(board: EmulatedBoard, host: _Host, milliseconds: int, commands: int) -> None:
    for number in range(milliseconds // COMMAND_PERIOD):
        for _ in range(commands):
            host.say(_command(number))
        for millisecond in range(COMMAND_PERIOD):
            board.set_condition("supply_mV", RIPPLE[millisecond % 2])
            board.advance(1)
        host.listen_away()


def _command(number: int, flags: int = 0) -> messages.Drive:
    """Turns to and fro across all quadrants, tilts the other way every tenth command."""
    leg = number // 10
    sign = 1 if leg % 2 == 0 else -1
    return messages.Drive(
        flags=flags,
        pivot=sign,
        rate=sign * 0x01000000,
        heading_goal=(number * 0x0A000000 + sign * 0x30000000) & 0xFFFFFFFF,
        start_heading=0,
        tilt=_STEEP,
        field=18000 if leg % 3 else 12000,
        allocation=(_ENTRY, 9001, -7001, -8001, _ENTRY, 6007, 5003, -9007, _ENTRY),
        time_to_live=150,
    )
