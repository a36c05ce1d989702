"""The catalogue's file: made, brought up to date, put aside, and what it says where a disk does not let it."""

from __future__ import annotations

import multiprocessing
import os
import resource
import shutil
import signal
import sqlite3
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from catalogue_bench import add_to, record, schema
from sqlalchemy import create_engine

from server.catalogue.catalogue import Catalogue
from server.catalogue.errors import CatalogueError
from server.catalogue.migrations import upgrade as upgrading
from server.catalogue.migrations.upgrade import configuration, upgrade
from server.catalogue.opening import NAME
from server.catalogue.tables import REVISIONS, VERSION, Base


def migrated(path: Path) -> None:
    engine = create_engine(f"sqlite:///{path}")
    with engine.begin() as connection:
        upgrade(connection)
    engine.dispose()


def test_all_migrations_together_make_the_tables_of_a_new_catalogue(tmp_path: Path) -> None:
    migrated(tmp_path / "migrated.sqlite")
    Catalogue.open(tmp_path).close()
    assert schema(tmp_path / NAME) == schema(tmp_path / "migrated.sqlite")


def test_the_tables_are_those_that_the_program_declares(tmp_path: Path) -> None:
    migrated(tmp_path / NAME)
    engine = create_engine(f"sqlite:///{tmp_path / NAME}")
    with engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Base.metadata) == []
    engine.dispose()


def test_the_known_layouts_are_the_migrations_there_are() -> None:
    scripts = ScriptDirectory.from_config(configuration())
    assert scripts.get_current_head() == VERSION
    assert tuple(reversed([script.revision for script in scripts.walk_revisions()])) == REVISIONS


def test_opening_again_makes_nothing_anew(tmp_path: Path) -> None:
    first = Catalogue.open(tmp_path)
    first.add(record(1))
    first.close()
    again = Catalogue.open(tmp_path)
    assert (first.is_new, again.is_new, again.page().total) == (True, False, 1)
    again.close()


def test_a_newer_catalogue_is_refused_and_left_alone(tmp_path: Path) -> None:
    Catalogue.open(tmp_path).close()
    with closing(sqlite3.connect(tmp_path / NAME)) as database, database:
        database.execute("UPDATE alembic_version SET version_num = '9999'")
    before = (tmp_path / NAME).read_bytes()
    with pytest.raises(CatalogueError, match=r"written by a newer pivotrig .*'9999'.*update pivotrig"):
        Catalogue.open(tmp_path)
    assert (tmp_path / NAME).read_bytes() == before


def test_several_programs_that_make_a_catalogue_at_once_make_one(tmp_path: Path, full: bool) -> None:
    context = multiprocessing.get_context("fork")
    for attempt in range(25 if full else 3):
        data, together, answers = tmp_path / str(attempt), context.Barrier(6), context.SimpleQueue()
        programs = [
            context.Process(target=add_to, args=(data, index, together, answers)) for index in range(6)
        ]
        for program in programs:
            program.start()
        for program in programs:
            program.join()
        assert [program.exitcode for program in programs] == [0] * 6
        assert sorted(answers.get() for _ in programs) == [False] * 5 + [True]
        answers.close()
        catalogue = Catalogue.open(data)
        assert catalogue.page().total == 6
        catalogue.close()


NEXT_LAYOUT = """
import sqlalchemy as sa
from alembic import op

revision, down_revision = "next", "{before}"

def upgrade():
    with op.batch_alter_table("runs", recreate="always") as runs:
        runs.alter_column("label", type_=sa.Text)
"""


