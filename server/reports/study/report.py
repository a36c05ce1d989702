"""The report of a study: what was found, in words, figures and tables, on one page that stands alone."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from control.studies.analysis.whole import analyse
from control.studies.definition import StudyDefinition
from control.studies.table import StudyTable
from server.atomic_save import replace_file
from server.reports import drawing
from server.reports.page import Picture
from server.reports.study import figures, tables
from server.reports.study.figures import Drawn
from server.reports.study.sheet import Content, sheet
from server.reports.study.walks import source_of
from server.reports.tables import csv_text

REPORT = "report.html"


def write_report(
    table: StudyTable, definition: StudyDefinition, folder: Path, recordings: Path | None = None
) -> Path:
    """The page's path; the same figures (PNG, SVG), tables (CSV) and the definition lie beside it.

    folder: made if need be.  recordings: folder of a rig's recordings, for the picture of paths.  Raises OSError.
    """
    folder.mkdir(parents=True, exist_ok=True)
    found = analyse(table.rows, definition.axis_names, _order(definition))
    drawn = {
        "measured": [*figures.measured(found), *figures.learned(definition, table)],
        "distributed": list(figures.distributed(found)),
        "walked": list(figures.walked(found, table, source_of(definition, recordings))),
    }
    tabled = {name: one for name, one in tables.all_of(found, definition).items() if len(one) > 1}
    pictures = {name: [_written(one, folder) for one in group] for name, group in drawn.items()}
    for name, rows in tabled.items():
        (folder / f"{name}.csv").write_bytes(csv_text(rows).encode())
    (folder / "runs.csv").write_bytes(table.csv())
    (folder / "study.toml").write_bytes(definition.to_toml().encode())
    content = Content(definition, table, found, pictures, tabled)
    replace_file(folder / REPORT, sheet(content))  # last, and whole: who finds it finds everything
    return folder / REPORT


def _order(definition: StudyDefinition) -> Sequence[int] | None:
    """In which order a rig was asked for its runs; a batch has no clock with which anything could drift."""
    if definition.on == "batch" or definition.design == "tune":
        return None
    return definition.plan().next({})


def _written(drawn: Drawn, folder: Path) -> Picture:
    png = drawing.png(drawn.figure)
    (folder / f"{drawn.name}.png").write_bytes(png)
    drawn.figure.set_layout_engine("none")  # what was laid out for the picture stays
    (folder / f"{drawn.name}.svg").write_bytes(drawing.svg(drawn.figure))
    return Picture(drawn.name, drawn.caption, png)
