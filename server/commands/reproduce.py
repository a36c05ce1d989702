"""`pivotrig reproduce`: the paper's results, ours beside them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from server.commands.outcome import FAILED, USAGE, console, fail

if TYPE_CHECKING:
    from server.reports.experiments.designs import Experiment
    from server.reports.reproduction import Extent, Reproduction


def reproduce(
    out: Annotated[Path, typer.Option("--out", help="Folder for the report.")] = Path("reproduction"),
    sections: Annotated[str, typer.Option("--sections", help="Of the paper, of 3, 5 and 6.")] = "3,5,6",
    runs: Annotated[
        int | None,
        typer.Option("--runs", min=1, help="Of each set of section 6, at most; the report says so."),
    ] = None,
    rigid: Annotated[
        bool,
        typer.Option(
            "--rigid/--no-rigid", help="Section 6 with the rigid plant (extra physics), which is slow."
        ),
    ] = True,
    jobs: Annotated[int, typer.Option("--jobs", min=0, help="Processes; 0: one for each core.")] = 0,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Sections 3 and 5 of the paper in pure kinematics, section 6 as batches of runs: one HTML page, its figures as
    PNG, its numbers as CSV."""
    from server.reports.reproduction import Extent

    done = _made(out, Extent(_sections(sections), runs, rigid, jobs))
    if as_json:
        found = [
            {"section": f.section, "paper": f.paper, "ours": f.ours, "verdict": f.verdict, "note": f.note}
            for f in done.findings
        ]
        report = {"report": str(done.page), "findings": found, "wall_s": round(done.elapsed, 3)}
        print(json.dumps(report, ensure_ascii=False))
        return
    for finding in done.findings:
        print(f"{finding.verdict:<15} {finding.section:<15} {finding.paper}: {finding.ours}")
    print(f"report: {done.page}")


def _sections(text: str) -> tuple[int, ...]:
    from server.reports.reproduction import SECTIONS

    wanted = [part.strip() for part in text.split(",") if part.strip()]
    known = {str(section): section for section in SECTIONS}
    wrong = [part for part in wanted if part not in known]
    if wrong or not wanted:
        raise fail(f"--sections {text!r}: give some of {', '.join(known)}, with commas between them", USAGE)
    return tuple(known[part] for part in wanted)


def _made(out: Path, extent: Extent) -> Reproduction:
    from control.studies.workers import WorkersLost
    from server.reports.reproduction import reproduce as write

    bar = Progress(
        TextColumn("{task.description}", markup=False), BarColumn(bar_width=24), MofNCompleteColumn(),
        TimeRemainingColumn(), console=console, disable=not console.is_terminal,
    )  # fmt: skip
    try:
        with bar:
            task = bar.add_task("walking the paper's walks", total=None)

            def watch(study: Experiment, done: int, total: int) -> None:
                bar.update(task, description=study.definition.name, completed=done, total=total)

            return write(out, extent, watch)
    except WorkersLost as error:
        raise fail(f"section 6 could not be carried out: {error}", FAILED) from error
    except OSError as error:
        raise fail(f"the report cannot be written to {out}: {error.strerror or error}", FAILED) from error
