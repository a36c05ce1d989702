"""`pivotrig runs retrack`: the pictures of a run, looked at by another tracker, filter or controller."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from server.commands.outcome import FAILED, USAGE, DataOption, console, fail, read_rig_file
from server.commands.plugin_option import PluginOption, load_plugins
from server.commands.run_choice import RunArgument, recording_of, records_of

if TYPE_CHECKING:
    from server.retrack.changes import Changes
    from server.retrack.retracking import Watch

Values = Annotated[
    list[str] | None,
    typer.Option(metavar="KEY=VALUE", help="A value of this section of the rig file; may be given again."),
]


def retrack(
    id: RunArgument,
    vision: Values = None,
    estimator: Values = None,
    controller: Annotated[str | None, typer.Option(help="A controller to ask at each tick.")] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="A parameter of it; may be given again."),
    ] = None,
    estimate: Annotated[
        Literal["recorded", "again"], typer.Option(help="What the controller is shown.")
    ] = "recorded",
    rig: Annotated[
        Path | None, typer.Option("--rig", help="Rig file whose tracker, filter and camera are taken.")
    ] = None,
    out: Annotated[Path | None, typer.Option("--out", help="CSV file with every tick.")] = None,
    data: DataOption = None,
    plugin: PluginOption = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Look at the pictures of a run again, with other settings or for another controller, and compare."""
    load_plugins(plugin)
    if out is not None and out.exists():
        raise fail(f"{out} is there already; choose another name with --out", USAGE)
    if settings and controller is None:
        raise fail("--set gives parameters of the controller; name one with --controller", USAGE)
    from control.runs import Choice
    from server.retrack.changes import Changes

    asked = None if controller is None else Choice(controller, _values(settings, "--set"))
    other = None if rig is None else read_rig_file(rig).to_recorded()
    changes = Changes(_values(vision, "--vision"), _values(estimator, "--estimator"), other, asked, estimate)
    [record] = records_of([id], data)
    result = _looked_at(recording_of(record, data), changes, out)
    if as_json:
        print(json.dumps({"run_id": record.id, **result}, allow_nan=False))
        return
    _print(result["comparison"])
    if out is not None:
        typer.echo(f"every tick: {out}", err=True)


def _looked_at(path: Path, changes: Changes, out: Path | None) -> dict[str, Any]:
    """Changes and comparison; the series of points is for the page."""
    from server.retrack.changes import RetrackError
    from server.retrack.retracking import retrack as look_again

    try:
        with _bar() as watch:
            result = look_again(path, changes, watch) if out is None else _to_file(path, changes, out, watch)
    except RetrackError as error:
        raise fail(str(error), FAILED) from error
    except OSError as error:
        raise fail(f"{out} cannot be written: {error.strerror or error}", USAGE) from error
    return {name: result[name] for name in ("changes", "comparison")}


def _to_file(path: Path, changes: Changes, out: Path, watch: Watch) -> dict[str, Any]:
    """Also every tick to `out`, of which nothing is left when that fails."""
    from server.retrack.retracking import Retrack
    from server.retrack.series import CsvTable

    retracked = Retrack(changes)
    try:
        with out.open("x", encoding="utf-8", newline="") as file:
            table = CsvTable(file)
            for seen in retracked.ticks(path, watch):
                table.add(seen)
    except BaseException:
        out.unlink(missing_ok=True)
        raise
    return retracked.to_json()


@contextmanager
def _bar() -> Iterator[Watch]:
    """A progress bar on stderr that stays away when nobody looks at a terminal."""
    columns = TextColumn("looking again"), BarColumn(), TimeRemainingColumn()
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task("", total=1.0)
        yield lambda share: progress.update(task, completed=share)


def _values(settings: list[str] | None, option: str) -> dict[str, Any]:
    """`slip_mm=0.2` and its kin; a value is JSON where it is JSON, else the text itself."""
    values: dict[str, Any] = {}
    for setting in settings or []:
        name, equals, text = setting.partition("=")
        if not (name.strip() and equals):
            raise fail(f"{option} {setting!r} is not understood; write NAME=VALUE", USAGE)
        try:
            values[name.strip()] = json.loads(text)
        except json.JSONDecodeError:
            values[name.strip()] = text.strip()
    return values


def _print(comparison: Mapping[str, Any]) -> None:
    """Then, now and how they differ; for a program, the same with tabs between."""
    rows = [*_compared(comparison), *_differing(comparison), *_commanded(comparison["command"])]
    if not Console().is_terminal:
        for row in rows:
            print("\t".join(row))
        return
    table = Table("", "then", "now", "difference", box=None, padding=(0, 2, 0, 0))
    for row in rows:
        table.add_row(*row)
    Console().print(table)


COMPARED = {
    "mean_error_mm": ("mean error", "{:.3f} mm", 1.0),
    "known_share": ("robot known", "{:.1f} %", 100.0),
    "locked_share": ("seen in pictures", "{:.1f} %", 100.0),
    "times_lost": ("times lost", "{:.0f}", 1.0),
    "sightings_refused": ("sightings refused", "{:.0f}", 1.0),
}


def _compared(comparison: Mapping[str, Any]) -> Iterator[tuple[str, str, str, str]]:
    for name, (title, form, factor) in COMPARED.items():
        then, now = comparison[name]["then"], comparison[name]["now"]
        difference = None if then is None or now is None else now - then
        yield title, _text(then, form, factor), _text(now, form, factor), _text(difference, form, factor)


def _differing(comparison: Mapping[str, Any]) -> Iterator[tuple[str, str, str, str]]:
    for name, title, form in (
        ("position_mm", "position", "{:.3f} mm"),
        ("heading_deg", "heading", "{:.2f} deg"),
    ):
        for figure in ("mean", "rms", "max"):
            yield f"{title}, {figure}", "", "", _text(comparison[name][figure], form)


def _commanded(command: Mapping[str, Any] | None) -> Iterator[tuple[str, str, str, str]]:
    if command is None:
        return
    for name, title in (
        ("same_pivot_share", "same pivot commanded"),
        ("same_rate_share", "same rate commanded"),
    ):
        yield title, "", _text(command[name], "{:.1f} %", 100.0), ""
    yield "rate, rms", "", "", _text(command["rate_deg_s"]["rms"], "{:.2f} deg/s")
    yield f"(the controller was {command['note']})", "", "", ""


def _text(value: float | None, form: str, factor: float = 1.0) -> str:
    return "-" if value is None else form.format(value * factor)
