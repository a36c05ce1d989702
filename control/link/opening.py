"""Opening a serial port for ourselves alone, and saying what is in the way when that fails."""

from __future__ import annotations

import errno
import fcntl
import grp
import os
import termios
from enum import StrEnum
from typing import Any

import serial

from control.link.conversion import LinkError
from control.link.device import Device
from control.link.line import SerialLine

WRITE_TIMEOUT = 0.03
"""A port that takes no bytes for so long is jammed, s: two frames, once."""

PORT_ERRORS = (OSError, termios.error)
"""What a port that fails raises: pyserial lets the terminal's own error through, which is no OSError."""

_PSEUDO_TERMINALS = range(136, 144)
"""Major device numbers of Unix98 pseudo-terminals' host ends (Linux, Documentation/admin-guide/devices.txt)."""


class Trouble(StrEnum):
    """Why a port cannot be opened."""

    BUSY = "busy"
    FORBIDDEN = "forbidden"
    MISSING = "missing"
    FAILED = "failed"


class PortError(LinkError):
    """A port that cannot be opened. trouble: the kind of it."""

    def __init__(self, message: str, trouble: Trouble) -> None:
        super().__init__(message)
        self.trouble = trouble


def open_serial(port: str, baud: int) -> SerialLine:
    """The open port, ours alone; nothing blocks on it for longer than WRITE_TIMEOUT. Raises `PortError`."""
    try:
        opened: Any = serial.serial_for_url(
            port, baudrate=baud, timeout=0, write_timeout=WRITE_TIMEOUT, exclusive=True
        )
        if not isinstance(opened, serial.Serial):
            return opened
        _shut_others_out(opened)
        return Device(opened, WRITE_TIMEOUT)
    except (*PORT_ERRORS, ValueError) as error:
        raise _refusal(port, baud, error) from error


def trouble_of(error: BaseException) -> Trouble:
    number = error.errno if isinstance(error, OSError) else None
    if number in (errno.EBUSY, errno.EAGAIN):
        return Trouble.BUSY
    if number in (errno.EACCES, errno.EPERM):
        return Trouble.FORBIDDEN
    if number in (errno.ENOENT, errno.ENODEV, errno.ENXIO):
        return Trouble.MISSING
    return Trouble.FAILED


def _refusal(port: str, baud: int, error: BaseException) -> PortError:
    trouble = trouble_of(error)
    advice = {
        Trouble.BUSY: "Close the other program that has it open: a serial monitor, or another pivotrig",
        Trouble.FORBIDDEN: permission_advice(port),
        Trouble.MISSING: "Check that the board is connected and the name is right (`pivotrig doctor` lists them)",
        Trouble.FAILED: "Check that it is connected and that no other program has it open",
    }[trouble]
    return PortError(f"cannot open {port} at {baud} baud: {error}. {advice}", trouble)


def permission_advice(port: str) -> str:
    """How to be allowed to use a device, by the group that it belongs to."""
    try:
        group = grp.getgrgid(os.stat(port).st_gid).gr_name
    except (OSError, KeyError):
        group = "dialout"
    return (
        f"You may not use it: it belongs to the group {group}. Run `sudo usermod -aG {group} $USER`, "
        "then log out and in again"
    )


def _shut_others_out(opened: serial.Serial) -> None:
    """Programs that know nothing of pyserial's file lock would steal bytes, and reset an UNO by opening its port.

    A pseudo-terminal would keep the mark after its user has died, and nobody could come back to it.
    """
    try:
        descriptor = opened.fileno()
        if not is_pseudo_terminal(descriptor):
            make_exclusive(descriptor)
    except PORT_ERRORS:  # it is gone again
        opened.close()
        raise


def is_pseudo_terminal(descriptor: int) -> bool:
    return os.major(os.fstat(descriptor).st_rdev) in _PSEUDO_TERMINALS


def make_exclusive(descriptor: int) -> None:
    """Further opens of the terminal fail, for all but the administrator, until it is closed."""
    fcntl.ioctl(descriptor, termios.TIOCEXCL)
