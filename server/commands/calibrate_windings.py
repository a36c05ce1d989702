"""`pivotrig calibrate windings | sense`: what the board's own figures, and an ammeter, say of the coils."""

from __future__ import annotations

import math
from statistics import mean
from typing import Annotated

import typer

from control.calibration.bench import Bench
from control.calibration.windings import (
    LEAST_AMMETER,
    AmmeterReading,
    SteadyCoil,
    WindingCheck,
    calibrate_sense,
    check_windings,
    without_cut_off,
)
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
from server.commands.held_coil import Held, HeldCoil, Instrument, each_way, held_each_way
from server.commands.outcome import FAILED, USAGE, RigOption, fail, read_rig_file
from server.settings import RigFile
from server.settings_in_si import coil_set

AmmeterCurrent = Annotated[
    float,
    typer.Option(min=2.4 * LEAST_AMMETER, max=12.0, help="Largest current, A; half of it is used as well."),
]
"""Its half, less a count or two of the sense, is worth comparing."""

LOOK = 0.2
"""The board's reports are averaged over this time, s."""


def windings(
    coil: CoilOption = None,
    current: CurrentOption = 2.0,
    save: SaveOption = False,
    yes: YesOption = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Resistance of each coil by the board's current sense, against the rig file."""
    rig_file = read_rig_file(rig)
    axes = coils_asked_for(coil)
    with opened(rig_file, realtime=not rig_file.is_simulated, yes=yes) as (_, bench):
        steady = [each for axis in axes for each in steady_coils(bench, Held(axis, current), rig_file)]
    checks = check_windings(coil_set(rig_file).pairs, steady)
    flowing = [check for check in checks if math.isfinite(check.resistance)]
    measured = {check.coil: {"resistance_ohm": round(check.resistance, 3)} for check in flowing}
    complaints = [check.complaint for check in checks if check.complaint]
    if complaints:
        raise fail("\n".join([*(_winding_words(check) for check in checks), *complaints]), FAILED)
    result = {"windings": measured}
    show(
        result,
        [_winding_words(check) for check in checks],
        saved_or_shown(rig, {"coils": measured}, save),
        as_json,
    )


def steady_coils(bench: Bench, most: Held, rig_file: RigFile) -> list[SteadyCoil]:
    """The coil at two currents each way; the rig file's supply counts where the board does not sense it."""
    gains, nominal_supply = sense_gains(rig_file)[most.coil], rig_file.coils.supply_V
    index, found = most.index, []
    for wanted in each_way(most.current):
        reports = bench.hold_coil(index, wanted, LOOK)
        sensed = mean(report.measured_currents[index] for report in reports)
        voltage = mean(report.duty[index] * (report.supply or nominal_supply) for report in reports)
        found.append(SteadyCoil(most.coil, wanted, without_cut_off(sensed, gains), voltage))
    return found


def _winding_words(check: WindingCheck) -> str:
    if math.isinf(check.resistance):
        return f"{check.coil} coils: no current"
    return f"{check.coil} coils: {check.resistance:.2f} ohm, {check.deviation:+.1%} of the rig file's {check.due:g}"


def sense(
    coil: CoilOption = None,
    current: AmmeterCurrent = 2.0,
    simulate_readings: SimulateOption = False,
    save: SaveOption = False,
    yes: YesOption = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Current sense of each coil and direction, against an ammeter in its lead.

    A coil carries its current until you have typed what you read, for five minutes at most.
    """
    rig_file = read_rig_file(rig)
    axes = coils_asked_for(coil)
    if simulate_readings:
        require_simulated(rig_file, "--simulate-readings")
    gains = sense_gains(rig_file)
    with opened(rig_file, realtime=not simulate_readings, yes=yes) as (machine, bench):
        instrument = _simulated_ammeter(machine) if simulate_readings else _ammeter_by_asking()
        readings = [
            AmmeterReading(axis, sensed, shown)
            for axis in axes
            for sensed, shown in held_each_way(bench, Held(axis, current), instrument, gains[axis])
        ]
    with explained():
        found = calibrate_sense(gains, readings)
    changes = {axis: {"sense_mA_per_count": [round(each * 1e3, 3) for each in found[axis]]} for axis in axes}
    words = [
        f"{axis} coils: {found[axis][0] * 1e3:.2f} and {found[axis][1] * 1e3:.2f} mA per count"
        for axis in axes
    ]
    show({"sense": changes}, words, saved_or_shown(rig, {"coils": changes}, save), as_json)


def _ammeter_by_asking() -> Instrument:
    answers = Answers()

    def ask(held: Held, coil: HeldCoil) -> float:
        question = f"{held.coil} coils at {coil.sensed:+.2f} A by the board: the ammeter shows, A"
        return answers.number(question, lambda: coil.is_held)

    return ask


def _simulated_ammeter(machine: Machine) -> Instrument:
    world = machine.world
    if world is None:
        raise fail("a simulated ammeter needs the simulated rig", USAGE)
    return lambda held, _: world.currents[held.index]
