"""The command line: results to stdout, progress and errors to stderr.

Exit status: 0 done, 1 failed, 2 wrong usage, 3 the rig refused or faulted.
"""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from server.commands import firmware, token
from server.commands.doctor import doctor
from server.commands.outcome import (
    FAILED,
    DataOption,
    RigOption,
    console,
    fail,
    open_rig_store,
)
from server.commands.plugin_option import PluginOption, load_plugins
from server.commands.reproduce import reproduce
from server.commands.study import study
from server.commands.walk import run
from server.data_folder import data_folder
from server.environment import check_environment
from server.settings import RigFile


class LogFormat(StrEnum):
    TEXT = "text"
    JSON = "json"


class LogLevel(StrEnum):
    DEBUG = "debug"
    INFO = "info"
    WARNING = "warning"
    ERROR = "error"


app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="See, control and record a magnetic pivot walker, on the rig or in simulation.",
)


app.add_typer(firmware.app, name="firmware")
app.add_typer(token.app, name="token")
app.command()(doctor)
app.command()(reproduce)
app.command()(run)
app.command()(study)


def main() -> None:
    """The console script."""
    try:
        app()
    except KeyboardInterrupt:
        console.print("pivotrig: interrupted", style="red")
        sys.exit(FAILED)


@app.command(
    add_help_option=False, context_settings={"ignore_unknown_options": True, "allow_extra_args": True}
)
def calibrate(context: typer.Context) -> None:
    """Measure a rig."""
    from server.commands.calibrate import (
        app as calibrations,  # they need most of the program: only they load it
    )

    calibrations(context.args, prog_name=context.command_path)


@app.command(
    add_help_option=False, context_settings={"ignore_unknown_options": True, "allow_extra_args": True}
)
def runs(context: typer.Context) -> None:
    """Find, look at, edit, delete, export and replay runs."""
    from server.commands.runs import app as recorded  # as above

    recorded(context.args, prog_name=context.command_path)


@app.command(
    add_help_option=False, context_settings={"ignore_unknown_options": True, "allow_extra_args": True}
)
def studies(context: typer.Context) -> None:
    """Look at studies, go on with one, write its report, take its table."""
    from server.commands.studies import app as begun  # as above

    begun(context.args, prog_name=context.command_path)


@app.command()
def serve(
    sim: Annotated[
        bool, typer.Option("--sim", help="Simulate camera and board, whatever the rig file says.")
    ] = False,
    rig: RigOption = None,
    plugin: PluginOption = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; any but loopback demands a token.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 picks a free port.")] = 8000,
    data: DataOption = None,
    open_browser: Annotated[bool, typer.Option("--open", help="Open the dashboard in the browser.")] = False,
    demand_token: Annotated[
        bool, typer.Option("--demand-token", help="Ask for a token on loopback, too.")
    ] = False,
    allow_host: Annotated[
        list[str] | None, typer.Option(help="Another name that the rig is asked by; may be repeated.")
    ] = None,
    allow_origin: Annotated[
        list[str] | None, typer.Option(help="Another site whose pages may use the rig; may be repeated.")
    ] = None,
    proxy: Annotated[
        list[str] | None, typer.Option(help="Address of a proxy that may speak for others; demands a token.")
    ] = None,
    tls_cert: Annotated[Path | None, typer.Option(help="Certificate for https, PEM.")] = None,
    tls_key: Annotated[Path | None, typer.Option(help="Its key, PEM, without a password.")] = None,
    log_format: Annotated[LogFormat, typer.Option(help="Of the log's lines.")] = LogFormat.TEXT,
    log_file: Annotated[
        Path | None, typer.Option(help="Write the log there, rotated, and not to stderr.")
    ] = None,
    log_level: Annotated[LogLevel, typer.Option(help="The least that is logged.")] = LogLevel.WARNING,
) -> None:
    """Open the rig and serve its dashboard."""
    check_environment()
    load_plugins(plugin)
    store = open_rig_store(rig, data)
    from server.access.opening import Opening
    from server.serving import Place, ServeError, serve_rig
    from server.watching.log import LogChoice, LogFileError, logging_to

    opening = Opening(
        tuple(allow_host or ()),
        tuple(allow_origin or ()),
        tuple(proxy or ()),
        tls_cert,
        tls_key,
        demand_token,
    )
    as_run = RigFile.as_simulated if sim else _as_it_is
    log = LogChoice(log_format is LogFormat.JSON, log_file, log_level.value)
    try:
        with logging_to(log):
            serve_rig(store, as_run, Place(host, port, opening=opening), data_folder(data), open_browser)
    except (ServeError, LogFileError) as error:
        raise fail(str(error), FAILED) from error


def _as_it_is(settings: RigFile) -> RigFile:
    return settings
