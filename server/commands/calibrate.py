"""`pivotrig calibrate …`: what a rig has to be measured for."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any

import typer
from pydantic import ValidationError

from control.gait import Gait
from control.gait_model import GaitModel
from server.commands.bench import explained
from server.commands.calibrate_coils import coils
from server.commands.calibrate_registration import polarity, registration
from server.commands.calibrate_windings import sense, windings
from server.commands.consent import YesOption, ask_for_consent
from server.commands.outcome import (
    USAGE,
    RigOption,
    console,
    fail,
    read_rig_file,
    with_simulation,
)
from server.settings import MM, MS, GaitSection, RigFile, in_words
from server.signals import coils_stop_first

if TYPE_CHECKING:
    from server.gait_calibration import Star

app = typer.Typer(no_args_is_help=True, help="Measure a rig.")

FIGURES: dict[str, tuple[str, float]] = {
    "length": ("length_mm", MM),
    "backlash": ("backlash_deg", math.radians(1.0)),
    "heading_offset": ("heading_offset_deg", math.radians(1.0)),
    "out": ("out_mm", MM),
    "forward_base": ("forward_base_mm", MM),
    "forward_per_sweep": ("forward_per_sweep_mm_rad", MM),
    "lag": ("lag_ms", MS),
}
"""Fields of `GaitModel`, their names outside, and the unit in SI."""


@app.callback()
def calibrate() -> None:
    """Measure a rig."""


app.command()(coils)
app.command()(windings)
app.command()(sense)
app.command()(polarity)
app.command()(registration)


@app.command()
def gait(
    sweep: Annotated[
        float, typer.Option(help="Sweep angle, degrees; every other leg takes two thirds.")
    ] = 30.0,
    tilt: Annotated[float, typer.Option(help="Tilt of the field, degrees.")] = 25.0,
    legs: Annotated[int, typer.Option(min=2, max=36, help="Legs, each walked out and back.")] = 5,
    leg: Annotated[float, typer.Option("--leg", min=5.0, max=50.0, help="Length of a leg, mm.")] = 20.0,
    rate: Annotated[float, typer.Option(min=5.0, max=359.0, help="Swing rate, degrees per second.")] = 100.0,
    plant: Annotated[str | None, typer.Option(help="Simulated robot: slip or noslip.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the simulation.")] = None,
    rig: RigOption = None,
    yes: YesOption = False,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Walk a star and report pivot length, play, heading offset, and what each pivot switch does.

    A simulated robot starts at the centre; put a real one there. Takes about a minute of rig time.
    """
    rig_file = with_simulation(read_rig_file(rig), {"plant": plant, "seed": seed})
    if rig_file.is_simulated:
        rig_file = with_simulation(rig_file, {"start_x_mm": 0.0, "start_y_mm": 0.0})
    from server.gait_calibration import Star

    choice = _gait(sweep, tilt), Star(legs, leg * MM, math.radians(rate))
    result = _calibrate(rig_file, *choice, consent=ask_for_consent(rig_file, yes=yes))
    print(json.dumps(result, allow_nan=False) if as_json else _in_words(result))


def _gait(sweep: float, tilt: float) -> Gait:
    from server.api.schemas import GaitSettings

    try:
        return GaitSettings(sweep_deg=sweep, tilt_deg=tilt, max_rate_deg_s=359.0).to_si()
    except ValidationError as error:
        raise fail(f"the star cannot be walked:\n{in_words(error)}", USAGE) from error


def _calibrate(rig_file: RigFile, gait: Gait, star: Star, *, consent: bool) -> dict[str, Any]:
    from server.assembly import build_machine
    from server.gait_calibration import calibrate_gait
    from server.run_list import new_id

    with explained():
        machine = build_machine(rig_file, realtime=not rig_file.is_simulated)
        with console.status("walking the star"), coils_stop_first(machine.stop_coils):
            done = calibrate_gait(machine, new_id(), gait, star, consent=consent)
    counts = done.run.ended.metrics
    return {
        "sweep_deg": round(math.degrees(gait.sweep), 6),
        "tilt_deg": round(math.degrees(gait.tilt), 6),
        "figures": figures_json(done.model),
        "sightings": done.sightings,
        "sweeps": counts.sweeps,
        "steps": counts.steps,
        "wall_s": round(done.run.wall, 3),
    }


def figures_json(model: GaitModel) -> dict[str, dict[str, float]]:
    """Each figure with its standard error, in the lab's units."""
    values = asdict(model)
    errors = values["uncertainty"]
    return {
        name: {"value": round(values[field] / unit, 5), "standard_error": round(errors[field] / unit, 5)}
        for field, (name, unit) in FIGURES.items()
    }


_MEANING = {
    "length_mm": "distance between the pivots",
    "backlash_deg": "play between the field's heading and the body's",
    "heading_offset_deg": "field's heading beyond the seen one, in the middle of the play",
    "out_mm": "per switch: the new pivot lands this far out, along the body",
    "forward_base_mm": "per switch: the new pivot lands this far ahead,",
    "forward_per_sweep_mm_rad": "    and this much further per radian of the sweep",
    "lag_ms": "the body comes this much later than the rig file says (actuation delay)",
}


def _in_words(result: dict[str, Any]) -> str:
    lines = [
        f"sweep {result['sweep_deg']:g}°, tilt {result['tilt_deg']:g}°, {result['steps']} pivot switches"
    ]
    for name, figure in result["figures"].items():
        value = f"{figure['value']:.3f} ± {figure['standard_error']:.3f}"
        lines.append(f"{name:<25} {value:>17}   {_MEANING[name]}")
    return "\n".join([*lines, "", "for the rig file:", *_rig_file_lines(result["figures"])])


def _rig_file_lines(figures: dict[str, dict[str, float]]) -> list[str]:
    """What of the figures the rig file has a place for, as TOML."""
    value = {name: round(figure["value"], 3) for name, figure in figures.items()}
    return [
        "[robot]",
        f"length_mm = {value['length_mm']}",
        "[estimator]",
        f"backlash_deg = {max(0.0, value['backlash_deg'])}",
        "[gait]",
        *(f"{name} = {value[name]}" for name in GaitSection.model_fields),
    ]
