"""What the calibrations of the coils share: their options, and the rig opened as a bench, with consent."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

import typer

from control.axes import AXES, Axis
from control.calibration.bench import Bench, BenchSettings
from control.calibration.field_gain import BadReadings
from control.calibration.turning import Unclear
from control.calibration.windings import BadAmmeter, SenseGains
from control.identification import TooLittle
from control.link.conversion import LinkError
from control.safety import Refused
from server.assembly import Machine
from server.commands.consent import ask_for_consent
from server.commands.outcome import FAILED, REFUSED, USAGE, console, fail
from server.settings import MS, RigFile
from server.settings_in_si import FULL_FIELD
from server.signals import coils_stop_first

SaveOption = Annotated[
    bool, typer.Option("--save", help="Write the result into the rig file; the one before is kept beside it.")
]
SimulateOption = Annotated[
    bool, typer.Option("--simulate-readings", help="Let a simulated instrument read the simulated rig.")
]
CoilOption = Annotated[
    list[str] | None, typer.Option("--coil", help="x, y or z; may be given again. Default: all.")
]
CurrentOption = Annotated[
    float, typer.Option(min=0.5, max=12.0, help="Largest current, A; half of it is used as well.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")]


@contextmanager
def explained() -> Iterator[None]:
    """What can go wrong on a bench ends the command with its reason."""
    from vision.sources.opening import CameraError

    try:
        yield
    except (Refused, LinkError, CameraError) as error:
        raise fail(str(error), REFUSED) from error
    except OSError as error:
        raise fail(f"the rig cannot be opened: {error}", REFUSED) from error
    except (BadReadings, BadAmmeter, Unclear, TooLittle) as error:
        raise fail(str(error), FAILED) from error
    except ValueError as error:
        raise fail(str(error), USAGE) from error


@contextmanager
def opened(rig_file: RigFile, *, realtime: bool, yes: bool) -> Iterator[tuple[Machine, Bench]]:
    """The rig with its board greeted and its coils at zero, as they are again at the end, whatever happens."""
    from server.assembly import build_machine

    ask_for_consent(rig_file, yes=yes)
    with explained():
        machine = build_machine(rig_file, realtime=realtime)
        try:
            machine.open()
            settings = BenchSettings(
                time_to_live=rig_file.link.time_to_live_ms * MS,
                field_slew=FULL_FIELD / (rig_file.link.field_ramp_ms * MS),
                max_field=rig_file.limits.field_mT * 1e-3,
            )
            with (
                coils_stop_first(machine.stop_coils),
                Bench(machine.camera, machine.loop.parts, settings) as bench,
            ):
                bench.wait_until_ready()
                # Said before any current flows also because the first line loads what takes a busy computer long.
                console.print("the board is ready, the coils are at zero")
                yield machine, bench
        finally:
            machine.close()


def coils_asked_for(names: list[str] | None) -> list[Axis]:
    """The coils named on the command line, all of them without a name."""
    found: list[Axis] = [axis for axis in AXES if not names or axis in names]
    unknown = [name for name in names or [] if name not in AXES]
    if unknown:
        raise fail(f"there are no coils {', '.join(unknown)}; choose x, y or z", USAGE)
    return found


def require_simulated(rig_file: RigFile, option: str) -> None:
    if not rig_file.is_simulated:
        raise fail(f"{option} belongs to the simulated rig, but this rig file has a real camera", USAGE)


def sense_gains(rig_file: RigFile) -> dict[Axis, SenseGains]:
    section = rig_file.coils
    pairs: dict[Axis, tuple[float, float]] = {
        "x": section.x.sense_mA_per_count,
        "y": section.y.sense_mA_per_count,
        "z": section.z.sense_mA_per_count,
    }
    return {axis: (positive * 1e-3, negative * 1e-3) for axis, (positive, negative) in pairs.items()}
