"""`pivotrig runs replay` and `again`: a recording in the dashboard, and the same run once more."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from server.commands.consent import YesOption, ask_for_consent
from server.commands.outcome import FAILED, DataOption, fail, open_rig_store
from server.commands.plugin_option import PluginOption, load_plugins
from server.commands.run_choice import RunArgument, recording_of, records_of
from server.commands.walk import HeadlessWalk, print_result, walked
from server.data_folder import data_folder
from server.environment import check_environment
from server.settings import RigFile

if TYPE_CHECKING:
    from control.runs import RunRequest
    from server.catalogue.records import RunRecord

MOST_AT_ONCE = 2
"""Runs beside each other."""
HOST = "127.0.0.1"


def replay(
    ids: Annotated[
        list[str],
        typer.Argument(
            metavar="ID [ID2]", help='A run, or two to compare; a beginning of its id, or "last".'
        ),
    ],
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 picks a free port.")] = 0,
    data: DataOption = None,
    open_browser: Annotated[
        bool, typer.Option("--open/--no-open", help="Open the dashboard in the browser.")
    ] = True,
) -> None:
    """Show a recorded run, or two beside each other, in the dashboard."""
    check_environment()
    if len(ids) > MOST_AT_ONCE:
        raise typer.BadParameter(f"{len(ids)} runs were given; one can be shown, or two beside each other")
    records = records_of(ids, data)
    for record in records:
        recording_of(record, data)
    from server.serving import Place, ServeError, serve_rig

    place = Place(HOST, port, "/#replay=" + ",".join(record.id for record in records))
    try:
        serve_rig(open_rig_store(None, data), RigFile.as_simulated, place, data_folder(data), open_browser)
    except ServeError as error:
        raise fail(str(error), FAILED) from error


def again(
    id: RunArgument,
    data: DataOption = None,
    no_record: Annotated[bool, typer.Option("--no-record", help="Keep nothing of the new run.")] = False,
    plugin: PluginOption = None,
    yes: YesOption = False,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Walk a recorded run once more, with the rig file and the seed that it had."""
    check_environment()
    load_plugins(plugin)
    [record] = records_of([id], data)
    rig_file, request = what_was_asked(record)
    walk = HeadlessWalk(rig_file, request, None if no_record else data_folder(data))
    print_result(walked(walk, consent=ask_for_consent(rig_file, yes=yes)), as_json=as_json)


def what_was_asked(record: RunRecord) -> tuple[RigFile, RunRequest]:
    """The rig and the run; ends the command where the recording does not tell them, or they are no longer possible."""
    from control.safety import Refused
    from server.api.problems import Rejected
    from server.custom_trajectories import CustomTrajectories
    from server.replay.again import request_again, restore_path
    from server.replay.then import rig_of

    rig_file = rig_of(record.settings)
    if rig_file is None:
        raise fail(f"the rig file of the run {record.id} is lost, or of another version of pivotrig", FAILED)
    try:
        restore_path(record.settings, CustomTrajectories())
        return rig_file, request_again(record)
    except (Refused, Rejected) as error:
        raise fail(str(error), FAILED) from error
