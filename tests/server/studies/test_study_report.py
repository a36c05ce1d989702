"""The report of a study: it stands alone, says what the data say, and is made of whatever table there is."""

import csv
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.container import ErrorbarContainer

from control.studies.analysis.samples import samples
from control.studies.analysis.whole import analyse
from control.studies.batch import plain_walk
from control.studies.definition import StudyDefinition
from control.studies.table import StudyRow, StudyTable
from control.studies.tuning.answer import Answer, Interval
from server.reports.study.layout import Layout
from server.reports.study.lines import lines
from server.reports.study.plot import plot_png
from server.reports.study.printed import PRINTED
from server.reports.study.report import write_report
from server.reports.study.walks import Recorded, WalkedAgain
from server.reports.study.words import of_search, sentences, unfinished
from tests.control.studies.planted import planted_table
from tests.server.recorded_walk import record_walk

TILT, SWEEP, STEP = "gait.tilt_deg", "gait.sweep_deg", "gait.path_step_s"
LENGTH = 0.010
PNG = b"\x89PNG"


def defined(name: str, **more: Any) -> StudyDefinition:
    return StudyDefinition.from_json({"name": name, "duration_s": 2.0, **more})


def over(*axes: tuple[str, list[Any]], repeats: int = 4, **more: Any) -> StudyDefinition:
    return defined(
        "A < B & C", repeats=repeats, axes=[{"of": name, "values": values} for name, values in axes], **more
    )


def bowl(values: Any, rng: np.random.Generator) -> float | None:
    if rng.random() < 0.02:
        return None
    return (
        0.2
        + values.get(STEP, 0.1)
        + 0.001 * (values.get(TILT, 25) - 24.0) ** 2
        + 0.02 * float(rng.weibull(2.0))
    )


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a study with the paper's axes, a controller more, and enough runs for distributions."""
    definition = over(
        ("controller", ["geometric", "gradient"]), (SWEEP, [25, 30]), (TILT, [20, 25, 30]), (STEP, [0.1]), repeats=24
    )  # fmt: skip
    return write_report(planted_table(definition, bowl), definition, tmp_path_factory.mktemp("report"))


def rows(path: Path) -> list[dict[str, str]]:
    with path.open() as file:
        return list(csv.DictReader(file))


def test_the_page_of_a_study_stands_alone(report: Path) -> None:
    page = report.read_text()
    assert not re.search(r"""(src|href)=["'](?!data:)""", page)
    assert "http" not in page
    assert "<h1>A &lt; B &amp; C</h1>" in page


def test_each_figure_lies_beside_the_page_as_png_and_svg(report: Path) -> None:
    pictures = sorted(report.parent.glob("*.png"))
    assert report.read_text().count("data:image/png;base64,") == len(pictures)
    assert {path.stem for path in pictures} >= {
        "distributions",
        "paths",
        "lines-tilt-controller",
        "heat-tilt-sweep",
    }
    for path in pictures:
        assert path.read_bytes().startswith(PNG)
        assert "<svg" in path.with_suffix(".svg").read_text()


def test_the_definition_and_every_run_lie_beside_the_page(report: Path) -> None:
    definition = StudyDefinition.from_toml((report.parent / "study.toml").read_text())
    assert len(rows(report.parent / "runs.csv")) == definition.plan().total
    assert {row["seed"] for row in rows(report.parent / "runs.csv")} == {
        str(definition.plan().run(index).seed) for index in range(definition.plan().total)
    }
    assert len(rows(report.parent / "sets.csv")) == 12


def test_the_paper_s_table_stands_beside_ours_with_its_inconsistent_rows_marked(report: Path) -> None:
    found = {row["set"]: row for row in rows(report.parent / "scatters.csv")}
    ours = {name: row["of the paper's row"] for name, row in found.items() if row["paper's variance"]}
    assert len(ours) == len(PRINTED)
    wrong = {name for name, note in ours.items() if note.startswith("inconsistent")}
    assert len(wrong) == 2
    assert any("gradient" in name and "sweep 25°, tilt 25°" in name for name in wrong)
    assert any("geometric" in name and "sweep 30°, tilt 30°" in name for name in wrong)


