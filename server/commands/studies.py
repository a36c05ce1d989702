"""`pivotrig studies …`: those of a data folder, looked at, carried on, taken away."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from server.commands.answers import one_line
from server.commands.outcome import FAILED, DataOption, RigOption, console, fail
from server.commands.plugin_option import PluginOption, load_plugins
from server.commands.study import DaskOption, JobsOption, JsonOption, YesOption
from server.commands.study_choice import StudyArgument, chosen, id_of, opened_store, tell_of_unreadable
from server.commands.study_progress import best_text, print_outcome
from server.commands.study_sitting import Sitting, result_of, sit

if TYPE_CHECKING:
    from server.studies.study import Study

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Studies that were begun: look at them, go on, write their report, take their table, delete them.",
)

HEADINGS = ("id", "name", "on", "state", "runs", "failed", "best")
COLOURS = {"finished": "green", "running": "cyan", "failed": "red", "interrupted": "yellow"}


@app.callback()
def studies() -> None:
    """Studies that were begun: look at them, go on, write their report, take their table, delete them."""


@app.command(name="list")
def list_studies(data: DataOption = None, plugin: PluginOption = None, as_json: JsonOption = False) -> None:
    """List studies, newest first."""
    load_plugins(plugin)
    with opened_store(data) as store:
        found = store.described(_summary)
        tell_of_unreadable(store)
    if as_json:
        print(json.dumps({"studies": found}, ensure_ascii=False, allow_nan=False))
        return
    _print_table([_cells(each) for each in found])


def _summary(study: Study) -> dict[str, Any]:
    from server.studies.progress import Progression, best_json, measure_of

    condition, plan, results = study.condition, study.definition.plan(), study.results()
    measure = measure_of(study.definition)
    best = Progression(plan.total, results, measure).best()
    return {
        "id": study.id,
        "name": study.definition.name,
        "on": study.definition.on,
        "design": study.definition.design,
        "state": condition.state,
        "reason": condition.reason,
        "created_at": condition.created_at,
        "done": len(results),
        "total": plan.total,
        "failed": results.failed,
        "wall_s": condition.wall_s,
        "best": None if best is None else {**best_json(best, measure), "text": best_text(best)},
    }


def _cells(summary: dict[str, Any]) -> tuple[str, ...]:
    best = summary["best"]
    return (
        summary["id"],
        summary["name"],
        summary["on"],
        summary["state"],
        f"{summary['done']}/{summary['total']}",
        str(summary["failed"]) if summary["failed"] else "-",
        "-" if best is None else best["text"],
    )


def _print_table(rows: list[tuple[str, ...]]) -> None:
    """A table for a person, plain lines with tabs between for a program."""
    if not Console().is_terminal:
        for row in rows:
            print("\t".join(row))
        return
    table = Table(*HEADINGS, box=None, padding=(0, 2, 0, 0))
    for id, name, on, state, *rest in rows:
        table.add_row(id, Text(name), on, Text(state, COLOURS.get(state, "")), *map(Text, rest))
    Console().print(table)


@app.command()
def show(
    id: StudyArgument, data: DataOption = None, plugin: PluginOption = None, as_json: JsonOption = False
) -> None:
    """Show how far a study is, and its definition."""
    load_plugins(plugin)
    with opened_store(data) as store:
        study = chosen(store, id)
        summary = _summary(study)
    if as_json:
        print(json.dumps({**summary, "definition": study.definition.to_json()}, ensure_ascii=False))
        return
    if summary["best"] is not None:
        summary["best"] = summary["best"]["text"]
    print_outcome(summary, as_json=False)
    print(f"\n{study.definition.to_toml()}", end="")


@app.command()
def resume(
    id: StudyArgument,
    jobs: JobsOption = 0,
    dask: DaskOption = None,
    rig: RigOption = None,
    data: DataOption = None,
    plugin: PluginOption = None,
    yes: YesOption = False,
    as_json: JsonOption = False,
) -> None:
    """Go on with a study where it was left; runs that are done stay as they are."""
    load_plugins(plugin)
    with opened_store(data) as store:
        study = chosen(store, id)
        if study.is_complete:
            from server.studies.carrying_out import Carried

            print_outcome(result_of(study, Carried("finished")), as_json=as_json)
            return
        sit(study, Sitting(jobs, dask, rig, data, yes, as_json))


@app.command()
def report(
    id: StudyArgument,
    out: Annotated[Path | None, typer.Option("--out", help="Folder; default: the study's own.")] = None,
    data: DataOption = None,
    plugin: PluginOption = None,
    as_json: JsonOption = False,
) -> None:
    """Write the report of a study: an HTML page, its figures, its numbers."""
    load_plugins(plugin)
    from server.catalogue.shelf import RECORDINGS
    from server.reports.study.report import write_report

    with opened_store(data) as store:
        study = chosen(store, id)
        folder = out or study.report_folder
        try:
            recordings = study.folder.parents[1] / RECORDINGS
            page = write_report(study.table(), study.definition, folder, recordings)
        except OSError as error:
            raise fail(
                f"the report cannot be written to {folder}: {error.strerror or error}", FAILED
            ) from error
    print(json.dumps({"id": study.id, "report": str(page)}) if as_json else page)


@app.command()
def table(id: StudyArgument, data: DataOption = None, plugin: PluginOption = None) -> None:
    """Print all runs of a study as CSV, with every digit."""
    load_plugins(plugin)
    with opened_store(data) as store:
        content = chosen(store, id).table().csv()
    sys.stdout.buffer.write(content)
    sys.stdout.buffer.flush()


@app.command()
def delete(
    ids: Annotated[list[str], typer.Argument(metavar="ID...", help="Studies; beginnings of their ids.")],
    yes: Annotated[bool, typer.Option("--yes", help="Delete without asking.")] = False,
    data: DataOption = None,
) -> None:
    """Delete studies with their tables and reports; runs that were recorded stay."""
    with opened_store(data) as store:
        found = [id_of(store, id) for id in dict.fromkeys(ids)]
        if not yes:
            console.print(f"Delete {', '.join(found)}, with tables and reports? (y/N)", end=" ")
            if one_line().strip().lower() not in ("y", "yes"):
                raise fail("nothing was deleted", FAILED)
        for id in found:
            store.delete(id)
    print(f"deleted: {', '.join(found)}")
