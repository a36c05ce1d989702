"""Whoever does the work, and however it is cut up, the results are the same, in the same order."""

import dataclasses
import gc
import os
import sys
import tracemalloc

import pytest

from control import plugins
from control.controllers import controllers
from control.studies import crews, dask_crew
from control.studies.arithmetic import ABSENT, SOURCES, ground, text_of
from control.studies.batch import simulate
from control.studies.chunks import PluginFile, WorkersLost, chunk_of, work
from control.studies.definition import StudyDefinition
from control.studies.workers import CHUNK, MOST, Failed, Pace, carry_out, hired


def runs(repeats, **changes):
    """Of half a second of rig time each; by a controller whose walks are plain Python: nothing has to be compiled."""
    whole = {
        "name": "workers",
        "repeats": repeats,
        "duration_s": 0.5,
        "controller": {"name": "straight"},
        "axes": [{"of": "gait.tilt_deg", "values": [20, 25, 30]}],
    }
    plan = StudyDefinition.from_json({**whole, **changes}).plan()
    return [plan.run(index) for index in plan.next({})]


def test_results_come_in_the_order_of_the_runs_and_are_those_of_each_run_alone():
    wanted = runs(4)
    expected = [(run.index, simulate([run])[0]) for run in wanted]
    assert list(carry_out(wanted, jobs=1)) == expected
    assert list(carry_out(wanted, jobs=2)) == expected


def test_runs_are_taken_as_they_are_needed_and_no_faster():
    taken = []
    endless = (taken.append(run.index) or run for run in runs(2000))
    with hired(1) as workers:
        results = workers.carry_out(endless)
        for _ in range(5):
            next(results)
    assert len(taken) <= 5 + 2 * MOST


KEPT = 30_000
"""Bytes, whatever the number of runs; one that was kept would be a thousand."""
GARBAGE = 1_000_000
"""Bytes that Python has not given back yet, whatever the number of runs."""


def test_memory_does_not_grow_with_the_number_of_runs(full):
    few, many = (200, 2000) if full else (50, 500)
    [run] = runs(1, axes=[])

    def memory(number):
        several = (dataclasses.replace(run, index=index, duration=0.02) for index in range(number))
        for _ in carry_out(several, jobs=1):
            pass
        gc.collect()
        return tracemalloc.get_traced_memory()

    memory(3)
    tracemalloc.start()
    kept_of_few, _ = memory(few)
    kept_of_many, peak = memory(many)
    tracemalloc.stop()
    assert kept_of_many < kept_of_few + KEPT
    assert peak < GARBAGE


def test_a_chunk_is_as_many_runs_as_take_some_tenths_of_a_second():
    pace, quick = Pace(), runs(40)
    assert len(pace.take(iter(quick))) == 1, "nothing is known of such runs yet"
    pace.note(quick[0], CHUNK / 10)
    assert len(pace.take(iter(quick))) == pytest.approx(10, abs=1)
    for _ in range(50):
        pace.note(quick[0], 0.0)
    assert len(pace.take(iter(quick))) == MOST
    assert pace.take(iter(())) == ()


def test_a_run_that_raises_is_a_failed_one_and_the_others_go_on():
    wanted = runs(2)
    wanted[2] = dataclasses.replace(
        wanted[2],
        selection=dataclasses.replace(
            wanted[2].selection, controller=dataclasses.replace(wanted[2].selection.controller, name="nobody")
        ),
    )
    outcomes = dict(carry_out(wanted, jobs=1))
    failed = {index: outcome for index, outcome in outcomes.items() if isinstance(outcome, Failed)}
    assert list(failed) == [wanted[2].index]
    assert "nobody" in failed[wanted[2].index].reason
    assert len(outcomes) == 6


def test_a_worker_that_would_round_differently_is_refused_by_name():
    chunk = chunk_of(tuple(runs(1)))
    versions = (*chunk.ground.versions[:-1], ("numba", "0.1"))
    for stranger in (
        dataclasses.replace(chunk.ground, versions=versions),
        dataclasses.replace(chunk.ground, rounding="otherwise"),
    ):
        with pytest.raises(WorkersLost, match=r"not like this program \((numba is .* here|its processor)"):
            work(dataclasses.replace(chunk, ground=stranger))
    assert ground().differences(ground()) == []
    assert f"x is {ABSENT} there and 1 here" in dataclasses.replace(
        ground(), versions=(("x", "1"),)
    ).differences(ground())


def test_a_worker_whose_sources_were_edited_since_is_another_one(tmp_path):
    assert ("pivotrig's source text", text_of(SOURCES)) in ground().versions
    law = tmp_path / "controllers" / "law.py"
    law.parent.mkdir()
    law.write_text("GAIN = 3.0")
    before = text_of(tmp_path)
    law.write_text("GAIN = 4.0")
    assert text_of(tmp_path) != before


def test_a_plug_in_that_a_worker_does_not_have_is_named(tmp_path):
    chunk = dataclasses.replace(
        chunk_of(tuple(runs(1))), plugins=(PluginFile(str(tmp_path / "mine.py"), ""),)
    )
    with pytest.raises(WorkersLost, match=r"cannot use a plug-in: there is no plug-in file .*mine.py"):
        work(chunk)


def test_a_worker_that_has_an_older_text_of_a_plug_in_is_refused(tmp_path):
    mine = tmp_path / "deadly.py"
    mine.write_text(DEADLY)
    plugins.load_file(mine)
    try:
        chunk = chunk_of(tuple(runs(1)))
        assert [plugin.path for plugin in chunk.plugins] == [str(mine)]
        work(chunk)
        edited = dataclasses.replace(chunk.plugins[0], text=chunk.plugins[0].text[::-1])
        with pytest.raises(WorkersLost, match=r"another text of the plug-in .*deadly.py .*start it again"):
            work(dataclasses.replace(chunk, plugins=(edited,)))
    finally:
        controllers.forget("deadly")


def test_a_worker_that_dies_is_told_in_words(tmp_path):
    mine = tmp_path / "deadly.py"
    mine.write_text(DEADLY)
    plugins.load_file(mine)
    try:
        with pytest.raises(WorkersLost, match=r"a worker process ended by itself; .*--jobs"):
            list(carry_out(runs(1, controller={"name": "deadly"}, axes=[]), jobs=2))
    finally:
        controllers.forget("deadly")


DEADLY = '''
"""A controller that ends its process."""
import os
from control.controllers import controllers
from control.controllers.geometric import Geometric


@controllers.register
class Deadly(Geometric):
    name = "deadly"
    title = "Deadly"
    summary = "Ends its process."

    def step(self, *args, **kwargs):
        os._exit(9)
'''
"""As memory that ran out, or a mistake in a library, would end it."""


@pytest.mark.leaves_threads  # a Dask client that finds nobody does not end its own
def test_a_scheduler_that_is_not_there_is_told_in_words(monkeypatch):
    monkeypatch.setattr(dask_crew, "CONNECTING", 0.5)
    for address in ("tcp://127.0.0.1:9", "nonsense://x", "tcp://"):
        with pytest.raises(WorkersLost, match=r"no Dask scheduler answers at .*: .*; start one with"):
            next(carry_out(runs(1), dask=address))


def test_without_dask_its_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(WorkersLost, match=r"extra `cluster`.*uv sync --extra cluster"):
        next(carry_out(runs(1), dask="tcp://127.0.0.1:8786"))


def test_there_are_as_many_workers_as_cores_unless_asked_otherwise():
    assert crews.cores() == len(os.sched_getaffinity(0))
    with hired(1) as workers:
        assert list(workers.carry_out([])) == []
