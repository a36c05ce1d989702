"""What is kept of a study is there whole or not at all, for one who carries it out and many who look."""

import resource
import shutil
from contextlib import contextmanager

import pytest
from study_bench import carried_out, definition, opened, table_of

from control.metrics import Metrics
from control.studies.batch import simulate
from control.studies.table import figures
from server.catalogue.catalogue import Catalogue
from server.catalogue.rebuilding import put_in_order, rebuild
from server.catalogue.shelf import OpenShelf
from server.studies.condition import is_claimed
from server.studies.errors import NoSuchStudy, StudyBusy, StudyStoreError
from server.studies.store import StudyStore


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The data folder of a study of 12 runs that is finished; for reading and copying."""
    data = tmp_path_factory.mktemp("finished")
    with opened(data) as store:
        carried_out(store.create(definition()))
    return data


@pytest.fixture
def study(finished, tmp_path):
    """A copy of it that may be spoilt."""
    shutil.copytree(finished, tmp_path / "data")
    [study] = StudyStore(tmp_path / "data").all()
    return study


def test_a_study_is_found_again_as_it_was_defined(finished):
    [study] = StudyStore(finished).all()
    assert study.definition == definition()
    assert (study.state, study.tally().done, study.tally().failed) == ("finished", 12, 0)
    assert [row.index for row in study.rows()] == list(range(12))


def test_a_study_that_has_not_begun_is_planned_and_leaves_nothing_when_it_is_deleted(tmp_path):
    with opened(tmp_path) as store:
        study = store.create(definition())
        assert (study.state, study.rows(), len(store.all())) == ("planned", [], 1)
        store.delete(study.id)
        assert not study.folder.exists()
        with pytest.raises(NoSuchStudy, match="studies list"):
            store.open(study.id)


@pytest.mark.parametrize("id", ["nothing", "", "..", "../recordings", "a/b", "\x00"])
def test_an_id_leads_nowhere_but_to_a_study(finished, id):
    with pytest.raises(NoSuchStudy):
        StudyStore(finished).open(id)
    with pytest.raises(NoSuchStudy):
        StudyStore(finished).delete(id)


def test_a_line_that_was_torn_anywhere_is_no_finished_run(study):
    path = study.folder / "results.jsonl"
    whole, expected = path.read_bytes(), study.table().csv()
    last = whole.rstrip(b"\n").rfind(b"\n") + 1
    for length in (last, last + 1, (last + len(whole)) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        assert study.tally().done == 11
        carried_out(study)
        assert (path.read_bytes(), study.table().csv()) == (whole, expected)


def test_a_line_without_sense_costs_its_run_alone(study):
    path = study.folder / "results.jsonl"
    lines, expected = path.read_bytes().splitlines(keepends=True), study.table().csv()
    lines[3] = b"\x00" * 30 + b"\n"
    lines[5] = b'{"index": "five"}\n'
    lines[7] = b"[" * 2000 + b"\n"
    path.write_bytes(b"".join(lines))
    assert study.tally().done == 9
    carried_out(study)
    assert study.table().csv() == expected
    assert path.read_bytes().startswith(b"".join(lines))


def test_the_same_run_counts_once(study):
    expected = study.table().csv()
    path = study.folder / "results.jsonl"
    path.write_bytes(path.read_bytes() * 2)
    assert (study.tally().done, study.table().csv()) == (12, expected)


def test_a_reader_gets_each_row_once_and_only_whole_ones(study):
    path = study.folder / "results.jsonl"
    whole = path.read_bytes()
    seen, place = [], 0
    for length in range(0, len(whole) + 1, 97):
        path.write_bytes(whole[:length])
        rows, place = study.new_rows(place)
        seen += rows
    path.write_bytes(whole)
    seen += study.new_rows(place)[0]
    assert seen == list(study.results().rows())


def test_a_row_keeps_every_bit_on_the_disk(study):
    run = study.definition.plan().run(7)
    [metrics] = simulate([run])
    assert isinstance(metrics, Metrics)
    assert study.results()[7].metrics == figures(metrics)


def test_one_at_a_time_carries_a_study_out(study):
    with study.claimed():
        assert (study.state, is_claimed(study.folder)) == ("running", True)
        again = StudyStore(study.folder.parents[1]).open(study.id)
        with pytest.raises(StudyBusy, match=r"carried out already, by process \d+; wait .* or stop"):
            carried_out(again)
        with pytest.raises(StudyBusy):
            StudyStore(study.folder.parents[1]).delete(study.id)
    assert not is_claimed(study.folder)


def test_rows_are_taken_from_who_carries_it_out_alone(study):
    with pytest.raises(StudyStoreError, match="from who carries it out"):
        study.append(study.rows()[0])


@contextmanager
def room_for(size):
    """No file grows beyond that, bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_ends_a_study_in_words_and_it_goes_on_when_there_is_room(study):
    expected = study.table().csv()
    (study.folder / "results.jsonl").unlink()
    with (
        room_for(1500),
        pytest.raises(StudyStoreError, match=r"results.jsonl cannot be written: .* make room"),
    ):
        carried_out(study)
    assert study.state == "interrupted"
    assert "make room" in study.reason
    carried_out(study)
    assert (study.state, study.table().csv()) == ("finished", expected)


def test_studies_survive_the_loss_of_the_catalogue(study):
    data = study.folder.parents[1]
    for path in data.glob("catalogue.sqlite*"):
        path.unlink()
    shelf = OpenShelf.open(data)
    try:
        put_in_order(shelf)
        [listed] = shelf.catalogue.studies.all()
        assert (listed.id, listed.name, listed.state) == (study.id, "three tilts", "finished")
        assert listed.created_at == study.created_at
        study.folder.rename(study.folder.with_name("elsewhere"))
        rebuild(shelf)
        assert [listed.id for listed in shelf.catalogue.studies.all()] == ["elsewhere"]
    finally:
        shelf.close()


def test_the_catalogue_follows_what_becomes_of_a_study(tmp_path):
    catalogue = Catalogue.open(tmp_path)
    store = StudyStore(tmp_path, catalogue)
    study = store.create(definition(1))
    states = [catalogue.studies.all()[0].state]
    carried_out(study, watch=lambda _: states.append(catalogue.studies.all()[0].state))
    states.append(catalogue.studies.all()[0].state)
    store.delete(study.id)
    assert list(dict.fromkeys(states)) == ["planned", "running", "finished"]
    assert catalogue.studies.all() == []
    catalogue.close()


def test_a_study_of_a_controller_that_is_not_there_is_named_and_harms_no_other(study):
    path = study.folder / "definition.json"
    stranger = study.folder.with_name("20200101-000000-stranger")
    stranger.mkdir()
    text = path.read_text().replace('"three tilts"', "17")
    (stranger / "definition.json").write_text(text)
    store = StudyStore(study.folder.parents[1])
    assert [each.id for each in store.all()] == [study.id]
    assert list(store.unreadable()) == [stranger.name]
    assert "name" in store.unreadable()[stranger.name]
    store.delete(stranger.name)
    assert store.unreadable() == {}


def test_the_results_do_not_depend_on_the_order_in_which_they_are_asked_for(tmp_path):
    listed = table_of(tmp_path, definition(order="listed"))
    assert listed == table_of(tmp_path, definition(order="random"))
