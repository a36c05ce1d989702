"""Sections 3 and 5 of the paper: figures, tables and one page, ours beside the paper's."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from server.api.state import VERSION
from server.reports import drawing, figures, findings, locomotion, page, simulation, tables
from server.reports.findings import UNKNOWNS, Finding
from server.reports.page import Picture
from server.reports.simulation import Simulation
from server.reports.tables import Table

TITLE = "The paper's results, reproduced"
PAPER = (
    "Feedback Control of Millimeter Scale Pivot Walkers Using Magnetic Actuation (Al Khatib, Razzaghi, Hurmuzlu): "
    "sections 3 and 5, in pure kinematics: exact arcs, exact ends of sweeps, no slip, no camera."
)


@dataclass(frozen=True, slots=True)
class Reproduction:
    """page: the HTML file.  files: everything written.  elapsed: s."""

    page: Path
    files: tuple[Path, ...]
    findings: tuple[Finding, ...]
    elapsed: float


def reproduce(folder: Path) -> Reproduction:
    """Compute everything and write it into `folder`, which is made if need be; raises OSError."""
    began = time.perf_counter()
    folder.mkdir(parents=True, exist_ok=True)
    walks, eights = locomotion.analyse(), simulation.simulate()
    found = (*findings.of_locomotion(walks), *findings.of_simulation(eights))
    pictures = _pictures(walks, eights)
    contents = {f"{one.name}.png": one.png for one in pictures.values()}
    for name, table in _tables(walks, eights, found).items():
        contents[f"{name}.csv"] = tables.csv_text(table).encode()
    elapsed = time.perf_counter() - began
    contents["report.html"] = _page(found, pictures, eights, elapsed).encode()
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    files = tuple(folder / name for name in contents)
    return Reproduction(folder / "report.html", files, found, time.perf_counter() - began)


def _pictures(walks: locomotion.Locomotion, eights: Simulation) -> dict[str, Picture]:
    drawn = (
        ("paths", "Straight walks of 40 mm at six sweep angles (paper: figure of paths).", figures.paths(walks)),
        ("steps", "Steps for 60 mm over the sweep angle (paper: figure of steps).", figures.steps(walks)),
        ("travel", "Way of the centre for 60 mm over the sweep angle (paper: travel).", figures.travel(walks)),
        ("eights", "One eight from the paper's start (paper: simulation, a).", figures.eights(eights)),
        ("errors", "Distance of the centre from the reference (paper: simulation, b).", figures.errors(eights)),
        ("choices", "Mean error over completed sweeps: what a smaller error costs.", figures.choices(eights)),
    )  # fmt: skip
    return {name: Picture(name, caption, drawing.png(figure)) for name, caption, figure in drawn}


def _tables(walks: locomotion.Locomotion, eights: Simulation, found: tuple[Finding, ...]) -> dict[str, Table]:
    return {
        "findings": tables.findings(found),
        "locomotion_paths": tables.paths(walks),
        "locomotion_sweeps": tables.costs(walks),
        "simulation_cases": tables.cases(eights.cases),
        "simulation_errors": tables.error_curves(eights),
        "simulation_choices": tables.cases((*eights.gains, *eights.choices, *eights.early)),
    }


def _page(
    found: tuple[Finding, ...], pictures: dict[str, Picture], eights: Simulation, elapsed: float
) -> str:
    verdicts = Counter(one.verdict for one in found)
    summary = ", ".join(f"{count} {verdict.value}" for verdict, count in verdicts.items())
    body = [
        f"<h1>{TITLE}</h1>",
        page.paragraph(PAPER),
        page.paragraph(f"{len(found)} statements: {summary}."),
        page.table(tables.findings(found)),
        page.heading("Section 3: locomotion"),
        *(page.picture(pictures[name]) for name in ("paths", "steps", "travel")),
        page.heading("Section 5: simulation"),
        page.table(tables.cases(eights.cases)),
        *(page.picture(pictures[name]) for name in ("eights", "errors", "choices")),
        page.heading("What the paper leaves open, and what we did"),
        page.listing(UNKNOWNS),
        f"<p><small>pivotrig {VERSION}, <code>pivotrig reproduce</code>, {elapsed:.0f} s. The numbers behind the "
        "figures are in the CSV files beside this page.</small></p>",
    ]
    return page.page(TITLE, body)
