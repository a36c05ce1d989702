"""`pivotrig calibrate …`: what a rig has to be measured for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer
from pydantic import ValidationError

from control.gait import Gait
from server.commands.bench import JsonOption, SaveOption, explained
from server.commands.calibrate_camera import board, lens
from server.commands.calibrate_coils import coils
from server.commands.calibrate_latency import latency
from server.commands.calibrate_plane import plane
from server.commands.calibrate_registration import polarity, registration
from server.commands.calibrate_windings import sense, windings
from server.commands.calibration_result import saved_or_shown, show
from server.commands.consent import YesOption, ask_for_consent
from server.commands.outcome import (
    USAGE,
    RigOption,
    console,
    fail,
    read_rig_file,
    with_simulation,
)
from server.section import in_words
from server.settings import MM, RigFile
from server.signals import coils_stop_first

if TYPE_CHECKING:
    from server.calibration.gait import Star

app = typer.Typer(
    add_completion=False, no_args_is_help=True, pretty_exceptions_enable=False, help="Measure a rig."
)

Found = tuple[dict[str, Any], dict[str, Any]]


@app.callback()
def calibrate() -> None:
    """Measure a rig."""


app.command()(board)
app.command()(lens)
app.command()(plane)
app.command()(coils)
app.command()(windings)
app.command()(sense)
app.command()(polarity)
app.command()(registration)
app.command()(latency)


@app.command()
def gait(
    sweep: Annotated[
        float, typer.Option(help="Sweep angle, degrees; every other leg takes two thirds.")
    ] = 30.0,
    tilt: Annotated[float, typer.Option(help="Tilt of the field, degrees.")] = 25.0,
    legs: Annotated[int, typer.Option(min=2, max=36, help="Legs, each walked out and back.")] = 5,
    leg: Annotated[float, typer.Option("--leg", min=5.0, max=50.0, help="Length of a leg, mm.")] = 20.0,
    rate: Annotated[float, typer.Option(min=5.0, max=359.0, help="Swing rate, degrees per second.")] = 100.0,
    plant: Annotated[str | None, typer.Option(help="Simulated robot: slip, noslip or rigid.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the simulation.")] = None,
    rig: RigOption = None,
    save: SaveOption = False,
    yes: YesOption = False,
    as_json: JsonOption = False,
) -> None:
    """Walk a star and report pivot length, play, heading offset, and what each pivot switch does.

    A simulated robot starts at the centre; put a real one there. Takes about a minute of rig time.
    """
    rig_file = with_simulation(read_rig_file(rig), {"plant": plant, "seed": seed})
    if rig_file.is_simulated:
        rig_file = with_simulation(rig_file, {"start_x_mm": 0.0, "start_y_mm": 0.0})
    from server.calibration.gait import Star

    choice = _gait(sweep, tilt), Star(legs, leg * MM, math.radians(rate))
    result, changes = _calibrate(rig_file, *choice, consent=ask_for_consent(rig_file, yes=yes))
    show(result, _in_words(result), saved_or_shown(rig, changes, save), as_json)


def _gait(sweep: float, tilt: float) -> Gait:
    from control.gait_settings import GaitSettings

    try:
        return GaitSettings(sweep_deg=sweep, tilt_deg=tilt, max_rate_deg_s=359.0).to_si()
    except ValidationError as error:
        raise fail(f"the star cannot be walked:\n{in_words(error)}", USAGE) from error


def _calibrate(rig_file: RigFile, gait: Gait, star: Star, *, consent: bool) -> Found:
    """The figures as they are told, and what of them the rig file has a place for."""
    from server.assembly import build_machine
    from server.calibration.gait import calibrate_gait, changes, figures_json
    from server.run_list import new_id

    with explained():
        machine = build_machine(rig_file, realtime=not rig_file.is_simulated)
        with console.status("walking the star"), coils_stop_first(machine.stop_coils):
            done = calibrate_gait(machine, new_id(), gait, star, consent=consent)
    counts = done.run.ended.metrics
    result = {
        "sweep_deg": round(math.degrees(gait.sweep), 6),
        "tilt_deg": round(math.degrees(gait.tilt), 6),
        "figures": figures_json(done.model),
        "sightings": done.sightings,
        "sweeps": counts.sweeps,
        "steps": counts.steps,
        "wall_s": round(done.run.wall, 3),
    }
    return result, changes(done.model, rig_file)


_MEANING = {
    "length_mm": "distance between the pivots",
    "backlash_deg": "play between the field's heading and the body's",
    "skew_deg": "heading of the pivots beyond that of the coloured body",
    "heading_offset_deg": "field's heading beyond the seen one, in the middle of the play",
    "out_mm": "per switch: the new pivot lands this far out, along the body",
    "forward_base_mm": "per switch: the new pivot lands this far ahead,",
    "forward_per_sweep_mm_rad": "    and this much further per radian of the sweep",
    "lag_ms": "the body comes this much later than the rig file says (actuation delay)",
}


def _in_words(result: dict[str, Any]) -> list[str]:
    lines = [
        f"sweep {result['sweep_deg']:g}°, tilt {result['tilt_deg']:g}°, {result['steps']} pivot switches"
    ]
    for name, figure in result["figures"].items():
        value = f"{figure['value']:.3f} ± {figure['standard_error']:.3f}"
        lines.append(f"{name:<25} {value:>17}   {_MEANING[name]}")
    return lines
