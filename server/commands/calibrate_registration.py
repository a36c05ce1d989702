"""`pivotrig calibrate polarity | registration`: what the robot's turning says of wiring, magnet and camera."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any

import typer
from pydantic import ValidationError

from control.calibration.heading_offset import HeadingOffset, corrected, heading_offset, with_names_as
from control.calibration.robot_turn import RobotTurn
from control.calibration.turning import Evidence, gather
from control.calibration.verdict import Cause, Verdict, diagnose
from control.model import Pose
from control.registration import Registration
from server.assembly import Machine
from server.coil_sections import RegistrationSection
from server.commands.bench import JsonOption, SaveOption, explained, opened
from server.commands.calibration_result import saved_or_shown
from server.commands.consent import YesOption
from server.commands.outcome import FAILED, USAGE, RigOption, fail, read_rig_file
from server.section import in_words
from server.settings import MM, RigFile
from server.settings_in_si import registration_of


class Picture(StrEnum):
    """What a text under the camera looks like."""

    RIGHT = "right"
    MIRRORED = "mirrored"


PictureOption = Annotated[
    Picture | None,
    typer.Option(help="How a text under the camera looks: to the robot a mirror and swapped leads are one."),
]


@dataclass(frozen=True, slots=True)
class Turned:
    """before: the robot as it was put down.  fine: of the full circle, None when it made no sense to turn it."""

    before: Pose
    evidence: Evidence
    verdict: Verdict
    fine: HeadingOffset | None


def polarity(
    picture: PictureOption = None,
    yes: YesOption = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Whether the robot turns with the field: finds swapped and exchanged coils, a turned magnet, a mirror.

    Put the robot in the middle, end A as `vision.heading_hint_deg` has it. Takes ten seconds.
    """
    rig_file = at_the_centre(read_rig_file(rig))
    with opened(rig_file, realtime=not rig_file.is_simulated, yes=yes) as (machine, bench):
        turned = turn(machine, RobotTurn(bench, machine.tracker), picture, whole_circle=False)
    _show(_verdict_json(turned), [turned.verdict.message], as_json)
    if not turned.verdict.is_usable:
        raise typer.Exit(FAILED)


def registration(
    at_centre_mark: Annotated[
        bool, typer.Option("--at-centre-mark", help="The robot stands on the mark of the coils' centre.")
    ] = False,
    x_mm: Annotated[float | None, typer.Option("--x-mm", help="The coils' centre in the picture.")] = None,
    y_mm: Annotated[float | None, typer.Option("--y-mm", help="The coils' centre in the picture.")] = None,
    picture: PictureOption = None,
    save: SaveOption = False,
    yes: YesOption = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Where the coils stand in the camera's workspace, and which way round the robot's magnet lies.

    The robot turns once round to the left and back. Takes half a minute.
    """
    given = read_rig_file(rig)
    if at_centre_mark and (x_mm, y_mm) != (None, None):
        raise fail("choose one: --at-centre-mark, or --x-mm and --y-mm", USAGE)
    old = registration_of(given.coils.registration)
    entered = registration_of(_entered(given.coils.registration, x_mm, y_mm))
    rig_file = at_the_centre(given)
    with opened(rig_file, realtime=not rig_file.is_simulated, yes=yes) as (machine, bench):
        turned = turn(machine, RobotTurn(bench, machine.tracker), picture, whole_circle=True)
    if turned.fine is None:
        raise fail(turned.verdict.message, FAILED)
    marked = turned.before.x, turned.before.y
    new = registered(old, turned, marked if at_centre_mark else (entered.x, entered.y))
    changes = {"coils": {"registration": _section(new)}}
    words = [
        turned.verdict.message,
        f"rotation {math.degrees(new.rotation):+.2f} ± {math.degrees(turned.fine.standard_error):.2f} degrees, "
        f"residual {math.degrees(turned.fine.residual):.2f}, play {math.degrees(turned.fine.play):.1f}",
        f"centre ({new.x / MM:.2f}, {new.y / MM:.2f}) mm, magnet {'reversed' if new.magnet_reversed else 'as named'}",
    ]
    result = {**_verdict_json(turned), "registration": _section(new), **_fine_json(turned.fine)}
    _show(result, [*words, "", saved_or_shown(rig, changes, save)], as_json)


def turn(machine: Machine, robot: RobotTurn, picture: Picture | None, *, whole_circle: bool) -> Turned:
    """The check by a short turn and, where nothing stands against it, the full circle."""
    with explained():
        before = robot.put_down()
        evidence = gather(before, robot.probe(), machine.loop.parts.length)
        verdict = diagnose(evidence, None if picture is None else picture is Picture.MIRRORED)
        if not (whole_circle and verdict.is_usable):
            return Turned(before, evidence, verdict, None)
        robot.put_down()
        return Turned(before, evidence, verdict, heading_offset(robot.circle()))


def registered(old: Registration, turned: Turned, origin: tuple[float, float]) -> Registration:
    """The registration that the turn calls for; origin: of the coils in the workspace, m."""
    if turned.fine is None:
        return old
    offset = with_names_as(turned.fine.offset, turned.evidence.offset)
    found = corrected(old, offset, turned.verdict.causes == (Cause.MAGNET_REVERSED,))
    return Registration(origin[0], origin[1], found.rotation, found.magnet_reversed)


def at_the_centre(rig_file: RigFile) -> RigFile:
    """A simulated robot is put on the mark of the coils' true centre, as a person would put a real one."""
    if not rig_file.is_simulated:
        return rig_file
    true = rig_file.simulation.registration or rig_file.coils.registration
    return rig_file.with_simulation(start_x_mm=true.x_mm, start_y_mm=true.y_mm)


def _entered(old: RegistrationSection, x_mm: float | None, y_mm: float | None) -> RegistrationSection:
    """`old` with the centre that was given; ends the command when the coils cannot stand there."""
    centre = {"x_mm": x_mm, "y_mm": y_mm}
    given = {name: value for name, value in centre.items() if value is not None}
    try:
        return RegistrationSection.model_validate({**old.model_dump(), **given})
    except ValidationError as error:
        raise fail(f"the coils' centre cannot be there:\n{in_words(error)}", USAGE) from error


def _section(registration: Registration) -> dict[str, Any]:
    return {
        "x_mm": round(registration.x / MM, 3),
        "y_mm": round(registration.y / MM, 3),
        "rotation_deg": round(math.degrees(registration.rotation), 3),
        "magnet_reversed": registration.magnet_reversed,
    }


def _verdict_json(turned: Turned) -> dict[str, Any]:
    return {
        "causes": [cause.value for cause in turned.verdict.causes],
        "message": turned.verdict.message,
        "offset_deg": round(math.degrees(turned.evidence.offset), 2),
    }


def _fine_json(fine: HeadingOffset) -> dict[str, Any]:
    return {
        "standard_error_deg": round(math.degrees(fine.standard_error), 4),
        "residual_deg": round(math.degrees(fine.residual), 4),
        "play_deg": round(math.degrees(fine.play), 3),
    }


def _show(result: dict[str, Any], words: list[str], as_json: bool) -> None:
    if as_json:
        print(json.dumps(result, allow_nan=False))
    else:
        print("\n".join(words))
