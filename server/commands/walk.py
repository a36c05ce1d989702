"""`pivotrig run`: one walk without a browser, recorded like every other."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from pydantic import ValidationError
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from control.simulation.plants import MissingExtra
from server.commands.consent import YesOption, ask_for_consent
from server.commands.outcome import (
    FAILED,
    REFUSED,
    USAGE,
    DataOption,
    RigOption,
    console,
    fail,
    open_rig_store,
    with_simulation,
)
from server.commands.plugin_option import PluginOption, load_plugins
from server.commands.run_choice import tell_of_loss
from server.data_folder import data_folder
from server.environment import check_environment
from server.section import in_words
from server.settings import RigFile
from server.signals import coils_stop_first

if TYPE_CHECKING:
    from control.runs import Choice, RunRequest
    from control.snapshot import Snapshot
    from server.archive import Archive
    from server.assembly import Machine
    from server.headless import HeadlessRun


def run(
    controller: Annotated[str, typer.Option(help="Name of the controller.")] = "geometric",
    trajectory: Annotated[str, typer.Option(help="Name of the trajectory.")] = "eight",
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", help="A parameter, such as controller.gain=2.5; may be given again."),
    ] = None,
    plant: Annotated[str | None, typer.Option(help="Simulated robot: slip, noslip or rigid.")] = None,
    sweep: Annotated[float, typer.Option(help="Sweep angle, degrees.")] = 30.0,
    tilt: Annotated[float, typer.Option(help="Tilt of the field, degrees.")] = 25.0,
    path_step: Annotated[float, typer.Option("--path-step", help="Path time per 0.1 s, s.")] = 0.1,
    passes: Annotated[float, typer.Option(help="How often to walk the path.")] = 1.0,
    duration: Annotated[float | None, typer.Option(help="End after this time, s.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the simulation.")] = None,
    rig: RigOption = None,
    data: DataOption = None,
    no_record: Annotated[bool, typer.Option("--no-record", help="Keep nothing of the run.")] = False,
    plugin: PluginOption = None,
    yes: YesOption = False,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Walk one path and print how well that went."""
    check_environment()
    load_plugins(plugin)
    rig_file = with_simulation(open_rig_store(rig, data).settings, {"plant": plant, "seed": seed})
    from control.runs import Choice

    choices = _parameters(settings or [])
    gait = {"sweep_deg": sweep, "tilt_deg": tilt, "path_step_s": path_step, **choices["gait"]}
    request = _request(
        Choice(controller, choices["controller"]),
        Choice(trajectory, _points_read(trajectory, choices["trajectory"])),
        gait,
        passes,
        duration,
    )
    walk = HeadlessWalk(rig_file, request, None if no_record else data_folder(data))
    print_result(walked(walk, consent=ask_for_consent(rig_file, yes=yes)), as_json=as_json)


@dataclass(frozen=True, slots=True)
class HeadlessWalk:
    """What `pivotrig run` and `pivotrig runs again` carry out. data: where it is recorded; None: nowhere."""

    rig_file: RigFile
    request: RunRequest
    data: Path | None


def walked(walk: HeadlessWalk, *, consent: bool) -> dict[str, Any]:
    """Walk; the result as it is printed. Ends the command when the rig refuses."""
    from control.link.conversion import LinkError
    from control.safety import Refused
    from control.trajectories import OutsideWorkspace
    from server.run_list import new_id
    from vision.sources.opening import CameraError

    id = new_id()
    built: list[Machine] = []
    try:
        with coils_stop_first(lambda: _stop_coils(built)), _archive(walk) as archive:
            done = _carried_out(walk, id, built, archive, consent=consent)
    except (Refused, LinkError, CameraError) as error:
        raise fail(str(error), REFUSED) from error
    except MissingExtra as error:
        raise fail(str(error), USAGE) from error
    except OSError as error:
        raise fail(f"the rig cannot be opened: {error}", REFUSED) from error
    except (OutsideWorkspace, ValueError) as error:
        raise fail(str(error), USAGE) from error
    return _result(id, done, is_simulated=walk.rig_file.is_simulated)


def _stop_coils(machines: list[Machine]) -> None:
    for machine in machines:
        machine.stop_coils()