def test_what_was_planted_is_said_first_with_its_interval(report: Path) -> None:
    definition = StudyDefinition.from_toml((report.parent / "study.toml").read_text())
    table = planted_table(definition, bowl)
    found = analyse(table.rows, table.axes)
    said = "\n".join(sentences(found, table))
    assert re.search(r"Over tilt 20° to 30° .*: ME is smallest at 2[34]\.\d+° \(2\d.* to 2\d", said)
    assert f"{found.failed} failed" in said
    assert "it cannot be told" in said


def told(definition: StudyDefinition, error: Callable[..., float | None]) -> str:
    table = planted_table(definition, error)
    return "\n".join(sentences(analyse(table.rows, table.axes), table))


def test_shares_near_the_whole_are_written_as_people_write_them() -> None:
    said = told(over((TILT, [20, 25, 30])), lambda v, rng: v[TILT] + 0.01 * float(rng.random()))
    assert "tilt 100 % (100 % to 100 %)" in said


def test_a_best_set_that_lost_runs_is_said_to_have() -> None:
    definition = over((TILT, [20, 30]), repeats=6)

    def error(values: Any, rng: np.random.Generator) -> float | None:
        return (
            None if values[TILT] == 20 and rng.random() < 0.5 else 0.01 * values[TILT] + 0.001 * rng.random()
        )

    assert re.search(r"smallest at tilt 20°.* But [1-5] of its 6 runs failed", told(definition, error))


def test_without_scatter_or_repeats_words_say_so() -> None:
    tilts = (TILT, [20, 25, 30])
    assert "runs of the same set do not differ" in told(over(tilts), lambda v, _: abs(v[TILT] - 24) + 1.0)
    assert "cannot be tested without repeats" in told(over(tilts, repeats=1), lambda v, _: 0.01 * v[TILT])


def test_a_study_that_is_not_over_is_said_not_to_be() -> None:
    definition = over((TILT, [20, 25, 30]))
    table = planted_table(definition, bowl)
    part = StudyTable(table.axes, list(table.rows)[:5])
    assert not list(unfinished(table, definition))
    assert "5 of at most 12 runs" in "".join(unfinished(part, definition))


