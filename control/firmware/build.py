"""Compiles the firmware for the ATmega328P of an Arduino UNO.

build(folder) -> Build    folder/pivotrig.elf and folder/pivotrig.hex
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

SOURCES = Path(__file__).parent
MCU = "atmega328p"
CLOCK = 16_000_000
"""Of the UNO's processor, Hz."""

FLASH_SIZE = 32 * 1024
RAM_SIZE = 2 * 1024

WARNINGS = ("-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror")
_COMPILER_FLAGS = (
    *("-std=c++1z", f"-mmcu={MCU}", f"-DF_CPU={CLOCK}UL", "-O2", "-flto"),
    *("-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics"),
)
_PACKAGES = {"avr-g++": "gcc-avr avr-libc", "avr-objcopy": "binutils-avr", "avr-size": "binutils-avr"}


class BuildError(Exception):
    """The firmware cannot be built; the text says why and what to do."""


@dataclass(frozen=True, slots=True)
class Build:
    """flash_bytes: of the program.  ram_bytes: static data; the rest is the stack's.  Shares of the processor's."""

    elf: Path
    hex: Path
    flash_bytes: int
    ram_bytes: int

    @property
    def flash_share(self) -> float:
        return self.flash_bytes / FLASH_SIZE

    @property
    def ram_share(self) -> float:
        return self.ram_bytes / RAM_SIZE


def core_sources() -> list[Path]:
    """The portable part: everything but registers."""
    return sorted((SOURCES / "portable").glob("*.cpp"))


def build(folder: Path) -> Build:
    """Compile into `folder`, which is made; raises `BuildError`."""
    folder.mkdir(parents=True, exist_ok=True)
    elf, image = folder / "pivotrig.elf", folder / "pivotrig.hex"
    sources = [*core_sources(), *sorted((SOURCES / "avr").glob("*.cpp"))]
    with tempfile.TemporaryDirectory(dir=folder) as name:  # two builds at once do not see each other's halves
        made, made_image = Path(name) / elf.name, Path(name) / image.name
        _run(["avr-g++", *_COMPILER_FLAGS, *WARNINGS, *map(str, sources), "-o", str(made)])
        _run(["avr-objcopy", "-O", "ihex", "-R", ".eeprom", str(made), str(made_image)])
        flash, ram = _sizes(_run(["avr-size", "-A", str(made)]))
        made.replace(elf)
        made_image.replace(image)
    return Build(elf, image, flash, ram)


def _sizes(table: str) -> tuple[int, int]:
    """Bytes of flash and of static RAM, from `avr-size -A`: .data takes both."""
    rows = re.findall(r"^\.(\S+)\s+(\d+)\s", table, re.MULTILINE)
    size = {name: int(count) for name, count in rows}
    data = size.get("data", 0)
    return size.get("text", 0) + data, data + size.get("bss", 0) + size.get("noinit", 0)


def _run(command: Sequence[str]) -> str:
    if shutil.which(command[0]) is None:
        package = _PACKAGES[command[0]]
        raise BuildError(f"{command[0]} is missing: install it with `sudo apt install {package}`")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise BuildError(f"{command[0]} failed with code {done.returncode}:\n{done.stderr.strip()}")
    return done.stdout
