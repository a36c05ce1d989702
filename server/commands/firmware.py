"""`pivotrig firmware …`: build the board's program, write it into a board, run it in the emulator, count its cycles."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from server.commands.outcome import FAILED, REFUSED, USAGE, console, fail
from server.signals import handled

if TYPE_CHECKING:
    from types import FrameType

    from control.firmware.build import Build
    from control.simulation.emulator_port import Cycles, Stretch

app = typer.Typer(
    no_args_is_help=True, help="The board's program: build it, write it, run it in the emulator."
)

FolderOption = Annotated[
    Path | None, typer.Option("--folder", help="Where to build; default: build/firmware beside the program.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")]

LOOK_AGAIN = 0.1
"""Between two looks at the emulator, s."""

MOST_SHARE = 0.6
"""Of its millisecond that the 1 kHz interrupt may take: the rest is for bytes and messages."""


@app.callback()
def firmware() -> None:
    """The board's program: build it, write it, run it in the emulator."""


@app.command()
def build(folder: FolderOption = None, as_json: JsonOption = False) -> None:
    """Compile the firmware for an Arduino UNO; print what it takes of flash and RAM."""
    made = _built(folder)
    if as_json:
        print(json.dumps(_sizes_json(made)))
        return
    print(f"{made.elf}\n{made.hex}\n")
    print(f"{'memory':<8}{'bytes':>8}{'of':>8}{'share':>9}")
    for name, used, share in _sizes(made):
        print(f"{name:<8}{used:>8}{round(used / share):>8}{share:>9.1%}")


def _sizes(made: Build) -> tuple[tuple[str, int, float], ...]:
    return ("flash", made.flash_bytes, made.flash_share), ("RAM", made.ram_bytes, made.ram_share)


def _sizes_json(made: Build) -> dict[str, object]:
    return {
        "elf": str(made.elf),
        "hex": str(made.hex),
        "flash_bytes": made.flash_bytes,
        "flash_share": round(made.flash_share, 4),
        "ram_bytes": made.ram_bytes,
        "ram_share": round(made.ram_share, 4),
    }


def _built(folder: Path | None) -> Build:
    from control.firmware.build import BuildError
    from control.firmware.build import build as compile_firmware
    from control.simulation.emulated import FOLDER

    try:
        return compile_firmware(folder or FOLDER)
    except (BuildError, OSError) as error:
        raise fail(str(error), FAILED) from error


# ---- a real board


@app.command()
def flash(
    port: Annotated[
        str | None, typer.Option(help="The board's serial port; default: the one board that is connected.")
    ] = None,
    programmer: Annotated[
        str, typer.Option(help="avrdude's name of what writes; an UNO writes itself as arduino.")
    ] = "arduino",
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    folder: FolderOption = None,
) -> None:
    """Build the firmware and write it into a real board, after asking."""
    from control.firmware.flashing import ARDUINO, FlashError, Flashing, find_avrdude
    from control.firmware.flashing import flash as write

    made = _built(folder)
    flashing = Flashing(made.hex, port or _the_one_port(), programmer)
    try:
        command = flashing.command(find_avrdude())
    except FlashError as error:
        raise fail(str(error), FAILED) from error
    _confirm(made, flashing.port, command, yes)
    if (
        programmer == ARDUINO or Path(flashing.port).exists()
    ):  # another programmer's may be no device, like `usb`
        _refuse_if_in_use(flashing.port)
    try:
        with console.status(f"writing to {flashing.port}"):
            write(flashing)
    except FlashError as error:
        raise fail(str(error), FAILED) from error
    print(f"written and verified: {made.hex.name} on {flashing.port}")


def _the_one_port() -> str:
    from control.link.discovery import TheOneBoard
    from control.link.opening import PortError

    try:
        return TheOneBoard()()
    except PortError as error:
        raise fail(f"{error}. Or say --port", USAGE) from error


def _confirm(made: Build, port: str, command: list[str], yes: bool) -> None:
    from control.simulation.twin import FIRMWARE_VERSION

    version = ".".join(map(str, FIRMWARE_VERSION))
    lines = (
        f"firmware {version} ({made.flash_bytes} bytes) goes to the board on {port}; what it runs now is lost",
        f"by: {' '.join(command)}",
        "switch the coil supply off first: while it is written all pins of the board are open",
    )
    for line in lines:
        console.print(line, markup=False, highlight=False, soft_wrap=True)
    if not yes and not typer.confirm("Write it?", default=False, err=True):
        raise fail("nothing was written", FAILED)