def test_a_line_has_the_same_colour_in_every_panel() -> None:
    """The first panel lacks the first sweep."""
    definition = over((TILT, [20, 25, 30]), (SWEEP, [20, 30]), (STEP, [0.1, 0.2]))
    table = planted_table(definition, lambda _, rng: 0.2 + 0.01 * float(rng.random()))
    kept = [row for row in table.rows if (row.values[SWEEP], row.values[STEP]) != (20, 0.1)]
    found = samples(kept, table.axes)
    figure = lines(found, Layout(TILT, SWEEP, STEP, ()))
    colours = [
        {
            name: tuple(handle.lines[0].get_color())
            for handle, name in zip(*axes.get_legend_handles_labels(), strict=True)
            if isinstance(handle, ErrorbarContainer)
        }
        for axes in figure.axes[:2]
    ]
    assert colours[0]["30°"] == colours[1]["30°"] != colours[1]["20°"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["20°", "30°"]


def test_a_run_walked_once_more_for_its_picture_is_the_run_of_the_table() -> None:
    definition = over((TILT, [25]), repeats=1)
    run = definition.plan().run(0)
    row = StudyRow.finished(run, plain_walk(run))
    walk = WalkedAgain(definition)(row, "tilt 25°")
    assert walk is not None
    error = np.hypot(*(walk.centre - walk.reference).T)
    assert error.mean() / LENGTH == pytest.approx(row.metric("normalized_mean_error"), rel=0.02)


def test_a_rig_s_path_comes_from_its_recording_and_a_lost_one_is_left_out(tmp_path: Path) -> None:
    walked = record_walk(tmp_path, "a-walk", 1.5)
    row = StudyRow(0, 0, 0, 1, "finished", {}, {"normalized_mean_error": 0.2}, run_id="a-walk")
    source = Recorded(walked.path.parent)
    walk = source(row, "one")
    assert walk is not None
    assert np.hypot(*(walk.centre[0] - walk.reference[0])) < LENGTH
    assert len(walk.centre) == len(walk.reference) > 60
    assert source(replace(row, run_id="lost"), "one") is None


def nothing(_values: Any, _rng: np.random.Generator) -> None:
    return None


def not_a_number(_values: Any, _rng: np.random.Generator) -> float:
    return float("nan")


def always_the_same(_values: Any, _rng: np.random.Generator) -> float:
    return 0.3


ODD: dict[str, tuple[StudyDefinition, Callable[..., float | None]]] = {
    "one run": (defined("one"), always_the_same),
    "one set, all alike": (defined("alike", repeats=30), always_the_same),
    "all failed": (over((TILT, [20, 25])), nothing),
    "no number": (over((TILT, [20, 25, 30])), not_a_number),
    "words alone": (over(("controller", ["geometric", "gradient"]), repeats=1), bowl),
    "five axes": (
        over(
            ("controller", ["geometric", "gradient"]), ("plant", ["slip", "noslip"]), (TILT, [20, 25]),
            (SWEEP, [25, 30]), (STEP, [0.1, 0.2]), repeats=2,
        ),
        bowl,
    ),
    "scattered": (
        defined("cube", design="latin", latin={"sets": 25}, axes=[
            {"of": "controller", "values": ["geometric", "gradient"]}, {"of": TILT, "from": 10, "to": 35},
        ]),
        bowl,
    ),
    "a list with gaps": (
        defined("list", design="list", repeats=2, sets=[{TILT: 20}, {SWEEP: 30}, {TILT: 25, SWEEP: 20}]), bowl
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ODD)
def test_a_report_is_made_of_every_odd_table(name: str, tmp_path: Path) -> None:
    definition, errors = ODD[name]

    def error(values: Any, rng: np.random.Generator) -> float | None:
        return errors({axis: value for axis, value in values.items() if value is not None}, rng)

    table = planted_table(definition, error)
    page = write_report(table, definition, tmp_path / "new" / "folder").read_text()
    assert not re.search(r"\bnan\b", re.sub(r"data:image/png;base64,[^\"]*", "", page))
    assert "What was found" in page
    assert "None" not in page[page.index("What was found") :]


def test_the_answer_of_a_search_is_said_first(tmp_path: Path) -> None:
    definition = defined(
        "search", design="tune", tune={"budget": 14, "first": 6, "at_once": 4, "confirm": 2},
        axes=[{"of": TILT, "from": 10, "to": 35}, {"of": SWEEP, "from": 15, "to": 40}],
    )  # fmt: skip
    page = (
        write_report(planted_table(definition, bowl), definition, tmp_path).read_text().replace("&#x27;", "'")
    )
    found = page[page.index("What was found") :]
    assert re.search(r"<li>The search's answer is tilt .*, sweep .*: .* measured in [12] runs?", found)
    assert (tmp_path / "surface.png").read_bytes().startswith(PNG)


@pytest.mark.parametrize(("left", "said"), [(2, "are still to come"), (0, "no finished run confirms it")])
def test_an_answer_that_nothing_confirms_says_whether_that_will_come(left: int, said: str) -> None:
    found = Answer({TILT: 25}, "normalized_mean_error", Interval(0.3, 0.2, 0.4), None, runs=0, left=left)
    assert said in of_search(found)


def test_a_study_without_a_single_row_has_a_picture_that_says_so() -> None:
    definition = over((TILT, [20, 25]))
    assert plot_png(StudyTable(definition.axis_names, []), definition).startswith(PNG)


def test_the_figure_of_a_study_fits_its_axes() -> None:
    axes = [(TILT, [20, 25, 30]), (SWEEP, [25, 30]), (STEP, [0.1, 0.2])]
    pictures = []
    for count in (1, 2, 3):
        definition = over(*axes[:count])
        table = planted_table(definition, bowl)
        pictures.append(plot_png(table, definition))
        if count == 1:
            assert plot_png(table, definition) == pictures[0]
    assert len(set(pictures)) == 3
    assert all(picture.startswith(PNG) for picture in pictures)
