"""`pivotrig runs …`: what a person and a script find, change and delete from the command line."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from catalogue_bench import record
from recordings_bench import RecordingsBench, Walk
from typer.testing import CliRunner, Result

from server.catalogue.shelf import OpenShelf, file_of
from server.commands.runs import app
from server.commands.sizes import days, gigabytes, size_text

METRICS = {"mean_error_mm": 1.234567, "duration_s": 125.66}


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A data folder with three runs, the newest with the index 3."""
    shelf = OpenShelf.open(tmp_path)
    shelf.folder.mkdir()
    for index in (1, 2, 3):
        run = record(
            index, label=f"walk {index}", pinned=index == 1, tags=("t",), state="finished", metrics=METRICS
        )
        shelf.catalogue.add(run)
        file_of(shelf.folder, run.id).write_bytes(b"recording")
    shelf.catalogue.update(record(2).id, settings={"rig": {"name": "x"}, "seed": 3}, notes="two\nlines")
    shelf.close()
    return tmp_path


def command(data: Path, *words: str, typed: str = "") -> Result:
    return CliRunner().invoke(app, [*words, "--data", str(data)], input=typed)


def answer(data: Path, *words: str, typed: str = "") -> str:
    result = command(data, *words, typed=typed)
    assert result.exit_code == 0, result.output
    return result.stdout


def refused(data: Path, status: int, *words: str, typed: str = "") -> str:
    result = command(data, *words, typed=typed)
    assert result.exit_code == status, result.output
    return " ".join(result.stderr.split())


def labels(data: Path) -> list[str]:
    return [run["label"] for run in json.loads(answer(data, "list", "--json"))["runs"]]


def test_runs_are_listed_newest_first_a_line_each(data: Path) -> None:
    lines = [line.split("\t") for line in answer(data, "list").splitlines()]
    assert [line[0] for line in lines] == [record(index).id for index in (3, 2, 1)]
    assert [line[2] for line in lines] == ["walk 3", "walk 2", "* walk 1"]
    assert lines[0][3:] == [
        "finished",
        record(3).controller,
        record(3).trajectory,
        "1.23 mm",
        "126 s",
        "20.0 MB",
    ]


@pytest.mark.parametrize(
    ("options", "found"),
    [
        (["--limit", "1"], ["walk 3"]),
        (["--text", "LINES two"], ["walk 2"]),
        (["--pinned"], ["walk 1"]),
        (["--not-pinned", "--tag", "t"], ["walk 3", "walk 2"]),
        (["--state", "aborted"], []),
        (["--since", "2020-01-03"], []),
        (["--until", "2019-12-30"], []),
    ],
)
def test_a_list_is_narrowed_by_options(data: Path, options: list[str], found: list[str]) -> None:
    listing = json.loads(answer(data, "list", "--json", *options))
    assert [run["label"] for run in listing["runs"]] == found
    assert listing["total"] == (3 if "--limit" in options else len(found))


def test_a_run_is_named_by_its_id_a_beginning_of_it_or_last(data: Path) -> None:
    for name, index in ((record(2).id, 2), (record(2).id[:13], 2), ("last", 3)):
        assert json.loads(answer(data, "show", name, "--json"))["id"] == record(index).id


def test_a_name_that_fits_several_runs_or_none_is_refused_with_those_that_it_fits(data: Path) -> None:
    said = refused(data, 2, "show", "2020")
    assert (
        f"several runs begin with '2020': {record(3).id}, {record(2).id}, {record(1).id}; write more" in said
    )
    assert "there is no run whose id begins with 'x%'" in refused(data, 2, "show", "x%")


def test_in_an_empty_folder_there_is_no_last_run(tmp_path: Path) -> None:
    assert "there is no run yet" in refused(tmp_path, 2, "show", "last")


def test_what_is_no_text_or_no_time_is_refused_in_words(data: Path) -> None:
    assert "'\\udcff' is no text" in refused(data, 1, "show", "\udcff")
    assert "'\\udcff' is no text" in refused(data, 1, "list", "--text", "\udcff")
    assert "is no time" in refused(data, 2, "list", "--since", "0001-01-01")


def test_an_id_is_enough_where_others_begin_with_it(data: Path) -> None:
    shelf = OpenShelf.open(data)
    for index in range(10):
        shelf.catalogue.add(record(20 + index, id="walk" + f"-{index}" * bool(index)))
    shelf.close()
    assert json.loads(answer(data, "show", "walk", "--json"))["id"] == "walk"


def test_nobody_takes_a_lost_catalogue_for_there_being_no_runs(data: Path) -> None:
    (data / "catalogue.sqlite").write_bytes(b"no database" * 99)
    told = " ".join(command(data, "list").stderr.split())
    assert "the catalogue of runs was damaged; it is kept as" in told
    assert "there are recordings: `pivotrig runs rebuild` lists them" in told


def test_a_run_is_shown_whole_and_its_settings_when_asked_for(data: Path) -> None:
    plain = command(data, "show", record(2).id)
    assert "metrics.mean_error_mm" in plain.stdout
    assert "two lines" in plain.stdout
    assert "settings: rig, seed; --settings shows them" in plain.stderr
    assert "settings.rig.name" in answer(data, "show", record(2).id, "--settings")


