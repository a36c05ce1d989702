"""The computer: Python, packages, clock, room for real time, tools for the firmware."""

from __future__ import annotations

import os
import platform
import re
import shutil
import statistics
import sys
import time
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution, requires, version
from pathlib import Path

from server.assembly import build_machine
from server.diagnosis.check import Check, info, ok, problem, warning
from server.exchange import without_devices
from server.settings import RigFile

OLDEST_PYTHON = (3, 11)

TICKS = 90
"""Frames that the loop is tried with; the first third warms up."""
BUSY_SHARE = 0.5
"""Of a frame's time the loop may take at most, so that something else may happen too."""

NAPS = 100
NAP = 1e-3
LATE = 10e-3
"""A nap of 1 ms that ends later than this, s, is a computer with something else to do: half a frame at 60 Hz."""

COARSEST_CLOCK = 1e-3
"""Resolution that the rig's clock needs, s: the board's tick."""

FIRMWARE_TOOLS = {
    "avr-g++": "gcc-avr",
    "avr-size": "binutils-avr",
    "avrdude": "avrdude",
    "gcc": "gcc",
}
"""Program and Debian package."""
FIRMWARE_FILES = {
    Path("/usr/lib/avr/include/avr/io.h"): "avr-libc",
    Path("/usr/include/simavr/sim_avr.h"): "libsimavr-dev",
    Path("/usr/include/libelf.h"): "libelf-dev",
}
"""File and Debian package."""


def examine() -> Iterator[Check]:
    yield python()
    yield packages()
    yield environment()
    yield clock()
    yield scheduling()
    yield firmware_tools()


def python() -> Check:
    found = (
        f"Python {platform.python_version()}, pivotrig {version('pivotrig')}, {platform.platform(terse=True)}"
    )
    if sys.version_info[:2] < OLDEST_PYTHON:
        wanted = ".".join(map(str, OLDEST_PYTHON))
        return problem(
            "python", found, f"pivotrig needs Python {wanted} or newer; `make setup` finds or gets one"
        )
    return ok("python", found)


def packages() -> Check:
    names = [re.split(r"[^\w.-]", requirement)[0] for requirement in requires("pivotrig") or []]
    missing = [name for name in names if not is_installed(name)]
    if missing:
        return problem("packages", f"missing: {', '.join(missing)}", "install them with `make setup`")
    shown = ("numpy", "opencv-python-headless", "pyserial", "fastapi", "viser")
    return ok("packages", f"all {len(names)}; " + ", ".join(f"{name} {version(name)}" for name in shown))


def environment() -> Check:
    """python-control, too, is imported as `control`."""
    if is_installed("control"):
        return problem(
            "environment",
            "python-control is installed here and is imported under the same name as a part of pivotrig",
            "give pivotrig an environment of its own: `make setup` makes one",
        )
    return ok("environment", f"{sys.prefix}, of its own")


def is_installed(name: str) -> bool:
    try:
        distribution(name)
    except PackageNotFoundError:
        return False
    return True


def clock() -> Check:
    """Everything runs by the monotonic clock; the calendar only dates recordings."""
    monotonic = time.get_clock_info("monotonic")
    if not monotonic.resolution <= COARSEST_CLOCK:
        return problem(
            "clock",
            f"the monotonic clock ticks every {monotonic.resolution * 1e3:g} ms, 1 ms at most is needed",
            "use another computer or operating system",
        )
    now = time.strftime("%Y-%m-%d %H:%M:%S %Z")
    if time.time() < Path(__file__).stat().st_mtime:
        return warning("clock", f"it says {now}, which is before pivotrig was installed", "set the date")
    return ok("clock", f"{now}; monotonic to {monotonic.resolution * 1e9:g} ns")


def scheduling() -> Check:
    """How late a thread that slept comes back: the loop's own sleep is the camera's."""
    late = max(_overslept() for _ in range(NAPS))
    found = f"{os.cpu_count()} cores; a nap of 1 ms ended {late * 1e3:.1f} ms late at worst ({NAPS} naps)"
    if late > LATE:
        return warning("scheduling", found, "close other programs; a laptop: plug it in, no power saving")
    if (os.cpu_count() or 1) < 2:
        return warning("scheduling", found, "two cores keep the dashboard from disturbing the loop")
    return ok("scheduling", found)


def _overslept() -> float:
    begin = time.perf_counter()
    time.sleep(NAP)
    return time.perf_counter() - begin - NAP


def headroom(settings: RigFile) -> Check:
    """What one pass of the loop takes, with this rig simulated."""
    period = 1.0 / settings.camera.rate_Hz
    median, worst = tick_times(settings)
    share = worst / period
    found = (
        f"one pass of the loop takes {median * 1e3:.1f} ms, {worst * 1e3:.1f} ms at worst: "
        f"{share:.0%} of a frame at {settings.camera.rate_Hz:g} Hz"
    )
    if not share <= 1.0:
        return problem(
            "real time", found, "lower camera.rate_Hz or the picture's size, or use a faster computer"
        )
    if not share <= BUSY_SHARE:
        return warning("real time", found, "close other programs, or lower camera.rate_Hz")
    return ok("real time", found)


def tick_times(settings: RigFile) -> tuple[float, float]:
    """Median and 95th percentile of one tick, s; the picture is rendered outside of it."""
    machine = build_machine(without_devices(settings), realtime=False)
    try:
        machine.open()
        times = []
        for _ in range(TICKS):
            frame = machine.camera.read(0.05)
            begin = time.perf_counter()
            machine.loop.tick(frame, machine.camera.now())
            times.append(time.perf_counter() - begin)
    finally:
        machine.close()
    steady = times[TICKS // 3 :]
    return statistics.median(steady), statistics.quantiles(steady, n=20)[-1]


def firmware_tools() -> Check:
    missing = {package for program, package in FIRMWARE_TOOLS.items() if shutil.which(program) is None}
    missing |= {package for file, package in FIRMWARE_FILES.items() if not file.exists()}
    if missing:
        return info(
            "firmware tools",
            f"not here: {', '.join(sorted(missing))}; only the firmware and the emulated board need them",
            f"apt install {' '.join(sorted(missing))}",
        )
    return ok("firmware tools", "avr-gcc, avrdude and simavr are here")
