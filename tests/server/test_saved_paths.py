"""Paths that somebody drew: saved, found again after a restart, renamed, deleted and had back."""

import json

import pytest

from control.trajectories import trajectories
from server.custom_trajectories import NAME, CustomTrajectories

pytestmark = pytest.mark.anyio

BOW = {
    "name": "kept bow",
    "points_mm": [[0.0, 0.0], [10.0, 0.0], [10.0, 20.0]],
    "closed": False,
    "kind": "spline",
    "speed_mm_s": 4.0,
}


@pytest.fixture
def paths():
    """Nothing that another module's tests saved is there, and nothing that a test saves is left for the next one."""
    paths = CustomTrajectories()
    forget_all(paths)
    before = set(trajectories)
    yield paths
    for name in set(trajectories) - before:
        trajectories.forget(name)


@pytest.fixture
def file(tmp_path):
    return tmp_path / NAME


@pytest.fixture
async def kept(at, api, paths, file):
    """The server keeps its paths in `file`, and has one."""
    assert paths.all() == []
    assert at.rig.custom_trajectories.open(file) == []
    assert (await api.post("/trajectories", json=BOW)).status_code == 201
    return api


def forget_all(paths):
    for path in paths.all():
        paths.forget(path.name)


async def test_a_saved_path_is_there_after_a_restart(kept, paths, file):
    forget_all(paths)
    assert BOW["name"] not in trajectories
    assert CustomTrajectories().open(file) == []
    assert (await kept.get("/trajectories/kept bow")).json() == BOW
    listed = {entry["name"]: entry["saved"] for entry in (await kept.get("/trajectories")).json()}
    assert listed["kept bow"] is True
    assert listed["eight"] is False


async def test_a_path_is_renamed_and_the_file_follows(kept, file):
    answer = await kept.patch("/trajectories/kept bow", json={"name": "rainbow"})
    assert answer.json() == {**BOW, "name": "rainbow"}
    assert (await kept.get("/trajectories/kept bow")).status_code == 404
    assert [path["name"] for path in json.loads(file.read_text())["paths"]] == ["rainbow"]
    taken = await kept.patch("/trajectories/rainbow", json={"name": "eight"})
    assert taken.status_code == 409


async def test_what_was_deleted_can_be_had_back_from_the_answer(kept, file):
    answer = await kept.delete("/trajectories/kept bow")
    assert answer.json() == BOW
    assert json.loads(file.read_text())["paths"] == []
    assert (await kept.post("/trajectories", json=answer.json())).status_code == 201
    assert json.loads(file.read_text())["paths"] == [BOW]


async def test_a_path_that_is_selected_keeps_its_name(kept):
    selection = (await kept.get("/selection")).json()
    await kept.put("/selection", json={**selection, "trajectory": {"name": "kept bow"}})
    for answer in (
        await kept.delete("/trajectories/kept bow"),
        await kept.patch("/trajectories/kept bow", json={"name": "rainbow"}),
    ):
        assert answer.status_code == 409
        assert "is selected" in answer.json()["detail"]
    await kept.put("/selection", json=selection)
    assert (await kept.delete("/trajectories/kept bow")).status_code == 200


@pytest.mark.parametrize("name", ["eight", "nobody knows it", "waypoints"])
async def test_only_saved_paths_can_be_read_renamed_or_deleted(kept, name):
    for method in ("GET", "DELETE", "PATCH"):
        body = {"json": {"name": "free"}} if method == "PATCH" else {}
        assert (await kept.request(method, f"/trajectories/{name}", **body)).status_code == 404
    assert "eight" in trajectories


async def test_a_disk_that_takes_nothing_refuses_the_path_and_forgets_it(kept, at, file):
    at.rig.custom_trajectories.open(file / "no folder" / NAME)
    answer = await kept.post("/trajectories", json={**BOW, "name": "lost bow"})
    assert answer.status_code == 409
    assert "cannot be kept" in answer.json()["detail"]
    assert "lost bow" not in trajectories
    assert (await kept.delete("/trajectories/kept bow")).status_code == 409
    assert "kept bow" in trajectories


def test_a_damaged_path_does_not_take_the_others_along(paths, file):
    far = {**BOW, "name": "beyond any table", "points_mm": [[0.0, 0.0], [9000.0, 0.0]]}
    file.write_text(json.dumps({"format": 1, "paths": [{"name": "half"}, BOW, far, 7]}))
    (problem,) = paths.open(file)
    assert [path.to_json() for path in paths.all()] == [BOW]
    assert "saved path 1" in problem
    assert "saved path 3" in problem
    assert "saved path 4" in problem
    assert file.with_name(NAME + ".unread").read_text() == file.read_text()


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "7", '{"paths": 3}', '{"format": 1}', "\ufeff{}", "[" * 100_000]
)
def test_a_file_that_is_none_of_ours_is_put_aside_and_told_of(paths, file, text):
    file.write_text(text)
    (problem,) = paths.open(file)
    assert "unread" in problem
    assert paths.all() == []


def test_bytes_that_are_no_text_are_put_aside(paths, file):
    file.write_bytes(b"\xff\xfe\x00{")
    assert len(paths.open(file)) == 1
    assert file.with_name(NAME + ".unread").read_bytes() == b"\xff\xfe\x00{"


async def test_the_points_of_a_file_are_read_and_a_wrong_line_is_named(api):
    answer = await api.post("/trajectories/points", json={"text": "x_mm,y_mm\n1,2\n3.5,-4\n"})
    assert answer.json() == {"points_mm": [[1.0, 2.0], [3.5, -4.0]]}
    wrong = await api.post("/trajectories/points", json={"text": "1,2\nhello\n"})
    assert wrong.status_code == 422
    assert "line 2" in wrong.json()["detail"]
