"""A catalogue that is broken, deleted or exchanged: what is there now counts, and nothing is lost without a word."""

from __future__ import annotations

import multiprocessing
import os
import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from catalogue_bench import add_to, record, schema

from server.catalogue.catalogue import Catalogue
from server.catalogue.errors import CatalogueError
from server.catalogue.opening import NAME


def rubbish(path: Path) -> None:
    path.write_bytes(os.urandom(20_000))


def torn_in_the_middle(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[5000:20000] = os.urandom(15_000)
    path.write_bytes(content)


def another_program_s(path: Path) -> None:
    path.unlink()
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("CREATE TABLE bookmarks (url TEXT)")


@pytest.mark.parametrize("breaking", [rubbish, torn_in_the_middle, another_program_s])
def test_a_broken_catalogue_is_put_aside_and_a_new_one_made(tmp_path: Path, breaking) -> None:
    first = Catalogue.open(tmp_path)
    for index in range(30):
        first.add(record(index))
    first.close()
    breaking(tmp_path / NAME)
    broken = schema(tmp_path / NAME) if breaking is another_program_s else (tmp_path / NAME).read_bytes()
    anew = Catalogue.open(tmp_path)
    assert (anew.is_new, anew.page().total) == (True, 0)
    assert anew.put_aside is not None
    assert anew.put_aside.name.startswith(f"{NAME}.broken-")
    kept = anew.put_aside
    assert broken == (schema(kept) if breaking is another_program_s else kept.read_bytes())
    anew.close()


@pytest.mark.parametrize("cut", [0, 1, 100, 4096, 10_000])
def test_a_cut_catalogue_never_ends_the_program(tmp_path: Path, cut: int) -> None:
    first = Catalogue.open(tmp_path)
    first.add(record(1))
    first.close()
    os.truncate(tmp_path / NAME, cut)
    anew = Catalogue.open(tmp_path)
    assert (anew.is_new, anew.page().total) == (True, 0)
    anew.close()


def test_several_programs_that_find_it_broken_put_it_aside_once(tmp_path: Path, full: bool) -> None:
    context = multiprocessing.get_context("fork")
    for attempt in range(25 if full else 4):
        data, together, answers = tmp_path / str(attempt), context.Barrier(4), context.SimpleQueue()
        data.mkdir()
        (data / NAME).write_bytes(b"no database" * 2000)
        programs = [
            context.Process(target=add_to, args=(data, index, together, answers)) for index in range(4)
        ]
        for program in programs:
            program.start()
        for program in programs:
            program.join()
        assert [program.exitcode for program in programs] == [0] * 4
        answers.close()
        (kept,) = data.glob(f"{NAME}.broken-*")
        assert kept.read_bytes() == b"no database" * 2000
        catalogue = Catalogue.open(data)
        assert catalogue.page().total == 4
        catalogue.close()


def test_a_catalogue_that_is_deleted_under_a_program_is_made_anew(tmp_path: Path) -> None:
    catalogue = Catalogue.open(tmp_path)
    catalogue.add(record(1))
    for end in ("", "-wal", "-shm"):
        (tmp_path / f"{NAME}{end}").unlink(missing_ok=True)
    assert (catalogue.page().total, catalogue.exchanges, catalogue.is_new) == (0, 1, True)
    catalogue.add(record(2))
    other = Catalogue.open(tmp_path)
    assert [run.id for run in other.page().runs] == [record(2).id]
    assert catalogue.gone([record(1).id]) == set()  # lost with the file, which is not deleted
    other.close()
    catalogue.close()


def test_a_catalogue_that_is_exchanged_under_a_program_is_the_one_that_counts(tmp_path: Path) -> None:
    kept = Catalogue.open(tmp_path / "kept")
    kept.add(record(5))
    kept.close()
    catalogue = Catalogue.open(tmp_path)
    catalogue.add(record(1))
    for end in ("-wal", "-shm"):
        (tmp_path / f"{NAME}{end}").unlink(missing_ok=True)
    os.replace(tmp_path / "kept" / NAME, tmp_path / NAME)
    assert [run.id for run in catalogue.page().runs] == [record(5).id]
    catalogue.close()


def test_a_data_folder_that_goes_is_not_made_anew_in_its_place(tmp_path: Path) -> None:
    data = tmp_path / "disk" / "data"
    catalogue = Catalogue.open(data)
    shutil.rmtree(tmp_path / "disk")
    for ask in (catalogue.page, lambda: catalogue.add(record(1))):
        with pytest.raises(CatalogueError, match=r"the data folder .* is gone"):
            ask()
    assert not (tmp_path / "disk").exists()
    catalogue.close()
