"""Writing the firmware into a real UNO with avrdude."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

ARDUINO = "arduino"
"""The programmer's name for an UNO's own bootloader, over its USB port."""

BOOTLOADER_BAUD = 115200
TIMEOUT = 120.0
"""Longest time that avrdude may take, s; a bootloader takes some 5."""


class FlashError(Exception):
    """The firmware could not be written; the text says why and what to do."""


@dataclass(frozen=True, slots=True)
class Flashing:
    """What is to be written where. port: a device; programmer: avrdude's name for what writes."""

    hex: Path
    port: str
    programmer: str = ARDUINO

    def command(self, avrdude: str) -> list[str]:
        """avrdude's command line. The bootloader cannot erase the chip, so it is told not to (-D)."""
        over_usb = ["-b", str(BOOTLOADER_BAUD), "-D"] if self.programmer == ARDUINO else []
        device = ["-p", "atmega328p", "-c", self.programmer, "-P", self.port]
        return [avrdude, "-q", *device, *over_usb, "-U", f"flash:w:{self.hex}:i"]


def find_avrdude() -> str:
    found = shutil.which("avrdude")
    if found is None:
        raise FlashError("avrdude is not installed; it writes the firmware: apt-get install avrdude")
    return found


def flash(flashing: Flashing) -> str:
    """Writes and verifies; what avrdude said."""
    command = flashing.command(find_avrdude())
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except subprocess.TimeoutExpired as error:
        raise FlashError(
            f"avrdude has not finished within {TIMEOUT:.0f} s: is {flashing.port} an UNO's port, and has the UNO "
            "its bootloader? Unplug it, plug it in again and try once more"
        ) from error
    if done.returncode != 0:
        raise FlashError(
            f"avrdude failed with status {done.returncode}: {' '.join(command)}\n{done.stderr.strip()[-2000:]}"
        )
    return done.stderr.strip()
