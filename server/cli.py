"""The command line: results to stdout, progress and errors to stderr.

Exit status: 0 done, 1 failed, 2 wrong usage, 3 the rig refused or faulted.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from pydantic import ValidationError
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from server.commands import firmware
from server.commands.consent import YesOption, ask_for_consent
from server.commands.doctor import doctor
from server.commands.outcome import (
    FAILED,
    REFUSED,
    USAGE,
    RigOption,
    console,
    fail,
    open_rig_store,
    read_rig_file,
    warn,
    with_simulation,
)
from server.commands.reproduce import reproduce
from server.data_folder import data_folder
from server.environment import check_environment
from server.section import in_words
from server.settings import RigFile
from server.signals import coils_stop_first

if TYPE_CHECKING:
    from control.runs import Choice, RunRequest
    from control.snapshot import Snapshot

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="See, control and record a magnetic pivot walker, on the rig or in simulation.",
)


app.add_typer(firmware.app, name="firmware")
app.command()(doctor)
app.command()(reproduce)


def main() -> None:
    """The console script."""
    try:
        app()
    except KeyboardInterrupt:
        console.print("pivotrig: interrupted", style="red")
        sys.exit(FAILED)


PluginOption = Annotated[
    list[Path] | None,
    typer.Option("--plugin", help="Python file with a controller or trajectory; may be given again."),
]


def load_plugins(files: list[Path] | None) -> None:
    """Installed plug-ins that are broken are left out with a word; a broken one that was asked for ends the command."""
    from control import plugins

    for problem in plugins.load_installed():
        warn(str(problem))
    for file in files or []:
        try:
            plugins.load_file(file)
        except plugins.PluginError as error:
            raise fail(str(error), USAGE) from error


@app.command(
    add_help_option=False, context_settings={"ignore_unknown_options": True, "allow_extra_args": True}
)
def calibrate(context: typer.Context) -> None:
    """Measure a rig."""
    from server.commands.calibrate import (
        app as calibrations,  # they need most of the program: only they load it
    )

    calibrations(context.args, prog_name=context.command_path)


@app.command()
def serve(
    sim: Annotated[
        bool, typer.Option("--sim", help="Simulate camera and board, whatever the rig file says.")
    ] = False,
    rig: RigOption = None,
    plugin: PluginOption = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; loopback only in this version.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 picks a free port.")] = 8000,
    data: Annotated[
        Path | None, typer.Option(help="Folder for data; default: your user data folder.")
    ] = None,
    open_browser: Annotated[bool, typer.Option("--open", help="Open the dashboard in the browser.")] = False,
) -> None:
    """Open the rig and serve its dashboard."""
    check_environment()
    load_plugins(plugin)
    store = open_rig_store(rig, data)
    from server.serving import Place, ServeError, serve_rig

    as_run = RigFile.as_simulated if sim else _as_it_is
    try:
        serve_rig(store, as_run, Place(host, port), data_folder(data), open_browser)
    except ServeError as error:
        raise fail(str(error), FAILED) from error


def _as_it_is(settings: RigFile) -> RigFile:
    return settings


@app.command()
def run(
    controller: Annotated[str, typer.Option(help="Name of the controller.")] = "geometric",
    trajectory: Annotated[str, typer.Option(help="Name of the trajectory.")] = "eight",
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", help="A parameter, such as controller.gain=2.5; may be given again."),
    ] = None,
    plant: Annotated[str | None, typer.Option(help="Simulated robot: slip or noslip.")] = None,
    sweep: Annotated[float, typer.Option(help="Sweep angle, degrees.")] = 30.0,
    tilt: Annotated[float, typer.Option(help="Tilt of the field, degrees.")] = 25.0,
    path_step: Annotated[float, typer.Option("--path-step", help="Path time per 0.1 s, s.")] = 0.1,
    passes: Annotated[float, typer.Option(help="How often to walk the path.")] = 1.0,
    duration: Annotated[float | None, typer.Option(help="End after this time, s.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the simulation.")] = None,
    rig: RigOption = None,
    plugin: PluginOption = None,
    yes: YesOption = False,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Walk one path and print how well that went."""
    check_environment()
    load_plugins(plugin)
    rig_file = with_simulation(read_rig_file(rig), {"plant": plant, "seed": seed})
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
    _run(rig_file, request, as_json, consent=ask_for_consent(rig_file, yes=yes))


def _run(rig_file: RigFile, request: RunRequest, as_json: bool, *, consent: bool) -> None:
    from control.link.conversion import LinkError
    from control.safety import Refused
    from control.trajectories import OutsideWorkspace
    from server.api.runs import metrics_json
    from server.assembly import build_machine
    from server.headless import run_headless
    from server.run_list import new_id
    from vision.sources.opening import CameraError

    try:
        machine = build_machine(rig_file, realtime=not rig_file.is_simulated)
        id = new_id()
        with _Progress() as (progress, task), coils_stop_first(machine.stop_coils):
            show = lambda snapshot: _show(progress, task, snapshot)  # noqa: E731
            done = run_headless(machine, id, request, show, consent=consent)
    except (Refused, LinkError, CameraError) as error:
        raise fail(str(error), REFUSED) from error
    except OSError as error:
        raise fail(f"the rig cannot be opened: {error}", REFUSED) from error
    except (OutsideWorkspace, ValueError) as error:
        raise fail(str(error), USAGE) from error
    result: dict[str, Any] = {
        "run_id": id,
        "state": done.ended.state.value,
        **metrics_json(done.ended.metrics),
        "wall_s": round(done.wall, 3),
        "simulated_s": round(done.simulated, 3) if rig_file.is_simulated else None,
    }
    if as_json:
        print(json.dumps(result, allow_nan=False))
    else:
        _table(result)


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
    from control.registry import UnknownName
    from control.runs import RunRequest, Selection
    from server.api.schemas import GaitSettings, RunBody

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


def _table(result: Mapping[str, Any]) -> None:
    width = max(len(name) for name in result)
    for name, value in result.items():
        print(f"{name:<{width}}  {value}")
    sys.stdout.flush()
