"""`pivotrig calibrate coils`: what a hand-held magnetometer says of the coils' field."""

from __future__ import annotations

import csv
import math
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import typer

from control.axes import Axis
from control.calibration.field_gain import BadReadings, FieldCalibration, Reading, fit_field
from control.simulation.magnetometer import Magnetometer
from control.snapshot import Vector
from server.assembly import Machine
from server.commands.answers import Answers
from server.commands.bench import (
    CoilOption,
    CurrentOption,
    JsonOption,
    SaveOption,
    SimulateOption,
    coils_asked_for,
    explained,
    opened,
    require_simulated,
    sense_gains,
)
from server.commands.calibration_result import saved_or_shown, show
from server.commands.consent import YesOption
from server.commands.held_coil import Held, HeldCoil, Instrument, held_each_way
from server.commands.outcome import USAGE, RigOption, fail, read_rig_file
from server.settings import MM, RigFile
from server.settings_in_si import coil_set

MT = 1e-3


def coils(
    measure: Annotated[
        bool, typer.Option("--measure", help="Drive one coil after the other and ask for readings.")
    ] = False,
    readings: Annotated[
        Path | None,
        typer.Option(help="CSV file: coil,current_A,x_mm,y_mm,z_mm,component,field_mT."),
    ] = None,
    coil: CoilOption = None,
    current: CurrentOption = 2.0,
    point: Annotated[
        tuple[float, float, float], typer.Option(help="The probe's place from the coils' centre, mm.")
    ] = (0.0, 0.0, 0.0),
    simulate_readings: SimulateOption = False,
    save: SaveOption = False,
    yes: YesOption = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Field per ampere, measured with a hand-held magnetometer; without it the geometry is trusted.

    Hold the probe along the axis of the coil that is named, at the same place for all its readings. A coil carries
    its current until you have typed what you read, for five minutes at most.
    """
    rig_file = read_rig_file(rig)
    if (readings is None) == (not (measure or simulate_readings)):
        raise fail("choose one: --measure, --simulate-readings, or --readings FILE", USAGE)
    if not all(map(math.isfinite, point)):
        raise fail(f"--point takes three lengths in mm, got {point}", USAGE)
    place = point[0] * MM, point[1] * MM, point[2] * MM
    with explained():
        if readings is not None:
            taken = read_readings(readings)
        else:
            taken = _measured(rig_file, coils_asked_for(coil), current, place, simulate_readings, yes)
        found = fit_field(coil_set(rig_file).pairs, taken)
    changes = _field_changes(found)
    result = {"pairs": _pairs_json(found), "ambient_mT": [round(each / MT, 4) for each in found.ambient]}
    show(result, _field_words(found), saved_or_shown(rig, changes, save), as_json)


def read_readings(path: Path) -> list[Reading]:
    """Readings from a CSV file with the columns of the help text; raises `BadReadings`."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            return [_reading(row) for row in csv.DictReader(file)]
    except OSError as error:
        raise BadReadings(f"cannot read {path}: {error.strerror or error}") from error
    except (KeyError, TypeError, ValueError) as error:
        due = "coil,current_A,x_mm,y_mm,z_mm,component,field_mT"
        raise BadReadings(f"{path} is no file of readings with the columns {due}: {error}") from error


def _reading(row: dict[str, str]) -> Reading:
    return Reading(
        coil=row["coil"].strip(),  # type: ignore[arg-type]  # checked by the reading itself
        current=float(row["current_A"]),
        point=(float(row["x_mm"]) * MM, float(row["y_mm"]) * MM, float(row["z_mm"]) * MM),
        component=row["component"].strip(),  # type: ignore[arg-type]
        field=float(row["field_mT"]) * MT,
    )


def _measured(
    rig_file: RigFile, axes: list[Axis], current: float, point: Vector, simulate: bool, yes: bool
) -> list[Reading]:
    if simulate:
        require_simulated(rig_file, "--simulate-readings")
    gains = sense_gains(rig_file)
    with opened(rig_file, realtime=not simulate, yes=yes) as (machine, bench):
        instrument = _simulated_magnetometer(machine, point) if simulate else _magnetometer_by_asking()
        return [
            Reading(axis, sensed, point, axis, field)
            for axis in axes
            for sensed, field in held_each_way(bench, Held(axis, current), instrument, gains[axis])
        ]


def _magnetometer_by_asking() -> Instrument:
    answers = Answers()

    def ask(held: Held, coil: HeldCoil) -> float:
        question = f"{held.coil} coils at {coil.sensed:+.2f} A: field along {held.coil}, mT"
        return MT * answers.number(question, lambda: coil.is_held)

    return ask


def _simulated_magnetometer(machine: Machine, point: Vector) -> Instrument:
    if machine.world is None:
        raise fail("a simulated magnetometer needs the simulated rig", USAGE)
    magnetometer = Magnetometer(machine.world, machine.settings.simulation.seed)
    return lambda held, _: magnetometer.read(point, held.coil)


def _field_changes(found: FieldCalibration) -> dict[str, Any]:
    today = datetime.now(UTC).date().isoformat()
    changes: dict[str, Any] = {
        axis: {"field_gain": round(pair.gain, 4)} for axis, pair in found.pairs.items()
    }
    names = "".join(found.pairs)
    changes["field_source"] = f"measured {today} ({names}), residual {100 * found.worst_residual:.1f} %"
    return {"coils": changes}


def _pairs_json(found: FieldCalibration) -> dict[str, Any]:
    return {
        axis: {
            "field_gain": round(pair.gain, 5),
            "standard_error": round(pair.standard_error, 5),
            "residual_percent": round(100 * pair.residual, 3),
            "readings": pair.readings,
        }
        for axis, pair in found.pairs.items()
    }


def _field_words(found: FieldCalibration) -> list[str]:
    lines = [
        f"{axis} coils: {pair.gain:.4f} ± {pair.standard_error:.4f} times the geometry's field, "
        f"residual {100 * pair.residual:.1f} %"
        for axis, pair in found.pairs.items()
    ]
    room = ", ".join(f"{each / MT:+.3f}" for each in found.ambient)
    return [*lines, f"the room's own field: {room} mT"]
