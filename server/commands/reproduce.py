"""`pivotrig reproduce`: the paper's results, ours beside them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from server.commands.outcome import FAILED, console, fail


def reproduce(
    out: Annotated[Path, typer.Option("--out", help="Folder for the report.")] = Path("reproduction"),
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """Sections 3 and 5 of the paper in pure kinematics: one HTML page, its figures as PNG, its numbers as CSV."""
    from server.reports.reproduction import reproduce as write

    try:
        with console.status("walking the paper's walks"):
            done = write(out)
    except OSError as error:
        raise fail(f"the report cannot be written to {out}: {error.strerror or error}", FAILED) from error
    if as_json:
        found = [
            {"section": f.section, "paper": f.paper, "ours": f.ours, "verdict": f.verdict}
            for f in done.findings
        ]
        report = {"report": str(done.page), "findings": found, "wall_s": round(done.elapsed, 3)}
        print(json.dumps(report, ensure_ascii=False))
        return
    for finding in done.findings:
        print(f"{finding.verdict:<15} {finding.section:<10} {finding.paper}: {finding.ours}")
    print(f"report: {done.page}")