def test_label_notes_tags_and_pin_are_edited(data: Path) -> None:
    words = ["--label", "new", "--notes", "n", "--tag", "a", "--tag", "b", "--untag", "t", "--pin"]
    changed = json.loads(answer(data, "edit", "last", *words, "--json"))
    assert (changed["label"], changed["notes"], changed["tags"], changed["pinned"]) == (
        "new",
        "n",
        ["a", "b"],
        True,
    )
    assert "new  [a, b]" in answer(data, "edit", "last", "--unpin")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "say what is to be changed"),
        (["--label", "x" * 201], "label: String should have at most 200 characters"),
        (["--tag", ""], "tags.1: String should have at least 1 character"),
        (["--label", "\udcff"], "label"),
    ],
)
def test_an_edit_that_makes_no_sense_is_explained(data: Path, words: list[str], said: str) -> None:
    assert said in refused(data, 2, "edit", "last", *words)
    assert "walk 3" in labels(data)


def test_runs_are_deleted_only_by_who_agrees(data: Path) -> None:
    said = refused(data, 1, "delete", record(2).id, "last", typed="n\n")
    assert "Delete 2 runs, 40.0 MB? This cannot be undone. (y/N)" in said
    assert len(labels(data)) == 3
    assert answer(data, "delete", record(2).id, "last", typed="y\n") == "deleted: 2 runs, 40.0 MB\n"
    assert labels(data) == ["walk 1"]
    assert [path.stem for path in (data / "recordings").iterdir()] == [record(1).id]


def test_of_several_runs_none_is_deleted_when_one_may_not_be(data: Path) -> None:
    assert "is pinned; take its pin away first" in refused(data, 1, "delete", record(1).id, "last", "--yes")
    assert len(labels(data)) == 3


def test_old_runs_are_pruned_after_a_look(data: Path) -> None:
    assert answer(data, "prune", "--older-than", "30d", "--dry-run") == "would go: 2 runs, 40.0 MB\n"
    assert json.loads(answer(data, "prune", "--until-size", "45MB", "--dry-run", "--json"))["runs"] == [
        record(2).id
    ]
    assert len(labels(data)) == 3
    assert "nothing was deleted" in refused(data, 1, "prune", "--older-than", "30d", typed="\n")
    assert answer(data, "prune", "--older-than", "30d", "--yes") == "deleted: 2 runs, 40.0 MB\n"
    assert labels(data) == ["walk 1"]


@pytest.mark.parametrize(
    "words", [[], ["--older-than", "old"], ["--until-size", "-1GB"], ["--older-than", "0"]]
)
def test_a_pruning_without_a_measure_is_wrong_usage(data: Path, words: list[str]) -> None:
    assert refused(data, 2, "prune", *words)


def test_a_lost_catalogue_is_made_anew(tmp_path: Path) -> None:
    bench = RecordingsBench()
    id = bench.record(tmp_path, Walk(duration=0.5, frame_rate=0.0, label="kept"))
    (tmp_path / "catalogue.sqlite").unlink()
    assert answer(tmp_path, "rebuild") == "1 runs added, 0 renewed, 0 without their recording\n"
    assert json.loads(answer(tmp_path, "show", id[:-2], "--json"))["label"] == "kept"
    torn = file_of(tmp_path / "recordings", id)
    torn.write_bytes(torn.read_bytes()[:-200])
    assert id in answer(tmp_path, "recover")
    assert json.loads(answer(tmp_path, "show", id, "--json"))["recording"]["state"] == "recovered"
    assert answer(tmp_path, "recover") == "every recording is whole\n"


def test_sizes_and_ages_are_read_as_people_write_them() -> None:
    assert [gigabytes(text) for text in ("20GB", "500 mb", "1.5TB", "3")] == [20.0, 0.5, 1500.0, 3.0]
    assert [days(text) for text in ("30d", "12h", "2w", "7")] == [30.0, 0.5, 14.0, 7.0]
    for nonsense in ("", "GB", "1e9", "nan", "-3d", "5 lightyears", "0"):
        for read in (gigabytes, days):
            with pytest.raises(typer.BadParameter, match="is not a"):
                read(nonsense)
    assert [size_text(size) for size in (0, 999, 1000, 20_000_003, 1.5e12)] == [
        "0 B", "999 B", "1.00 kB", "20.0 MB", "1.50 TB",
    ]  # fmt: skip


def test_the_program_knows_the_command_and_its_help_loads_no_database(data: Path) -> None:
    program = (
        "import sys; from server.cli import app; from typer.testing import CliRunner\n"
        "print(CliRunner().invoke(app, ['--help']).stdout)\n"
        "print([name for name in ('sqlalchemy', 'alembic', 'mcap', 'pyarrow', 'av') if name in sys.modules])\n"
        "print(CliRunner().invoke(app, ['runs', 'list', '--data', sys.argv[1]]).stdout)\n"
    )
    run = [sys.executable, "-W", "error", "-c", program, str(data)]
    done = subprocess.run(run, capture_output=True, text=True, timeout=60, check=True)
    assert "Find, look at, edit, delete, export and replay runs." in done.stdout
    assert "\n[]\n" in done.stdout
    assert record(3).id in done.stdout