def _refuse_if_in_use(port: str) -> None:
    """A port that this rig or another program has open is not written to."""
    from control.link.opening import PortError, open_serial
    from control.link.probe import BAUD

    try:
        open_serial(port, BAUD).close()
    except PortError as error:
        raise fail(str(error), REFUSED) from error


# ---- the emulated board


@app.command()
def emulate(
    control_port: Annotated[
        int,
        typer.Option("--control-port", min=0, max=65535, help="TCP port on loopback; 0 picks a free one."),
    ] = 0,
    folder: FolderOption = None,
) -> None:
    """Run the compiled firmware on an emulated UNO with coils, in real time, until Ctrl-C.

    Prints the serial port and the control port. For a rig file:
    link.port = the serial port, simulation.board = the control port.
    """
    from control.simulation.emulated import prepare

    try:
        emulation = prepare(*_given(folder))
    except OSError as error:
        raise fail(str(error), FAILED) from error
    _run_until_interrupted(emulation.command("--control-port", str(control_port), "--linger", "1e9"))


def _given(folder: Path | None) -> tuple[Path, ...]:
    return () if folder is None else (folder,)


def _run_until_interrupted(command: list[str]) -> NoReturn:
    """The child prints the greeting line, and ends when its standard input is closed, at our end at the latest.

    An interrupt ends it also where a shell has started it in the background, which has Python ignore interrupts. It
    raises nothing: an exception amid `poll` would leave its lock taken, and the last wait would have no end.
    """
    is_interrupted = False

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        nonlocal is_interrupted
        is_interrupted = True

    with (
        handled({signal.SIGINT: interrupt}),
        subprocess.Popen([*command, "--end-with-stdin"], stdin=subprocess.PIPE) as process,
    ):
        while not is_interrupted and process.poll() is None:
            time.sleep(LOOK_AGAIN)  # a signal just before a wait without end would be seen at its end
    sys.exit(FAILED if process.returncode else 0)


@app.command()
def cycles(folder: FolderOption = None, as_json: JsonOption = False) -> None:
    """Put the heaviest load on the emulated board and count the cycles of its 1 kHz interrupt."""
    from control.simulation.emulated import prepare
    from control.simulation.worst_case import measure

    try:
        with console.status("driving the emulated board"):
            found = measure(prepare(*_given(folder)))
    except OSError as error:
        raise fail(str(error), FAILED) from error
    loads = {"busy": found.busy, "flooded": found.flooded}
    if as_json:
        print(json.dumps({name: _cycles_json(load) for name, load in loads.items()}))
    else:
        _print_cycles(loads)
    if found.state != "driving":
        raise fail(f"the board did not keep driving under the load: it is {found.state}", FAILED)
    if max(load.interrupt.worst_share for load in loads.values()) > MOST_SHARE:
        raise fail(f"the interrupt takes more than {MOST_SHARE:.0%} of its millisecond", FAILED)


_LOADS = {"busy": "100 commands/s", "flooded": "line full of commands"}
_STRETCHES = {"tick": "the tick", "interrupt": "the whole interrupt"}


def _print_cycles(loads: dict[str, Cycles]) -> None:
    print(f"{'load':<24}{'of':<22}{'worst':>8}{'mean':>8}{'of 1 ms':>10}")
    for name, load in loads.items():
        for stretch, found in _stretches(load):
            row = f"{_LOADS[name]:<24}{_STRETCHES[stretch]:<22}{found.worst:>8}{found.mean:>8.0f}"
            print(f"{row}{found.worst_share:>10.1%}")
        if load.overruns:
            print(f"{_LOADS[name]:<24}{load.overruns} received bytes were lost")


def _stretches(load: Cycles) -> tuple[tuple[str, Stretch], ...]:
    return ("tick", load.tick), ("interrupt", load.interrupt)


def _cycles_json(load: Cycles) -> dict[str, object]:
    figures = {
        f"{name}_{figure}": value
        for name, found in _stretches(load)
        for figure, value in (
            ("worst_cycles", found.worst),
            ("mean_cycles", found.mean),
            ("worst_share", found.worst_share),
        )
    }
    return {**figures, "ticks": load.tick.count, "period_cycles": load.period, "lost_bytes": load.overruns}
