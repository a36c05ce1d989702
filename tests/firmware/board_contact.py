"""A hand on the wire of any board: the twin's process, the emulated board, or a real one.

A simulated board is stepped, so its milliseconds are counted; a real one runs by itself.
"""

from __future__ import annotations

import os
import termios
import time
import tty
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, Literal, Protocol

from control.link import wire
from control.link.conversion import phase
from control.link.line import SerialLine
from control.link.messages import ARM, Banner, BoardCode, Drive, Hello, Message, Stop, Telemetry
from control.link.opening import open_serial
from control.link.probe import BAUD
from control.simulation.emulated import EmulatorProcess, prepare
from control.simulation.emulator_port import EmulatorPort
from control.simulation.lockstep import RemoteBoard, Sample
from tests.processes import started
from tests.simulation.board_bench import CALM, CONFIGURE

Kind = Literal["twin", "avr", "real"]


class Wire(Protocol):
    """The host's end of a serial line."""

    def write(self, data: bytes) -> None: ...
    def read(self) -> bytes: ...


class Terminal:
    """A pseudo-terminal, or a real port that is set up already."""

    def __init__(self, name: str) -> None:
        self._file = os.open(name, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self._file, termios.TCSANOW)  # a flush may yet swallow what comes right after it

    def write(self, data: bytes) -> None:
        os.write(self._file, data)

    def read(self) -> bytes:
        data = b""
        try:
            while chunk := os.read(self._file, 4096):
                data += chunk
        except BlockingIOError:
            pass
        return data

    def close(self) -> None:
        os.close(self._file)


class BoardContact:
    """Numbers and frames what it is told, runs the board, and keeps what was heard."""

    def __init__(self, wire_: Wire) -> None:
        self._wire = wire_
        self._decoder = wire.Decoder()
        self.sequence = 0
        self.boot_id = 0
        self.heard: list[wire.Packet] = []

    def run(self, milliseconds: int) -> None:
        """Lets the board run on; a real one does so by itself."""
        time.sleep(milliseconds * 1e-3)
        self.listen()

    def listen(self) -> None:
        packets = self._decoder.feed(self._wire.read())
        self.heard += packets
        for packet in packets:
            self.boot_id = packet.boot_id

    def put(self, data: bytes) -> None:
        """Bytes as they are."""
        self._wire.write(data)

    def send(self, message: Message, **header: int) -> int:
        """One message with the next number and the board's boot id, unless told otherwise; its number."""
        self.sequence = header.get("sequence", (self.sequence + 1) % 65536)
        boot_id = header.get("boot_id", self.boot_id)
        version = header.get("version", wire.PROTOCOL_VERSION)
        self.put(wire.encode(message, self.sequence, boot_id, version))
        return self.sequence

    def say(self, message: Message, **header: int) -> None:
        """Sends, and runs until the board has taken the last byte."""
        self.send(message, **header)
        self.run(4)

    def ready(self) -> None:
        self.say(Hello())
        self.say(CONFIGURE)
        assert self.banners[-1].configuration_hash == wire.configuration_hash(CONFIGURE)

    def ready_again(self) -> None:
        """From wherever it is to driving; a board that is harmed may refuse."""
        for message in (Hello(), CONFIGURE, self.command(flags=ARM)):
            self.say(message)

    def arm(self, start: float = 0.0, **changes: Any) -> None:
        self.ready()
        self.say(self.command(start, flags=ARM, **changes))

    def driving(self, start: float = 0.0, milliseconds: int = 600) -> None:
        """Armed, with field and currents up."""
        self.arm(start)
        for _ in range(milliseconds // 20):
            self.say(self.command(start))
            self.run(16)
        assert self.state is BoardCode.DRIVING

    @staticmethod
    def command(start: float = 0.0, **changes: Any) -> Drive:
        return replace(CALM, start_heading=phase(start), heading_goal=phase(start), **changes)

    def stop(self) -> None:
        self.say(Stop())

    @property
    def reports(self) -> list[Telemetry]:
        return [packet.message for packet in self.heard if isinstance(packet.message, Telemetry)]

    @property
    def banners(self) -> list[Banner]:
        return [packet.message for packet in self.heard if isinstance(packet.message, Banner)]

    @property
    def report(self) -> Telemetry:
        """What the board says of itself now: the next report."""
        before = len(self.reports)
        for _ in range(8):
            self.run(4)
            if len(self.reports) > before:
                return self.reports[-1]
        raise TimeoutError("the board has not reported for 32 ms")

    @property
    def state(self) -> BoardCode:
        return BoardCode(self.report.state)


class SteppedContact(BoardContact):
    """A simulated board, with a look at its pins and coils: a sample for each of its milliseconds."""

    def __init__(self, terminal: Terminal, board: RemoteBoard) -> None:
        super().__init__(terminal)
        self.board = board
        self.samples: list[Sample] = []

    def run(self, milliseconds: int) -> None:
        self.samples += self.board.step(milliseconds)
        self.listen()

    @property
    def now(self) -> int:
        """The board's time, ms."""
        return self.samples[-1].milliseconds

    @property
    def duty(self) -> tuple[int, int, int]:
        return self.samples[-1].duty

    @property
    def is_zero(self) -> bool:
        return self.duty == (0, 0, 0)

    @property
    def last_driven(self) -> int:
        """The last millisecond with a PWM that was not zero."""
        return max((s.milliseconds for s in self.samples if s.duty != (0, 0, 0)), default=0)


@contextmanager
def stepped(kind: Kind) -> Iterator[SteppedContact]:
    """A fresh board that has booted and said so."""
    with process_of(kind) as (serial, control):
        terminal, board = Terminal(serial), EmulatorPort(control, realtime=False)
        try:
            contact = SteppedContact(terminal, board)
            contact.run(30)
            yield contact
        finally:
            terminal.close()
            board.close()


@contextmanager
def process_of(kind: Kind, *options: str) -> Iterator[tuple[str, str]]:
    """The board in a process of its own: its serial port, its lock-step port."""
    if kind == "avr":
        emulator = EmulatorProcess(prepare(), *options)
        try:
            yield emulator.serial, emulator.control
        finally:
            emulator.close()
        return
    with started("control.simulation.board_process", *options) as (_, line):
        _, serial, control = line.split()
        yield serial.removeprefix("serial="), control.removeprefix("control=")


@contextmanager
def real(port: str) -> Iterator[BoardContact]:
    """A board on a real port, at rest when it is left."""
    line = open_serial(port, BAUD)
    contact = BoardContact(_RealWire(line))
    try:
        contact.run(2500)  # its bootloader
        yield contact
        contact.stop()
    finally:
        line.close()


class _RealWire:
    def __init__(self, line: SerialLine) -> None:
        self._line = line

    def write(self, data: bytes) -> None:
        self._line.write(data)

    def read(self) -> bytes:
        return self._line.read(self._line.in_waiting)
