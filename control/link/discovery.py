"""Which boards are plugged in: serial ports with the USB ids of an Arduino UNO or of what its clones use.

Listing opens nothing. Asking a port who it is opens it, which resets an UNO: see `control.link.probe`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from serial.tools import list_ports

from control.link.opening import PortError, Trouble
from control.link.probe import Findings, PortState, probe

AUTO = "auto"
"""The port's name that stands for the one board that is plugged in."""

KNOWN_BOARDS = {
    "2341:0043": "Arduino UNO R3",
    "2341:0001": "Arduino UNO",
    "2341:0243": "Arduino UNO R3",
    "2a03:0043": "Arduino UNO R3 (arduino.org)",
    "1a86:7523": "UNO clone with CH340",
    "1a86:5523": "UNO clone with CH341",
    "0403:6001": "board with FTDI FT232R",
    "0403:6015": "board with FTDI FT231X",
    "10c4:ea60": "board with CP2102",
}
"""USB ids as the Arduino core's boards.txt and the makers of the bridge chips give them."""

_BY_ID = Path("/dev/serial/by-id")


@dataclass(frozen=True, slots=True)
class UsbPort:
    """One serial port on USB. usb_id: vendor:product, hex.  by_id: its lasting name, "" without one."""

    device: str
    usb_id: str
    serial_number: str = ""
    description: str = ""
    by_id: str = ""

    @property
    def board(self) -> str:
        """What its ids say it is; "" when they are not an UNO's."""
        return KNOWN_BOARDS.get(self.usb_id, "")

    @property
    def in_words(self) -> str:
        return f"{self.by_id or self.device} ({self.board or self.description or self.usb_id})"


@dataclass(frozen=True, slots=True)
class FoundPort:
    """A port, and what is known of who is there."""

    port: UsbPort
    findings: Findings


NOT_ASKED = Findings(PortState.UNKNOWN, "not asked who it is: that would reset the board")
IN_USE = Findings(PortState.BUSY, "in use by this rig")


def usb_ports() -> list[UsbPort]:
    """Every serial port on USB, known boards first; opens none."""
    lasting = _lasting_names()
    ports = [
        UsbPort(
            device=port.device,
            usb_id=f"{port.vid:04x}:{port.pid:04x}",
            serial_number=port.serial_number or "",
            description=port.description or "",
            by_id=lasting.get(port.device, ""),
        )
        for port in list_ports.comports()
        if port.vid is not None and port.pid is not None
    ]
    return sorted(ports, key=lambda port: (not port.board, port.device))


def _lasting_names() -> dict[str, str]:
    """Device to its name under /dev/serial/by-id, which stays the same however it is plugged in."""
    try:
        return {str(link.resolve()): str(link) for link in sorted(_BY_ID.iterdir())}
    except OSError:
        return {}  # no such folder: no serial port on USB, or a system without udev


def find_boards(probe_them: bool = False, leave: Collection[str] = ()) -> list[FoundPort]:
    """The ports on USB. probe_them: ask each known board who it is.  leave: ports in use, never opened."""
    return [_look_at(port, probe_them, leave) for port in usb_ports()]


def _look_at(port: UsbPort, probe_it: bool, leave: Collection[str]) -> FoundPort:
    if any(same_device(port.device, used) for used in leave):
        return FoundPort(port, IN_USE)
    return FoundPort(port, probe(port.device) if probe_it and port.board else NOT_ASKED)


def same_device(one: str, other: str) -> bool:
    """Whether two names, lasting ones included, are one device's."""
    return Path(one).resolve() == Path(other).resolve()


class TheOneBoard:
    """`auto`: the one board that is plugged in; once one with a serial number has been used, that one and no other,
    since another one may have another rig's coils.
    """

    def __init__(self, ports: Callable[[], Sequence[UsbPort]] = usb_ports) -> None:
        self._ports = ports
        self._used: UsbPort | None = None

    def __call__(self) -> str:
        """Its device now; raises `PortError` with what there is instead."""
        ports = self._ports()
        self._used = self._only(ports, [port for port in ports if port.board])
        return self._used.device

    def _only(self, ports: Sequence[UsbPort], boards: Sequence[UsbPort]) -> UsbPort:
        known = [board for board in boards if self._is_used_before(board)]
        if len(known) == 1:
            return known[0]
        if boards and self._used is not None and self._used.serial_number:
            raise PortError(_another(self._used, boards), Trouble.MISSING)
        if len(boards) != 1:
            raise PortError(_not_one(ports, boards), Trouble.MISSING)
        return boards[0]

    def _is_used_before(self, board: UsbPort) -> bool:
        used = self._used
        if used is None or not used.serial_number:
            return False
        return (board.usb_id, board.serial_number) == (used.usb_id, used.serial_number)


def _another(used: UsbPort, boards: Sequence[UsbPort]) -> str:
    listed = ", ".join(board.in_words for board in boards)
    return (
        f"the board that was used, {used.in_words}, is not connected any more, and {listed} is not taken for it. "
        "Plug it in again; to use another one, name its port as link.port in the rig file, or start pivotrig anew"
    )


def _not_one(ports: Sequence[UsbPort], boards: Sequence[UsbPort]) -> str:
    if boards:
        listed = ", ".join(board.in_words for board in boards)
        return f"{len(boards)} boards are connected: {listed}. Name one as link.port in the rig file"
    listed = ", ".join(port.in_words for port in ports) or "no serial port on USB at all"
    return (
        f"no board is connected: an UNO's USB ids are looked for, and there is {listed}. "
        "Plug it in, or name its port as link.port in the rig file"
    )


def locator(port: str) -> Callable[[], str]:
    """Where a port is now, asked at each attempt to open it."""
    return TheOneBoard() if port == AUTO else lambda: port