def _carried_out(
    walk: HeadlessWalk, id: str, built: list[Machine], archive: Archive | None, *, consent: bool
) -> HeadlessRun:
    """built: where the machine goes, for the signals that stop it."""
    from server.assembly import build_machine
    from server.headless import Headless

    machine = build_machine(walk.rig_file, realtime=not walk.rig_file.is_simulated)
    built.append(machine)
    with _Progress() as (progress, task):
        show = lambda snapshot: _show(progress, task, snapshot)  # noqa: E731
        recorder = None if archive is None else archive.recorder
        return Headless(machine, show, recorder).run(id, walk.request, consent=consent)


@contextmanager
def _archive(walk: HeadlessWalk) -> Iterator[Archive | None]:
    """A simulated run, which goes as fast as it can, waits for its recorder; a real one waits for no disk."""
    if walk.data is None:
        yield None
        return
    from server.archive import Archive
    from server.catalogue.errors import CatalogueError

    try:
        archive = Archive.open(walk.data, patient=walk.rig_file.is_simulated)
        tell_of_loss(archive)
    except (CatalogueError, OSError) as error:
        raise fail(f"{error}; choose another folder with --data, or walk with --no-record", FAILED) from error
    try:
        yield archive
    finally:
        archive.close()


def _result(id: str, done: HeadlessRun, *, is_simulated: bool) -> dict[str, Any]:
    from server.api.runs import metrics_json

    return {
        "run_id": id,
        "state": done.ended.state.value,
        **metrics_json(done.ended.metrics),
        "wall_s": round(done.wall, 3),
        "simulated_s": round(done.simulated, 3) if is_simulated else None,
    }


def print_result(result: Mapping[str, Any], *, as_json: bool) -> None:
    if as_json:
        print(json.dumps(result, allow_nan=False))
        return
    width = max(len(name) for name in result)
    for name, value in result.items():
        print(f"{name:<{width}}  {value}")
    sys.stdout.flush()


def _parameters(settings: list[str]) -> dict[str, dict[str, Any]]:
    """`controller.gain=2.5` and its kin, sorted by what they belong to."""
    sorted_: dict[str, dict[str, Any]] = {"controller": {}, "trajectory": {}, "gait": {}}
    for setting in settings:
        name, equals, value = setting.partition("=")
        owner, dot, field = name.strip().partition(".")
        if not (equals and dot and field and owner in sorted_):
            owners = ", ".join(f"{owner}.NAME=VALUE" for owner in sorted_)
            raise fail(f"--set {setting!r} is not understood; allowed: {owners}", USAGE)
        sorted_[owner][field.strip()] = _value(value.strip())
    return sorted_


def _points_read(trajectory: str, parameters: dict[str, Any]) -> dict[str, Any]:
    from control.trajectories.waypoint_file import WaypointFileError
    from server.waypoint_import import with_points

    try:
        return with_points(trajectory, parameters)
    except WaypointFileError as error:
        raise fail(str(error), USAGE) from error


def _value(text: str) -> Any:
    """JSON where it is JSON, else the text itself."""
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


def _request(
    controller: Choice, trajectory: Choice, gait: dict[str, Any], passes: float, duration: float | None
) -> RunRequest:
    from control.gait_settings import GaitSettings
    from control.registry import UnknownName
    from control.runs import RunRequest, Selection
    from server.api.schemas import RunBody

    try:
        body = RunBody(passes=passes, duration_s=duration)
        selection = Selection(controller, trajectory, GaitSettings(**gait).to_si())
        selection.build_controller()
        selection.build_trajectory()
    except UnknownName as error:
        raise fail(str(error), USAGE) from error
    except ValidationError as error:
        raise fail(f"this run cannot be started:\n{in_words(error)}", USAGE) from error
    return replace(RunRequest(selection), passes=body.passes, duration=body.duration_s)


class _Progress:
    """A progress bar on stderr that stays away when nobody looks at a terminal."""

    def __init__(self) -> None:
        self._bar = Progress(
            TextColumn("walking"),
            BarColumn(),
            TextColumn("{task.completed:.0f}/{task.total:.0f} s, mean error {task.fields[error]:.2f} mm"),
            TimeRemainingColumn(),
            console=console,
            disable=not console.is_terminal,
        )

    def __enter__(self) -> tuple[Progress, Any]:
        self._bar.start()
        return self._bar, self._bar.add_task("run", total=math.inf, error=0.0)

    def __exit__(self, *_: object) -> None:
        self._bar.stop()


def _show(progress: Progress, task: Any, snapshot: Snapshot) -> None:
    if snapshot.run is not None and not progress.disable and snapshot.tick % 30 == 0:
        done, whole = snapshot.run.elapsed, snapshot.run.duration
        progress.update(task, completed=done, total=whole, error=snapshot.run.mean_error * 1e3)
