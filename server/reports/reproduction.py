"""The paper's sections 3, 5 and 6: figures, tables and one page, ours beside the paper's."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from server.api.state import VERSION
from server.reports import drawing, figures, findings, locomotion, page, simulation, tables
from server.reports.findings import Finding
from server.reports.page import Picture
from server.reports.part import Part

if TYPE_CHECKING:
    from control.studies.table import StudyTable
    from server.reports.experiments.carrying import Watch

TITLE = "The paper's results, reproduced"
PAPER = (
    "Feedback Control of Millimeter Scale Pivot Walkers Using Magnetic Actuation (Al Khatib, Razzaghi, Hurmuzlu). "
    "Sections 3 and 5 in pure kinematics: exact arcs, exact ends of sweeps, no slip, no camera; section 6 as batches "
    "of runs on simulated robots."
)
SECTIONS = (3, 5, 6)


@dataclass(frozen=True, slots=True)
class Extent:
    """How much of the paper. runs: of each set of section 6, at most; None for the paper's.  rigid: with the rigid
    plant, where its extra is installed.  jobs: processes; 0: one a core."""

    sections: Collection[int] = SECTIONS
    runs: int | None = None
    rigid: bool = True
    jobs: int = 0


@dataclass(frozen=True, slots=True)
class Reproduction:
    """page: the HTML file.  files: everything written.  elapsed: s."""

    page: Path
    files: tuple[Path, ...]
    findings: tuple[Finding, ...]
    elapsed: float


def reproduce(folder: Path, extent: Extent | None = None, watch: Watch | None = None) -> Reproduction:
    """Compute everything and write it into `folder`, which is made if need be; raises OSError and `WorkersLost`."""
    began = time.perf_counter()
    folder.mkdir(parents=True, exist_ok=True)
    asked = extent or Extent()
    parts = [make() for section, make in _makers(folder, asked, watch).items() if section in asked.sections]
    found = tuple(one for part in parts for one in part.findings)
    contents = {f"{one.name}.png": one.png for part in parts for one in part.pictures}
    numbers = {name: table for part in parts for name, table in part.tables.items()}
    for name, table in {"findings": tables.findings(found), **numbers}.items():
        contents[f"{name}.csv"] = tables.csv_text(table).encode()
    for part in parts:
        contents |= part.raw
    contents["report.html"] = _page(found, parts, time.perf_counter() - began).encode()
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    files = tuple(folder / name for name in contents)
    return Reproduction(folder / "report.html", files, found, time.perf_counter() - began)


def _makers(folder: Path, extent: Extent, watch: Watch | None) -> dict[int, Callable[[], Part]]:
    return {3: _locomotion, 5: _simulation, 6: lambda: _experiments(folder, extent, watch)}


def _locomotion() -> Part:
    walks = locomotion.analyse()
    shown = _drawn(
        (
            "paths",
            "Straight walks of 40 mm at six sweep angles (paper: figure of paths).",
            figures.paths(walks),
        ),
        ("steps", "Steps for 60 mm over the sweep angle (paper: figure of steps).", figures.steps(walks)),
        (
            "travel",
            "Way of the centre for 60 mm over the sweep angle (paper: travel).",
            figures.travel(walks),
        ),
    )
    return Part(
        findings=tuple(findings.of_locomotion(walks)),
        pictures=shown,
        tables={"locomotion_paths": tables.paths(walks), "locomotion_sweeps": tables.costs(walks)},
        body=(page.heading("Section 3: locomotion"), *(page.picture(one) for one in shown)),
        unknowns=findings.UNKNOWN_IN_3,
    )


def _simulation() -> Part:
    eights = simulation.simulate()
    shown = _drawn(
        ("eights", "One eight from the paper's start (paper: simulation, a).", figures.eights(eights)),
        (
            "errors",
            "Distance of the centre from the reference (paper: simulation, b).",
            figures.errors(eights),
        ),
        ("choices", "Mean error over completed sweeps: what a smaller error costs.", figures.choices(eights)),
    )
    cases = tables.cases(eights.cases)
    return Part(
        findings=tuple(findings.of_simulation(eights)),
        pictures=shown,
        tables={
            "simulation_cases": cases,
            "simulation_errors": tables.error_curves(eights),
            "simulation_choices": tables.cases((*eights.gains, *eights.choices, *eights.early)),
        },
        body=(
            page.heading("Section 5: simulation"),
            page.table(cases),
            *(page.picture(one) for one in shown),
        ),
        unknowns=findings.UNKNOWN_IN_5,
    )


def _experiments(folder: Path, extent: Extent, watch: Watch | None) -> Part:
    from server.reports.experiments.carrying import carry_out, file_of
    from server.reports.experiments.designs import RIGID, experiments
    from server.reports.experiments.part import part

    studies = [one for one in experiments(extent.runs) if extent.rigid or one.key != RIGID]

    def keep(key: str, table: StudyTable) -> None:
        (folder / file_of(key)).write_bytes(table.csv())

    return part(studies, carry_out(studies, extent.jobs, watch, keep))


def _drawn(*drawn: tuple[str, str, drawing.Figure]) -> tuple[Picture, ...]:
    return tuple(Picture(name, caption, drawing.png(figure)) for name, caption, figure in drawn)


def _page(found: tuple[Finding, ...], parts: list[Part], elapsed: float) -> str:
    verdicts = Counter(one.verdict for one in found)
    summary = ", ".join(f"{count} {verdict.value}" for verdict, count in verdicts.items())
    body = [
        f"<h1>{TITLE}</h1>",
        page.paragraph(PAPER),
        page.paragraph(f"{len(found)} statements: {summary}."),
        page.table(tables.findings(found)),
        *(piece for part in parts for piece in part.body),
        page.heading("What the paper leaves open, and what we did"),
        page.listing([one for part in parts for one in part.unknowns]),
        f"<p><small>pivotrig {VERSION}, <code>pivotrig reproduce</code>, {elapsed:.0f} s. The numbers behind the "
        "figures are in the CSV files beside this page.</small></p>",
    ]
    return page.page(TITLE, body)
