"""`pivotrig runs …`: what has been recorded, looked at, edited and tidied."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from server.commands.outcome import DataOption
from server.commands.run_choice import RunArgument, id_of, opened_shelf
from server.commands.runs_edit import delete, edit, prune
from server.commands.runs_export import export
from server.commands.runs_mend import rebuild, recover
from server.commands.runs_replay import again, replay
from server.commands.runs_retrack import retrack
from server.commands.sizes import size_text

if TYPE_CHECKING:
    from server.catalogue.records import RunRecord

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Runs that were recorded: find, look at, edit, delete, take away, show again.",
)

JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")]
COLOURS = {"finished": "green", "running": "cyan", "aborted": "red", "interrupted": "yellow"}
SHOWN = 20
"""Runs listed unless asked otherwise."""


@app.callback()
def runs() -> None:
    """Runs that were recorded: find, look at, edit, delete, take away, show again."""


@app.command(name="list")
def list_runs(
    text: Annotated[str, typer.Option(help="Words in label, id, notes, tags, controller or path.")] = "",
    state: Annotated[str, typer.Option(help="finished, stopped, aborted, interrupted or running.")] = "",
    controller: Annotated[str, typer.Option(help="Name of the controller.")] = "",
    trajectory: Annotated[str, typer.Option(help="Name of the trajectory.")] = "",
    tag: Annotated[str, typer.Option(help="A tag.")] = "",
    study: Annotated[str, typer.Option(help="Id of a study.")] = "",
    pinned: Annotated[bool | None, typer.Option("--pinned/--not-pinned", help="Only such.")] = None,
    since: Annotated[datetime | None, typer.Option(help="Started then or later, local time.")] = None,
    until: Annotated[datetime | None, typer.Option(help="Started before, local time.")] = None,
    limit: Annotated[int, typer.Option(min=1, max=10_000, help="Runs listed at most.")] = SHOWN,
    data: DataOption = None,
    as_json: JsonOption = False,
) -> None:
    """List runs, newest first."""
    from server.catalogue.records import RunQuery

    query = RunQuery(
        text=text,
        state=state,
        controller=controller,
        trajectory=trajectory,
        tag=tag,
        study=study,
        pinned=pinned,
        since=_instant(since),
        until=_instant(until),
    )
    with opened_shelf(data) as shelf:
        page = shelf.catalogue.page(query, limit=limit)
        totals = shelf.catalogue.totals()
    if as_json:
        from server.catalogue.record_json import record_json

        found = [record_json(run) for run in page.runs]
        print(json.dumps({"runs": found, "total": page.total}, allow_nan=False))
        return
    _print_table(page.runs)
    rest = f" ({len(page.runs)} shown; --limit shows more)" if len(page.runs) < page.total else ""
    typer.echo(f"{page.total} of {totals.runs} runs{rest}, {size_text(totals.size)} in all", err=True)


def _instant(local: datetime | None) -> datetime | None:
    """A time of this place as one of everywhere; raises typer.BadParameter."""
    try:
        return None if local is None else local.astimezone()
    except (ValueError, OverflowError) as error:  # in the first year and the last
        raise typer.BadParameter(f"{local} is no time that this computer's clock knows") from error


HEADINGS = ("id", "started", "label", "state", "controller", "trajectory", "error", "time", "size")


def _print_table(runs: Sequence[RunRecord]) -> None:
    """A table for a person, plain lines with tabs between for a program."""
    if not Console().is_terminal:
        for run in runs:
            print("\t".join(_cells(run)))
        return
    table = Table(*HEADINGS, box=None, padding=(0, 2, 0, 0))
    for run in runs:
        id, started, label, state, *rest = map(Text, _cells(run))
        state.stylize(COLOURS.get(run.state, ""))
        table.add_row(id, started, label, state, *rest)
    Console().print(table)


def _cells(run: RunRecord) -> tuple[str, ...]:
    metrics = run.metrics or {}
    return (
        run.id,
        f"{run.started_at.astimezone():%Y-%m-%d %H:%M}",
        ("* " if run.pinned else "") + run.label,
        run.state,
        run.controller,
        run.trajectory,
        _figure(metrics.get("mean_error_mm"), "{:.2f} mm"),
        _figure(metrics.get("duration_s"), "{:.0f} s"),
        size_text(run.size_bytes) if run.size_bytes else "-",
    )


def _figure(value: float | None, form: str) -> str:
    return "-" if value is None else form.format(value)


@app.command()
def show(
    id: RunArgument,
    with_settings: Annotated[bool, typer.Option("--settings", help="Also all that made the run.")] = False,
    data: DataOption = None,
    as_json: JsonOption = False,
) -> None:
    """Show all that the catalogue knows of a run."""
    from server.catalogue.record_json import record_json

    with opened_shelf(data) as shelf:
        record = shelf.catalogue.get(id_of(shelf.catalogue, id))
    values = record_json(record)
    if as_json:
        print(json.dumps({**values, "settings": record.settings}, allow_nan=False))
        return
    del values["sparkline"]
    _print_lines(values)
    if with_settings:
        _print_lines({"settings": record.settings})
    elif record.settings:
        names = ", ".join(record.settings)
        typer.echo(f"settings: {names}; --settings shows them", err=True)


def _print_lines(values: Mapping[str, Any]) -> None:
    lines = list(_lines(values))
    width = max((len(name) for name, _ in lines), default=0)
    for name, value in lines:
        print(f"{name:<{width}}  {value}".rstrip())


def _lines(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, str]]:
    """Dotted names and their values; empty groups are left out."""
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _lines(value, f"{prefix}{name}.")
        else:
            shown = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
            yield f"{prefix}{name}", " ".join(shown.split())


for command in (edit, delete, prune, rebuild, recover, export, replay, again, retrack):
    app.command()(command)