def test_a_migration_that_rebuilds_the_table_of_runs_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """SQLite can change a column only by making the table anew, and empties the old one before it drops it."""
    made = [record(index, tags=("a", "b"), settings={"seed": index}) for index in range(3)]
    catalogue = Catalogue.open(tmp_path / "data")
    for run in made:
        catalogue.add(run)
    catalogue.close()
    migrations = Path(shutil.copytree(upgrading.FOLDER, tmp_path / "migrations"))
    (migrations / "versions" / "next.py").write_text(NEXT_LAYOUT.format(before=VERSION))
    monkeypatch.setattr(upgrading, "FOLDER", migrations)
    monkeypatch.setattr("server.catalogue.opening.REVISIONS", (*REVISIONS, "next"))
    monkeypatch.setattr("server.catalogue.opening.VERSION", "next")
    later = Catalogue.open(tmp_path / "data")
    assert [later.get(run.id) for run in made] == made
    later.close()
    assert dict(schema(tmp_path / "data" / NAME))["alembic_version"]


def test_a_write_waits_for_another_program_and_gives_up_in_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.catalogue.database.BUSY", 0.05)
    catalogue = Catalogue.open(tmp_path)
    with closing(sqlite3.connect(tmp_path / NAME, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(CatalogueError, match="another program has been writing"):
            catalogue.add(record(1))
        assert catalogue.page().total == 0
        other.execute("ROLLBACK")
    catalogue.add(record(1))
    catalogue.close()


def in_a_child(work: Callable[..., str], *arguments: object) -> list[str]:
    """The lines that `work` answers in a process of its own, which has all that this one has loaded."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    with ours, theirs:
        child = context.Process(target=lambda: theirs.send(work(*arguments)))
        child.start()
        answer: str = ours.recv() if ours.poll(30.0) else ""
        child.join()
    assert child.exitcode == 0
    return answer.splitlines()


def looked_at_by_nobody(data: Path) -> str:
    """What somebody finds who has no right to write into the folder."""
    if os.getuid() == 0:
        os.setuid(65534)
    catalogue = Catalogue.open(data)
    found = f"{catalogue.page().total} {catalogue.is_new}\n"
    try:
        catalogue.update(record(1).id, label="x")
    except CatalogueError as error:
        found += str(error)
    catalogue.close()
    return found


@pytest.fixture
def foreign() -> Iterator[Path]:
    """A data folder that everybody may read and nobody else may write to; pytest's own lie where nobody may look."""
    with tempfile.TemporaryDirectory() as parent:
        folder = Path(parent, "data")
        folder.mkdir(mode=0o755)
        Path(parent).chmod(0o755)
        yield folder
        folder.chmod(0o755)


@pytest.mark.parametrize("still_open", [False, True])
def test_a_catalogue_that_may_not_be_written_to_can_be_read(foreign: Path, still_open: bool) -> None:
    catalogue = Catalogue.open(foreign)
    catalogue.add(record(1))
    if not still_open:
        catalogue.close()
    foreign.chmod(0o555)
    first, refused = in_a_child(looked_at_by_nobody, foreign)
    assert first == "1 False"
    assert "cannot be written to; give yourself the right to write to its folder" in refused
    foreign.chmod(0o755)
    catalogue.close()


def test_where_no_catalogue_can_be_made_there_are_no_runs(foreign: Path) -> None:
    foreign.chmod(0o555)
    first, refused = in_a_child(looked_at_by_nobody, foreign)
    assert first == "0 False"
    assert "cannot be written to" in refused
    assert list(foreign.iterdir()) == []


def test_a_data_folder_that_is_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "data").write_text("no folder")
    with pytest.raises(CatalogueError, match=r"the data folder .*data cannot be used"):
        Catalogue.open(tmp_path / "data")


def filled_up(data: Path) -> str:
    catalogue = Catalogue.open(data)
    catalogue.add(record(1))
    largest = (data / f"{NAME}-wal").stat().st_size + 8192
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
    try:
        catalogue.update(record(1).id, notes="x" * 200_000)
    except CatalogueError as error:
        return f"{error}\n{catalogue.get(record(1).id).notes}"
    return ""


def test_a_full_disk_changes_nothing_and_says_so(tmp_path: Path) -> None:
    said, *notes = in_a_child(filled_up, tmp_path)
    assert f"the disk of {tmp_path / NAME} " in said
    again = Catalogue.open(tmp_path)
    assert "\n".join(notes) == again.get(record(1).id).notes == record(1).notes
    again.close()
