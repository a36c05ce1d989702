"""`pivotrig reproduce`: the report is written, whole and honest."""

import csv
import json
import re
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from control.controllers.planner import PlannerParameters
from server.cli import app
from server.reports import drawing, findings, simulation
from server.reports.findings import PAPER_STEPS, Verdict
from server.reports.simulation import GB, GB_BEST, OB, PLANNER, PLANNER_EARLY, Case, Simulation, run

PICTURES = ("paths", "steps", "travel", "eights", "errors", "choices")


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory, full: bool) -> Path:
    """The folder of a report, made within the time that is promised, as far as the processor counts it. Unless all
    is asked for, the planner walks at its defaults only, and the pictures are coarse."""
    folder = tmp_path_factory.mktemp("reproduction")
    began = time.process_time()
    with pytest.MonkeyPatch.context() as smaller:
        if not full:
            smaller.setattr(simulation, "SWEEP_WEIGHTS", simulation.SWEEP_WEIGHTS[:1])
            smaller.setattr(simulation, "EARLY_WEIGHTS", simulation.EARLY_WEIGHTS[:1])
            smaller.setattr(drawing, "DPI", 60)
        answer = CliRunner().invoke(app, ["reproduce", "--sections", "3,5", "--out", str(folder), "--json"])
    assert answer.exit_code == 0, answer.stderr
    assert time.process_time() - began < 120.0
    assert json.loads(answer.stdout)["report"] == str(folder / "report.html")
    return folder


def rows(path: Path) -> list[dict[str, str]]:
    with path.open() as file:
        return list(csv.DictReader(file))


def test_the_page_stands_alone(report: Path) -> None:
    page = (report / "report.html").read_text()
    assert page.count("data:image/png;base64,") == len(PICTURES)
    assert not re.search(r"""(src|href)=["'](?!data:)""", page)
    assert "http" not in page


def test_each_figure_is_a_picture_of_its_own_too(report: Path) -> None:
    for name in PICTURES:
        content = (report / f"{name}.png").read_bytes()
        assert content.startswith(b"\x89PNG")
        assert len(content) > 5_000


def test_only_the_sections_asked_for_are_made(report: Path) -> None:
    assert {row["section"].split(",")[0] for row in rows(report / "findings.csv")} == {"3", "5"}
    assert not list(report.glob("section6*"))


def test_the_planner_of_the_table_is_the_planner_at_its_defaults() -> None:
    assert PlannerParameters().sweep_weight == simulation.SWEEP_WEIGHTS[0]
    assert simulation.EARLY_WEIGHTS[0] == simulation.SWEEP_WEIGHTS[0]


def test_the_papers_counts_stand_beside_ours(report: Path) -> None:
    cases = {(row["controller"], int(row["sweep_deg"])): row for row in rows(report / "simulation_cases.csv")}
    for key, paper in PAPER_STEPS.items():
        assert int(cases[key]["steps_paper"]) == paper
        assert int(cases[key]["steps"]) == pytest.approx(paper, rel=0.10)
    for sweep_deg, sweeps in ((10, 437), (30, 167)):
        error = {name: float(cases[name, sweep_deg]["mean_error_mm"]) for name in (GB, GB_BEST, OB, PLANNER)}
        assert error[PLANNER] < error[OB] < error[GB_BEST] <= error[GB]
        assert int(cases[PLANNER, sweep_deg]["sweeps"]) <= 1.3 * sweeps
        assert float(cases[PLANNER_EARLY, sweep_deg]["mean_error_mm"]) < error[PLANNER]


def test_the_error_curves_have_a_row_a_tick(report: Path) -> None:
    curves = rows(report / "simulation_errors.csv")
    assert len(curves) == 1258
    assert [curves[index]["time_s"] for index in (0, 1, -1)] == ["0.0", "0.1", "125.7"]


def test_every_statement_has_a_verdict_and_what_cannot_be_compared_says_so(report: Path) -> None:
    found = rows(report / "findings.csv")
    assert {row["verdict"] for row in found} <= {verdict.value for verdict in Verdict}
    assert all(row["note"] for row in found if row["verdict"] == Verdict.NOT_COMPARABLE.value)
    page = (report / "report.html").read_text()
    assert page.count('class="reproduced"') == sum(row["verdict"] == "reproduced" for row in found)


def test_a_count_that_is_off_is_called_not_reproduced() -> None:
    case = Case(GB, "geometric", 10, {"gain": 12.0})
    off = Simulation((run(case),), (), (), ())
    assert findings.of_steps(off, GB, 10).verdict is Verdict.NOT_REPRODUCED


def test_a_folder_that_cannot_be_made_is_explained(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    answer = CliRunner().invoke(app, ["reproduce", "--out", str(tmp_path / "file" / "report")])
    assert answer.exit_code == 1
    assert "cannot be written" in " ".join(answer.stderr.split())
