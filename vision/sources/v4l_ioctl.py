"""The few requests of Linux's Video4Linux interface that tell what a camera is and can do.

Numbers and layouts are those of linux/videodev2.h; a test compares them with the header's.
"""

from __future__ import annotations

import fcntl
import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from vision.sources.request import Size

CAPABILITY = struct.Struct("=16s32s32sIII12x")
FORMAT = struct.Struct("=III32sI16x")
FRAME_SIZE = struct.Struct("=9I8x")
FRAME_INTERVAL = struct.Struct("=11I8x")
QUERY_CONTROL = struct.Struct("=II32siiiiI8x")
CONTROL = struct.Struct("=Ii")

_READ, _WRITE = 2, 1


def _request(direction: int, number: int, size: int) -> int:
    """As the macro _IOC composes it, for the interface 'V'."""
    return direction << 30 | size << 16 | ord("V") << 8 | number


QUERYCAP = _request(_READ, 0, CAPABILITY.size)
ENUM_FMT = _request(_READ | _WRITE, 2, FORMAT.size)
G_CTRL = _request(_READ | _WRITE, 27, CONTROL.size)
S_CTRL = _request(_READ | _WRITE, 28, CONTROL.size)
QUERYCTRL = _request(_READ | _WRITE, 36, QUERY_CONTROL.size)
ENUM_FRAMESIZES = _request(_READ | _WRITE, 74, FRAME_SIZE.size)
ENUM_FRAMEINTERVALS = _request(_READ | _WRITE, 75, FRAME_INTERVAL.size)

VIDEO_CAPTURE = 0x00000001
"""Capability and buffer type of a node that gives pictures (V4L2_CAP_VIDEO_CAPTURE, V4L2_BUF_TYPE_VIDEO_CAPTURE)."""
DEVICE_CAPS = 0x80000000
DISCRETE = 1
DISABLED = 0x0001

MOST = 64
"""Formats, sizes and rates that a driver is asked for, of each at most."""


@dataclass(frozen=True, slots=True)
class Mode:
    """Pictures of one size in one pixel format. fourcc: such as "MJPG".  rates: frames/s, () when not told."""

    fourcc: str
    size: Size
    rates: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ControlRange:
    """What a control may be set to."""

    low: int
    high: int
    step: int


@contextmanager
def opened(path: Path) -> Iterator[int]:
    """The device's descriptor, which disturbs nobody who streams from it; raises OSError."""
    descriptor = os.open(path, os.O_RDWR | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def gives_pictures(descriptor: int) -> bool:
    """Whether this node captures video; a camera has others, for its metadata. Raises OSError for no V4L device."""
    answer = CAPABILITY.unpack(_ask(descriptor, QUERYCAP, CAPABILITY.pack(b"", b"", b"", 0, 0, 0)))
    whole, own = answer[4], answer[5]
    return bool((own if whole & DEVICE_CAPS else whole) & VIDEO_CAPTURE)


def modes(descriptor: int) -> list[Mode]:
    """What the camera offers; empty when its driver does not tell."""
    return [
        Mode(_letters(fourcc), size, tuple(_rates(descriptor, fourcc, size)))
        for fourcc in _formats(descriptor)
        for size in _sizes(descriptor, fourcc)
    ]


def control_range(descriptor: int, control: int) -> ControlRange | None:
    """None when the camera has no such control, or not now."""
    try:
        answer = QUERY_CONTROL.unpack(
            _ask(descriptor, QUERYCTRL, QUERY_CONTROL.pack(control, 0, b"", 0, 0, 0, 0, 0))
        )
    except OSError:
        return None
    _, _, _, low, high, step, _, flags = answer
    return None if flags & DISABLED else ControlRange(low, high, step)


def set_control(descriptor: int, control: int, value: int) -> None:
    """Raises OSError when the driver refuses; it may also take another value silently."""
    _ask(descriptor, S_CTRL, CONTROL.pack(control, value))


def get_control(descriptor: int, control: int) -> int:
    """Raises OSError."""
    return CONTROL.unpack(_ask(descriptor, G_CTRL, CONTROL.pack(control, 0)))[1]


def _ask(descriptor: int, request: int, argument: bytes) -> bytes:
    return fcntl.ioctl(descriptor, request, argument)


def _answers(descriptor: int, request: int, layout: struct.Struct, arguments: list[bytes]) -> Iterator[tuple]:
    """What the driver enumerates, until it has no more."""
    for argument in arguments:
        try:
            yield layout.unpack(_ask(descriptor, request, argument))
        except OSError:
            return


def _formats(descriptor: int) -> list[int]:
    asked = [FORMAT.pack(index, VIDEO_CAPTURE, 0, b"", 0) for index in range(MOST)]
    return [answer[4] for answer in _answers(descriptor, ENUM_FMT, FORMAT, asked)]


def _sizes(descriptor: int, fourcc: int) -> list[Size]:
    """Discrete ones; of a driver that scales in steps the smallest and the largest."""
    asked = [FRAME_SIZE.pack(index, fourcc, *[0] * 7) for index in range(MOST)]
    sizes: list[Size] = []
    for answer in _answers(descriptor, ENUM_FRAMESIZES, FRAME_SIZE, asked):
        kind, low_width, second, _, low_height, high_height, _ = answer[2:]
        if kind != DISCRETE:
            return [(low_width, low_height), (second, high_height)]
        sizes.append((low_width, second))
    return sizes


def _rates(descriptor: int, fourcc: int, size: Size) -> list[float]:
    """Discrete ones; of a driver with a range the highest and the lowest."""
    asked = [FRAME_INTERVAL.pack(index, fourcc, *size, *[0] * 7) for index in range(MOST)]
    rates: list[float] = []
    for answer in _answers(descriptor, ENUM_FRAMEINTERVALS, FRAME_INTERVAL, asked):
        kind, numerator, denominator, low, below = answer[4:9]
        rates.append(_per_second(numerator, denominator))
        if kind != DISCRETE:
            return [rates[0], _per_second(low, below)]
    return rates


def _per_second(numerator: int, denominator: int) -> float:
    return denominator / numerator if numerator else 0.0


def _letters(fourcc: int) -> str:
    return fourcc.to_bytes(4, "little").decode("ascii", "replace")
