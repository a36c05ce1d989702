"""`pivotrig calibrate latency`: how late the camera's pictures are."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from control.gait import Gait
from server.commands.bench import JsonOption, SaveOption, explained
from server.commands.calibrate_registration import at_the_centre
from server.commands.calibration_result import saved_or_shown, show
from server.commands.consent import YesOption, ask_for_consent
from server.commands.outcome import RigOption, console, read_rig_file
from server.settings import RigFile
from server.signals import coils_stop_first


def latency(
    turns: Annotated[int, typer.Option(min=4, max=200, help="Turns; to and fro are two.")] = 24,
    save: SaveOption = False,
    yes: YesOption = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """How late the camera is: the robot turns to and fro on one end, and is seen to answer.

    Put the robot in the middle, end A as `vision.heading_hint_deg` has it. Takes half a minute.
    """
    rig_file = at_the_centre(read_rig_file(rig))
    ask_for_consent(rig_file, yes=yes)
    result, changes = _measured(rig_file, turns)
    show(result, _words(result, rig_file), saved_or_shown(rig, changes, save), as_json)


def _measured(rig_file: RigFile, turns: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """The figures, and what of them the rig file has a place for."""
    from control.controllers.wiggle import WiggleParameters
    from server.assembly import build_machine
    from server.calibration.latency import calibrate_latency, changes, figures
    from server.run_list import new_id

    with explained():
        machine = build_machine(rig_file, realtime=not rig_file.is_simulated)
        with console.status("turning to and fro"), coils_stop_first(machine.stop_coils):
            found = calibrate_latency(machine, new_id(), Gait(), WiggleParameters(turns=turns), consent=True)
    return figures(found), changes(found)


def _words(result: dict[str, Any], rig_file: RigFile) -> list[str]:
    latency = result["latency_ms"]
    words = [
        f"the camera is {latency['value']:.1f} ± {latency['standard_error']:.1f} ms late "
        f"(the rig file had {rig_file.camera.latency_ms:g} ms)",
        f"play {result['play_deg']:.1f} degrees, residual {result['residual_deg']:.2f} degrees, "
        f"{result['sightings']} sightings",
    ]
    if rig_file.is_simulated and rig_file.simulation.stamps == "capture":
        words.append(
            'the simulated camera stamps its frames with their true capture time (simulation.stamps = "capture"), '
            "so there is nothing to subtract"
        )
    return words
