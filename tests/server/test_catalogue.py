"""The catalogue finds what was put into it, in order, a page at a time, for several threads at once."""

from __future__ import annotations

import base64
import random
import threading
from collections.abc import Iterator
from dataclasses import replace
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest
from catalogue_bench import BEGINNING, TAGS, many, record
from hypothesis import given, settings
from hypothesis import strategies as st

from server.catalogue.catalogue import Catalogue
from server.catalogue.errors import BadCursor, CatalogueError, NoSuchRun
from server.catalogue.queries import cursor_of
from server.catalogue.records import RunQuery, RunRecord
from server.catalogue.searching import matches

RUNS = 60


@pytest.fixture
def catalogue(tmp_path: Path) -> Iterator[Catalogue]:
    opened = Catalogue.open(tmp_path)
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Catalogue]:
    opened = many(tmp_path_factory.mktemp("data"), RUNS)
    yield opened
    opened.close()


ALL = [replace(record(index), label=f"{record(index).label}.{index}") for index in reversed(range(RUNS))]
"""What is in `filled`, newest first."""


def ids(runs: tuple[RunRecord, ...] | list[RunRecord]) -> list[str]:
    return [run.id for run in runs]


def everything(catalogue: Catalogue, query: RunQuery, limit: int) -> list[RunRecord]:
    found, cursor = [], None
    while True:
        page = catalogue.page(query, cursor, limit)
        found += page.runs
        cursor = page.next
        if cursor is None:
            assert page.total == len(found)
            return found


def test_a_run_comes_back_as_it_was_put_in(catalogue: Catalogue) -> None:
    made = record(3, settings={"rig": {"name": "Größe"}, "seed": 1}, duration_s=0.1 + 0.2)
    catalogue.add(made)
    assert catalogue.get(made.id) == made
    [listed] = catalogue.page().runs
    assert listed == replace(made, settings={})


def test_a_run_is_added_only_once(catalogue: Catalogue) -> None:
    catalogue.add(record(1))
    with pytest.raises(CatalogueError, match="there is a run '20200101-081100-0001' already"):
        catalogue.add(record(1, label="another"))
    assert catalogue.get(record(1).id).label == record(1).label


def test_a_run_can_be_put_in_the_place_of_itself(catalogue: Catalogue) -> None:
    for label in ("one", "two"):
        made = record(1, label=label, tags=("a", "b"), settings={"now": label})
        catalogue.renew(made.id, lambda _, made=made: made)
    [run] = catalogue.page().runs
    assert (run.label, run.tags, catalogue.get(run.id).settings) == ("two", ("a", "b"), {"now": "two"})


def test_only_what_is_changed_changes(catalogue: Catalogue) -> None:
    before = record(1, tags=("a", "b", "c"), settings={"seed": 1})
    catalogue.add(before)
    catalogue.update(before.id, tags=("c", "d"), size_bytes=5)
    assert catalogue.get(before.id) == replace(before, tags=("c", "d"), size_bytes=5)


def test_a_run_that_is_not_there_is_named(catalogue: Catalogue) -> None:
    for ask in (catalogue.get, catalogue.delete, lambda id: catalogue.update(id, label="x")):
        with pytest.raises(NoSuchRun, match="There is no run 'nowhere'"):
            ask("nowhere")


def test_a_deleted_run_leaves_nothing_behind(catalogue: Catalogue) -> None:
    catalogue.add(record(1, tags=("a",)))
    catalogue.delete(record(1).id)
    catalogue.add(record(1, tags=()))
    assert catalogue.get(record(1).id).tags == ()


def test_a_hidden_run_is_nowhere_but_known(catalogue: Catalogue) -> None:
    run = record(1, state="finished", recording_state="complete")
    catalogue.add(run)
    catalogue.hide(run.id, lambda _: None)
    assert catalogue.page().runs == ()
    assert (catalogue.page().total, catalogue.totals().runs) == (0, 0)
    assert catalogue.beginning_with("", 5) == []
    assert (catalogue.known([run.id, "other"]), catalogue.hidden()) == ({run.id}, [run.id])
    with pytest.raises(NoSuchRun):
        catalogue.get(run.id)


def test_runs_are_listed_newest_first(filled: Catalogue) -> None:
    assert list(filled.page(limit=RUNS).runs) == [
        replace(run, ended_at=found.ended_at)
        for run, found in zip(ALL, filled.page(limit=RUNS).runs, strict=True)
    ]


@pytest.mark.parametrize("limit", [1, 7, RUNS - 1, RUNS, RUNS + 1])
def test_pages_put_together_are_the_whole_list(filled: Catalogue, limit: int) -> None:
    assert ids(everything(filled, RunQuery(), limit)) == ids(ALL)


def test_runs_that_began_at_once_are_all_listed(catalogue: Catalogue) -> None:
    for index in range(9):
        catalogue.add(record(index, started_at=BEGINNING))
    found = everything(catalogue, RunQuery(), 2)
    assert ids(found) == sorted(ids(found), reverse=True)
    assert len(found) == 9


QUERIES = st.builds(
    RunQuery,
    state=st.sampled_from(["", "finished", "aborted", "nothing"]),
    controller=st.sampled_from(["", "geometric", "planner"]),
    tag=st.sampled_from(["", "paper", "PAPER", "pap", "demo"]),
    text=st.sampled_from(["", "magnet", "GRÖSSE", "#paper", "new plate", "_", "%", "oil 20200", "\\"]),
    simulated=st.sampled_from([None, True, False]),
    pinned=st.sampled_from([None, True, False]),
    since=st.sampled_from([None, BEGINNING + timedelta(hours=3)]),
    until=st.sampled_from([None, BEGINNING + timedelta(hours=9)]),
)


