"""`pivotrig study` and `pivotrig studies`, as they are typed."""

import json
import sys

import pytest
from study_bench import CLUELESS, definition, table_of

from control.controllers import controllers
from server import cli
from server.studies.store import StudyStore

STUDY = definition(2)


@pytest.fixture
def pivotrig(tmp_path, monkeypatch, capsys):
    """Carries a command out in a data folder; its exit status, stdout and stderr."""

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["pivotrig", *map(str, arguments), "--data", str(tmp_path / "data")])
        with pytest.raises(SystemExit) as end:
            cli.main()
        said = capsys.readouterr()
        return end.value.code, said.out, " ".join(said.err.split())

    return run


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "tilts.toml"
    path.write_text(STUDY.to_toml())
    return path


def changed(file, **changes):
    file.write_text(definition(**{"repeats": 2, **changes}).to_toml())


def test_a_study_says_what_it_will_take_then_what_came_of_it(pivotrig, file, tmp_path):
    status, out, err = pivotrig("study", file, "--jobs", 1, "--json")
    assert (status, err) == (0, "three tilts: 3 sets, 6 runs, 3 s of rig time; about 4 s")
    result = json.loads(out)
    assert (result["state"], result["runs"], result["failed"]) == ("finished", 6, 0)
    assert result["best"]["runs"] == 2
    [study] = StudyStore(tmp_path / "data").all()
    assert result["id"] == study.id
    with open(result["table"], "rb") as table:
        assert table.read() == table_of(tmp_path / "other", STUDY)


def test_a_dry_run_begins_nothing(pivotrig, file, tmp_path):
    status, out, _ = pivotrig("study", file, "--dry-run", "--json")
    assert status == 0
    assert json.loads(out)["sets"] == 3
    assert json.loads(out)["runs"] == 6
    assert StudyStore(tmp_path / "data").all() == []


def test_resume_goes_on_with_the_unfinished_study_of_the_same_definition_alone(pivotrig, file, tmp_path):
    status, _, err = pivotrig("study", file, "--resume")
    assert status == 2
    assert "no unfinished study 'three tilts'; leave --resume out" in err
    study = StudyStore(tmp_path / "data").create(STUDY)
    file.write_text(file.read_text() + "\n# a remark changes nothing\n")
    status, out, _ = pivotrig("study", file, "--resume", "--jobs", 1, "--json")
    assert (status, json.loads(out)["id"], study.state) == (0, study.id, "finished")


def test_a_definition_that_was_changed_since_is_not_taken_for_the_same(pivotrig, file, tmp_path):
    study = StudyStore(tmp_path / "data").create(STUDY)
    changed(file, seed=2, axes=[{"of": "gait.tilt_deg", "values": [20, 25]}])
    status, _, err = pivotrig("study", file, "--resume")
    assert status == 2
    assert "seed was 1 and is 2; axes[0].values was [20, 25, 30] and is [20, 25]" in err
    assert f"pivotrig studies resume {study.id}" in err


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name = ", "this is no TOML"),
        ('name = "a"\nrepeats = 0', "repeats"),
        ('name = "a"\n[controller]\nname = "nobody"', "nobody"),
        ('name = "a"\n[[axes]]\nof = "gait.tilt_deg"\nvalues = [20, 200]', "tilt_deg"),
    ],
)
def test_what_cannot_be_carried_out_is_refused_before_anything_begins(pivotrig, file, tmp_path, text, words):
    file.write_text(text)
    status, _, err = pivotrig("study", file)
    assert (status, words in err) == (2, True), err
    assert StudyStore(tmp_path / "data").all() == []


@pytest.fixture
def plugin(tmp_path):
    path = tmp_path / "clueless.py"
    path.write_text(CLUELESS)
    yield path
    controllers.forget("clueless")


def test_a_run_that_raises_is_a_failed_row_and_several_in_a_row_end_a_study(pivotrig, file, plugin, tmp_path):
    changed(file, controller={"name": "clueless"})
    status, out, err = pivotrig("study", file, "--jobs", 1, "--json", "--plugin", plugin)
    [study] = StudyStore(tmp_path / "data").all()
    assert (status, json.loads(out)["state"], json.loads(out)["failed"]) == (1, "failed", 3)
    assert f"3 runs in a row failed; 3 runs are done; `pivotrig studies resume {study.id}` goes on" in err
    assert all("no idea" in row.reason for row in study.rows())


def test_a_study_goes_on_past_failed_runs_where_its_rule_says_so(pivotrig, file, plugin):
    controller_of = {"of": "controller", "values": ["clueless", "straight"]}
    changed(file, axes=[controller_of], repeats=4, order="listed", stop={"failed_in_a_row": 0})
    status, out, _ = pivotrig("study", file, "--jobs", 1, "--json", "--plugin", plugin)
    result = json.loads(out)
    assert (status, result["state"], result["runs"], result["failed"]) == (0, "finished", 8, 4)
    assert result["best"]["values"] == {"controller": "straight"}


def test_studies_are_listed_shown_taken_away_and_deleted(pivotrig, file, tmp_path):
    pivotrig("study", file, "--jobs", 1, "--json")
    [study] = StudyStore(tmp_path / "data").all()
    status, out, _ = pivotrig("studies", "list")
    assert (status, out.split("\t")[:5]) == (0, [study.id, "three tilts", "batch", "finished", "6/6"])
    _, out, _ = pivotrig("studies", "show", "last", "--json")
    assert json.loads(out)["definition"] == STUDY.to_json()
    _, out, _ = pivotrig("studies", "table", study.id[:12])
    assert out.encode() == study.table().csv()
    status, out, _ = pivotrig("studies", "resume", "last", "--json")
    assert (status, json.loads(out)["state"]) == (0, "finished")
    (study.folder / "results.jsonl").unlink()
    _, out, _ = pivotrig("studies", "resume", "last", "--jobs", 1, "--json")
    assert (json.loads(out)["state"], json.loads(out)["runs"]) == ("finished", 6)
    status, out, _ = pivotrig("studies", "delete", "last", "--yes")
    assert (status, out.strip()) == (0, f"deleted: {study.id}")
    status, _, err = pivotrig("studies", "show", "last")
    assert (status, "studies list" in err) == (2, True)
