"""The firmware's core, compiled for this computer: a board like `FirmwareTwin`, and programs for whole streams."""

from __future__ import annotations

import ctypes
import functools
import os
import subprocess
import tempfile
from pathlib import Path

from control.firmware.build import WARNINGS, core_sources
from control.link.messages import BoardCode, ResetCause, Triple

SOURCES = Path(__file__).parent / "host"
FOLDER = Path(__file__).parents[2] / "build" / "firmware" / "host"
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g", "-O1")

_Counts = ctypes.c_uint16 * 4
_Steps = ctypes.c_int16 * 3
_Records = ctypes.c_uint16 * 256


def compile_core(target: Path, source: str, *flags: str) -> None:
    """The core with one of `host`'s sources."""
    sources = [str(path) for path in (*core_sources(), SOURCES / source)]
    command = ["g++", "-std=c++17", "-fno-exceptions", *flags, *WARNINGS, *sources, "-o", str(target)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def compiled(name: str, source: str, *flags: str) -> Path:
    """A program or library in the build folder, renamed into place when it is whole."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    target = FOLDER / name
    with tempfile.TemporaryDirectory(dir=FOLDER) as scratch:
        made = Path(scratch) / name
        compile_core(made, source, *flags)
        made.replace(target)
    return target


@functools.cache
def library() -> ctypes.CDLL:
    """With PIVOTRIG_CORE_LIBRARY set, the library at that path instead of a fresh one."""
    given = os.environ.get("PIVOTRIG_CORE_LIBRARY")
    path = given or str(compiled(f"core-{os.getpid()}.so", "core_abi.cpp", "-shared", "-fPIC", "-O1"))
    loaded = ctypes.CDLL(path)
    if not given:
        Path(path).unlink()
    loaded.board_boot.restype = ctypes.c_void_p
    loaded.core_sine.restype = ctypes.c_int16
    loaded.core_reset_cause.restype = ctypes.c_uint8
    loaded.core_reset_cause_handed_over.restype = ctypes.c_uint8
    loaded.core_count_boot.restype = ctypes.c_uint16
    return loaded


def run_stream(program: Path, data: bytes) -> list[int]:
    """What the program prints of a whole stream: state, three PWM steps, ticks that drove."""
    done = subprocess.run([str(program)], input=data, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return [int(word) for word in done.stdout.split()]


class CoreBoard:
    """The C++ core with the twin's interface; `close` frees it."""

    def __init__(self, boot_id: int, reset_cause: int = ResetCause.POWER_ON) -> None:
        self._library = library()
        self._board = ctypes.c_void_p(self._library.board_boot(boot_id, int(reset_cause)))
        self.driver_fault = False
        self.duty: Triple = (0, 0, 0)

    def close(self) -> None:
        self._library.board_delete(self._board)

    def receive(self, data: bytes) -> None:
        self._library.board_receive(self._board, data, len(data))

    def tick(self, counts: Triple, supply_count: int) -> Triple:
        steps = _Steps()
        readings = _Counts(*counts, supply_count)
        self._library.board_tick(self._board, readings, int(self.driver_fault), steps)
        x, y, z = steps
        self.duty = x, y, z
        return self.duty

    def transmit(self, most: int) -> bytes:
        buffer = ctypes.create_string_buffer(most)
        taken = self._library.board_transmit(self._board, buffer, most)
        return buffer.raw[:taken]

    @property
    def state(self) -> BoardCode:
        return BoardCode(self._library.board_state(self._board) & 0xFF)


def sine(angle: int) -> int:
    return library().core_sine(angle)


def reset_cause(flags: int) -> ResetCause:
    return ResetCause(library().core_reset_cause(flags))


def reset_cause_handed_over(bootloader: int, flags: int) -> ResetCause:
    return ResetCause(library().core_reset_cause_handed_over(bootloader, flags))


class BootMemory:
    """The EEPROM records of the boot count: 128 pairs of an id and its complement; empty cells are 0xFFFF."""

    def __init__(self) -> None:
        self.words = _Records(*[0xFFFF] * 256)

    def boot(self) -> int:
        return library().core_count_boot(self.words)
