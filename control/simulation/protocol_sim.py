"""pyserial's URL handler for `sim://NAME`: the serial port of a simulated board in this process.

pyserial finds the module by its name once the package is among `serial.protocol_handler_packages`, which
happens when the first board registers.
"""

from __future__ import annotations

import errno
from typing import Any, Protocol

import serial
from serial.serialutil import PortNotOpenError, SerialBase, SerialException, SerialTimeoutException

_PACKAGE = "control.simulation"


class SimulatedLine(Protocol):
    """The host's end of a board's serial line."""

    plugged: bool

    @property
    def waiting(self) -> int: ...
    @property
    def room(self) -> int: ...
    def write(self, data: bytes) -> None: ...
    def read(self, most: int) -> bytes: ...


_boards: dict[str, SimulatedLine] = {}
_taken: set[str] = set()


def register(name: str, board: SimulatedLine) -> None:
    """Offers a board as sim://NAME."""
    if name in _boards:
        raise ValueError(f"a simulated board named {name!r} exists already; close it or choose another name")
    if _PACKAGE not in serial.protocol_handler_packages:
        serial.protocol_handler_packages.append(_PACKAGE)
    _boards[name] = board


def open_ports() -> frozenset[str]:
    """Names of the boards that are offered, and of those whose port is open."""
    return frozenset(_boards) | _taken


def unregister(name: str, board: SimulatedLine) -> None:
    if _boards.get(name) is board:
        del _boards[name]


class Serial(SerialBase):
    """A port that never waits: it reads what is there and refuses what does not fit."""

    _board: SimulatedLine | None = None
    _name = ""

    def open(self) -> None:
        name = str(self.portstr or "").removeprefix("sim://").strip("/")
        board = _boards.get(name)
        if board is None or not board.plugged:
            known = ", ".join(f"sim://{other}" for other in sorted(_boards)) or "none"
            raise SerialException(errno.ENOENT, f"no simulated board at {self.portstr}; there are: {known}")
        if name in _taken:
            raise SerialException(errno.EBUSY, f"{self.portstr} is in use")
        _taken.add(name)
        self._name, self._board = name, board
        self.is_open = True

    def close(self) -> None:
        if self.is_open:
            self.is_open = False
            self._board = None
            _taken.discard(self._name)

    def _line(self) -> SimulatedLine:
        if self._board is None:
            raise PortNotOpenError()
        if not self._board.plugged or _boards.get(self._name) is not self._board:
            raise SerialException(f"{self.portstr} was unplugged")
        return self._board

    @property
    def in_waiting(self) -> int:
        return self._line().waiting

    @property
    def out_waiting(self) -> int:
        self._line()
        return 0

    def read(self, size: int = 1) -> bytes:
        return self._line().read(size)

    def write(self, b: Any, /) -> int:
        line = self._line()
        data = bytes(b)
        if len(data) > line.room:
            raise SerialTimeoutException("Write timeout")
        line.write(data)
        return len(data)

    def reset_input_buffer(self) -> None:
        line = self._line()
        line.read(line.waiting)

    def reset_output_buffer(self) -> None:
        self._line()

    def flush(self) -> None:
        self._line()

    def _reconfigure_port(self) -> None:
        """Baud rate and framing mean nothing to a line in memory."""
