"""Rows keep every bit, and a table is the same however its rows came about."""

from __future__ import annotations

import csv
import io
import json
import math
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from control.metrics import Metrics
from control.studies.definition import StudyDefinition
from control.studies.errors import StudyError
from control.studies.table import METRICS, StudyRow, StudyTable, figures

numbers = st.floats(allow_nan=False) | st.integers(-(2**53), 2**53)
rows = st.builds(
    StudyRow,
    index=st.integers(0, 10**6),
    set=st.integers(0, 100),
    repeat=st.integers(0, 100),
    seed=st.integers(0, 2**53 - 1),
    state=st.sampled_from(["finished", "failed"]),
    values=st.dictionaries(st.sampled_from(["gait.tilt_deg", "controller"]), numbers | st.text(max_size=5)),
    metrics=st.dictionaries(st.sampled_from(list(METRICS)), numbers),
    reason=st.text(max_size=20),
    run_id=st.text(max_size=8),
    attempts=st.integers(1, 9),
)


@given(rows)
@settings(max_examples=60)
def test_a_row_comes_back_from_a_line_of_json_as_it_was(row):
    assert StudyRow.from_json(json.loads(json.dumps(row.to_json()))) == row


@pytest.mark.parametrize(
    "change",
    [
        {"state": "running"},
        {"index": "1"},
        {"index": True},
        {"metrics": None},
        {"reason": 3},
        {"surprise": 1},
    ],
)
def test_what_is_no_row_is_refused_in_words(change):
    good = StudyRow(0, 0, 0, 1, "finished", {"gait.tilt_deg": 20}).to_json()
    with pytest.raises(StudyError, match="this is no row"):
        StudyRow.from_json({**good, **change})


METRIC = Metrics(
    0.0012345678901234567, 0.12345678901234568, 0.002, 0.003, 0.0005, 0.4, 125.66, 7540, 70, 150, 80
)


def planned(repeats=3):
    raw = {"name": "a", "repeats": repeats, "axes": [{"of": "gait.tilt_deg", "values": [20, 25.5]}]}
    plan = StudyDefinition.from_json(raw).plan()
    return plan.axes, [plan.run(index) for index in range(plan.total)]


def table(shuffle=0):
    axes, runs = planned()
    made = [StudyRow.finished(run, METRIC) for run in runs[:-1]]
    made.append(StudyRow.failed(runs[-1], 'the robot, it "fell"\nover'))
    random.Random(shuffle).shuffle(made)
    return StudyTable(axes, made)


def test_a_table_is_the_same_bytes_in_whatever_order_its_rows_come():
    assert table(1).csv() == table(2).csv() == table(3).csv()


def test_a_csv_table_keeps_every_digit_and_every_reason():
    lines = list(csv.DictReader(io.StringIO(table().csv().decode())))
    assert [int(line["index"]) for line in lines] == list(range(6))
    assert float(lines[0]["mean_error_mm"]) == METRIC.mean_error * 1e3
    assert lines[0]["gait.tilt_deg"] == "20"
    assert lines[1]["gait.tilt_deg"] == "25.5"
    assert (lines[-1]["state"], lines[-1]["mean_error_mm"]) == ("failed", "")
    assert lines[-1]["reason"] == 'the robot, it "fell"\nover'


def test_columns_are_numbers_and_failed_runs_are_nan():
    one = table()
    assert one.column("gait.tilt_deg").tolist() == [20.0, 25.5] * 3
    errors = one.column("normalized_mean_error")
    assert math.isnan(errors[-1])
    assert np.all(errors[:-1] == METRIC.normalized_mean_error)
    assert one.column("state")[-1] == "failed"
    assert one.column("repeat").tolist() == [0, 0, 1, 1, 2, 2]
    with pytest.raises(KeyError, match=r"there is no column 'tilt'"):
        one.column("tilt")


def test_names_are_a_column_of_objects():
    rows = [StudyRow(k, k, 0, k, "failed", {"controller": name}) for k, name in enumerate(["planner", None])]
    assert StudyTable(("controller",), rows).column("controller").tolist() == ["planner", None]


def test_runs_are_grouped_by_set_and_failed_ones_are_counted_not_averaged():
    first, second = table().by_set()
    assert (first.set, first.failed, len(first.column("mean_error_mm"))) == (0, 0, 3)
    assert (second.set, second.failed, len(second.column("mean_error_mm"))) == (1, 1, 2)
    assert second.values == {"gait.tilt_deg": 25.5}


def test_the_figures_of_a_run_are_those_of_the_table():
    assert list(figures(METRIC)) == list(METRICS)