@settings(max_examples=60, deadline=None)
@given(query=QUERIES)
def test_every_filter_finds_what_a_look_at_each_run_finds(filled: Catalogue, query: RunQuery) -> None:
    assert ids(everything(filled, query, 13)) == ids([run for run in ALL if matches(query, run)])


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("süsses", True),
        ("SÜSSES wasser", True),
        ("100%", True),
        ("1000", False),
        ("a_b", True),
        ("axb", False),
    ],
)
def test_free_text_knows_no_case_and_no_wildcards(catalogue: Catalogue, text: str, found: bool) -> None:
    catalogue.add(record(1, label="Süßes   Wasser", notes="100% a_b", tags=()))
    assert bool(catalogue.page(RunQuery(text=text)).runs) is found


def test_a_tag_is_found_whole_and_never_in_another_text(catalogue: Catalogue) -> None:
    catalogue.add(record(1, label="#oil", notes="x\n#oil\ny", tags=("oily",)))
    assert catalogue.page(RunQuery(tag="oil")).total == 0
    catalogue.update(record(1).id, tags=("Oil",))
    assert catalogue.page(RunQuery(tag="oil")).total == 1


@pytest.mark.parametrize("cursor", ["", "x", "WzFd", "é", "bnVsbA", "A" * 300, cursor_of.__name__])
def test_a_cursor_of_nowhere_is_refused_in_words(filled: Catalogue, cursor: str) -> None:
    with pytest.raises(BadCursor, match="begin again without one"):
        filled.page(cursor=cursor)


@pytest.mark.parametrize(
    "content",
    [
        '["2020-01-01T00:00:00+00:00", "x", Infinity]',
        '["2020-01-01T00:00:00+00:00", "x", 1e400]',
        '["2020-01-01T00:00:00+00:00", "\\ud800", 3]',
        '["0001-01-01T00:00:00+23:59", "x", 3]',
        '["9999-12-31T23:59:59-23:00", "x", 3]',
        '["2020-01-01T00:00:00", "x", 3]',
    ],
)
def test_a_cursor_that_somebody_has_changed_is_refused_in_words(filled: Catalogue, content: str) -> None:
    with pytest.raises(BadCursor, match="begin again without one"):
        filled.page(cursor=base64.urlsafe_b64encode(content.encode()).decode())


def test_times_beyond_the_calendar_are_before_or_after_all_runs(filled: Catalogue) -> None:
    first = datetime(1, 1, 1, tzinfo=timezone(timedelta(hours=10)))
    last = datetime(9999, 12, 31, 23, tzinfo=timezone(timedelta(hours=-10)))
    assert filled.page(RunQuery(since=first, until=last)).total == RUNS
    assert filled.page(RunQuery(until=first)).total == filled.page(RunQuery(since=last)).total == 0


def test_what_is_no_text_is_refused_in_words(filled: Catalogue) -> None:
    for ask in (
        lambda: filled.page(RunQuery(text="\udcff")),
        lambda: filled.page(RunQuery(state="\udcff")),
        lambda: filled.beginning_with("\udcff", 3),
        lambda: filled.update(ALL[0].id, notes="\udcff"),
    ):
        with pytest.raises(CatalogueError, match="is no text; write it anew"):
            ask()


def test_a_nul_hides_neither_what_follows_it_nor_what_is_looked_for(catalogue: Catalogue) -> None:
    catalogue.add(record(1, notes="before\0after", tags=("oil",)))
    found = [
        catalogue.page(query).total
        for query in (RunQuery(tag="oil"), RunQuery(text="after"), RunQuery(text="\0nothing"))
    ]
    assert found == [1, 1, 0]
    assert catalogue.get(record(1).id).notes == "before\0after"


def test_any_number_of_runs_can_be_asked_for(filled: Catalogue) -> None:
    assert filled.known([str(number) for number in range(300_000)] + ids(ALL)) == set(ids(ALL))


def test_it_is_known_which_of_the_own_runs_somebody_has_deleted(tmp_path: Path, catalogue: Catalogue) -> None:
    for index in range(3):
        catalogue.add(record(index))
    other = Catalogue.open(tmp_path)
    other.delete(record(1).id)
    other.close()
    asked = [record(index).id for index in range(5)]
    assert catalogue.gone(asked) == {record(1).id}


def test_totals_are_those_of_all_runs(filled: Catalogue) -> None:
    totals = filled.totals()
    assert totals.runs == RUNS
    assert totals.size == sum(run.size_bytes for run in ALL)
    assert totals.pinned_size == sum(run.size_bytes for run in ALL if run.pinned)


def test_ids_are_found_by_how_they_begin(filled: Catalogue) -> None:
    newest = ALL[0].id
    assert filled.beginning_with("", 2) == ids(ALL[:2])
    assert filled.beginning_with(newest[:-1], 9) == [newest]
    assert filled.beginning_with("2020%", 9) == []


def test_several_threads_write_without_losing_anything(tmp_path: Path) -> None:
    catalogue, other = Catalogue.open(tmp_path), Catalogue.open(tmp_path)

    def work(index: int) -> None:
        mine = (catalogue, other)[index % 2]
        mine.add(record(index, tags=()))
        for _ in range(5):
            mine.update(record(index).id, tags=tuple(random.sample(TAGS, 2)), notes=f"by {index}")

    threads = [threading.Thread(target=work, args=(index,)) for index in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    found = catalogue.page().runs
    assert [(run.notes, len(run.tags)) for run in found] == [
        (f"by {index}", 2) for index in reversed(range(8))
    ]
    catalogue.close()
    other.close()
