"""The compiled firmware on an emulated UNO, as a child process with a serial port and a lock-step port.

The child ends when its standard input is closed, which the operating system does for a parent that dies however
it may, and soon after its last client has gone.
"""

from __future__ import annotations

import fcntl
import re
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import platformdirs

from control.firmware.build import BuildError, build
from control.firmware.emulator.build import build_emulator, is_stale
from control.simulation.bridges import Winding
from control.simulation.emulator_port import EmulatorPort


def build_folder(root: Path) -> Path:
    """Where what has been built is kept, for the program in `root`: in a checkout beside the sources.

    An installed program has a cache, for each version one: its files may be older than what another version has built.
    """
    if (root / "pyproject.toml").exists():
        return root / "build" / "firmware"
    return platformdirs.user_cache_path("pivotrig", version=version("pivotrig")) / "firmware"


FOLDER = build_folder(Path(__file__).parents[2])
FIRMWARE = Path(__file__).parents[1] / "firmware"
LINGER = 5.0
"""How long the child waits for a new client when the last one has gone, s."""

PATIENCE = 5.0
"""A child that has not ended so long after its standard input was closed is killed, s."""

_GREETING = re.compile(r"board: serial=(\S+) control=(tcp://127\.0\.0\.1:\d+)\n")
_SOURCES = ("portable/*.cpp", "portable/*.h", "avr/*.cpp", "avr/*.h", "*.py")


class EmulationFailed(OSError):
    """The emulated board could not be built or did not start; the text says why."""


@dataclass(frozen=True, slots=True)
class Emulation:
    """The two files that make an emulated board: the emulator, and the firmware that it runs."""

    program: Path
    elf: Path

    def command(self, *options: str) -> list[str]:
        return [str(self.program), "--firmware", str(self.elf), *options]


def prepare(folder: Path = FOLDER) -> Emulation:
    """Builds what is missing or older than its sources; one process at a time."""
    folder.mkdir(parents=True, exist_ok=True)
    with _alone(folder):
        program = build_emulator(folder)
        elf = folder / "pivotrig.elf"
        if is_stale(elf, [source for pattern in _SOURCES for source in FIRMWARE.glob(pattern)]):
            _build(folder)
        return Emulation(program, elf)


def _build(folder: Path) -> None:
    try:
        build(folder)
    except BuildError as error:
        raise EmulationFailed(str(error)) from error


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    with (folder / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def coil_options(windings: Sequence[Winding], supply: float) -> list[str]:
    """Coils (ohm, H) and supply (V) as options of a board process."""
    return [
        *("--supply-V", f"{supply:g}"),
        *("--resistance-ohm", *(f"{coil.resistance:g}" for coil in windings)),
        *("--inductance-mH", *(f"{coil.inductance * 1e3:g}" for coil in windings)),
    ]


class EmulatorProcess:
    """A running emulator. serial: the name of its port; control: the address of its lock-step port."""

    def __init__(self, emulation: Emulation, *options: str) -> None:
        command = emulation.command("--end-with-stdin", *options)
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        greeting = _GREETING.fullmatch(self._first_line())
        if greeting is None:
            self.close()
            raise EmulationFailed(f"the emulated board did not start: {' '.join(command)}")
        self.serial, self.control = greeting[1], greeting[2]

    def _first_line(self) -> str:
        return "" if self._process.stdout is None else self._process.stdout.readline()

    @property
    def pid(self) -> int:
        return self._process.pid

    def close(self) -> None:
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


class EmulatedBoard(EmulatorPort):
    """The world's board: the emulator, started for it and ended with it. port: its serial port."""

    def __init__(
        self,
        emulation: Emulation,
        windings: Sequence[Winding],
        supply: float,
        realtime: bool,
        boot_id: int = 1,
    ) -> None:
        options = [*coil_options(windings, supply), *([] if realtime else ["--paused"])]
        options += ["--linger", f"{LINGER:g}", "--boot-id", str(boot_id)]
        self._emulator = EmulatorProcess(emulation, *options)
        self.port = self._emulator.serial
        try:
            super().__init__(self._emulator.control, realtime)
        except OSError:
            self._emulator.close()
            raise

    @property
    def pid(self) -> int:
        """The emulator's process."""
        return self._emulator.pid

    def close(self) -> None:
        super().close()
        self._emulator.close()
