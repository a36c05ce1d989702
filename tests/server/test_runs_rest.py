"""All runs over REST: listed, filtered, edited, deleted, pruned, and everybody who watches is told."""

from __future__ import annotations

import asyncio
import json
from datetime import UTC, datetime

import httpx
import pytest
from catalogue_bench import record

from control.runs import Run, RunRequest, RunState, Selection
from server.catalogue.deleting import delete_run
from server.catalogue.shelf import OpenShelf, file_of

pytestmark = pytest.mark.anyio

KEYS = {
    "id", "label", "tags", "notes", "pinned", "state", "reason", "started_at", "ended_at", "passes", "duration_s",
    "unattended", "controller", "trajectory", "gait", "metrics", "simulated", "plant", "seed", "rig", "version",
    "study", "recording", "sparkline",
}  # fmt: skip

TEN_RUNS = tuple(record(index, pinned=index == 0, label=f"walk {index}") for index in reversed(range(10)))


@pytest.fixture
async def page(at, api):
    """The interface of a server whose catalogue has ten runs of old, the newest with the index 9."""
    catalogue, folder = at.archive.catalogue, at.archive.folder
    if catalogue.page(limit=500).runs != TEN_RUNS:
        for run in catalogue.page(limit=500).runs:
            catalogue.delete(run.id)
        for run in TEN_RUNS:
            catalogue.add(run)
            file_of(folder, run.id).write_bytes(b"recording")
    return api


def labels(answer: httpx.Response) -> list[str]:
    assert answer.status_code == 200, answer.text
    return [run["label"] for run in answer.json()["runs"]]


async def test_the_catalogue_is_listed_newest_first_with_what_it_takes(page):
    answer = await page.get("/runs", params={"limit": 3})
    assert labels(answer) == ["walk 9", "walk 8", "walk 7"]
    listing = answer.json()
    assert (listing["total"], listing["trouble"]) == (10, "")
    sizes = [record(index).size_bytes for index in range(10)]
    assert listing["totals"] == {
        "runs": 10, "bytes": sum(sizes), "pinned_bytes": sizes[0], "free_bytes": listing["totals"]["free_bytes"],
    }  # fmt: skip
    assert listing["totals"]["free_bytes"] > 0
    assert all(set(run) == KEYS for run in listing["runs"])


async def test_pages_follow_each_other(page):
    found, cursor = [], None
    while cursor is not None or not found:
        answer = await page.get("/runs", params={"limit": 4, **({"cursor": cursor} if cursor else {})})
        found += labels(answer)
        cursor = answer.json()["next"]
        assert answer.json()["total"] == 10
    assert found == [f"walk {index}" for index in reversed(range(10))]


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        ({"pinned": "true"}, ["walk 0"]),
        ({"text": "WALK 7"}, ["walk 7"]),
        ({"since": record(8).started_at.isoformat()}, ["walk 9", "walk 8"]),
        ({"until": record(1).started_at.isoformat()}, ["walk 0"]),
        ({"study": "study-0", "simulated": "false", "text": "walk"}, ["walk 9", "walk 3"]),
        ({"state": "nothing"}, []),
    ],
)
async def test_filters_narrow_the_list(page, asked, found):
    answer = await page.get("/runs", params=asked)
    assert labels(answer) == found
    assert answer.json()["total"] == len(found)


@pytest.mark.parametrize(
    ("asked", "field"),
    [
        ({"limit": 0}, "limit"),
        ({"limit": 501}, "limit"),
        ({"cursor": "nonsense"}, "cursor"),
        ({"since": "yesterday"}, "since"),
        ({"since": "2026-01-01T00:00:00"}, "since"),
        ({"pinned": "perhaps"}, "pinned"),
        ({"colour": "red"}, "colour"),
        ({"text": "x" * 201}, "text"),
    ],
)
async def test_a_filter_that_makes_no_sense_is_explained(page, asked, field):
    answer = await page.get("/runs", params=asked)
    assert answer.status_code == 422
    assert field in answer.json()["errors"][0]["field"]


async def test_a_run_is_shown_with_its_settings(at, page):
    at.archive.catalogue.update(record(3).id, settings={"rig": {"name": "x"}})
    one = (await page.get(f"/runs/{record(3).id}")).json()
    assert set(one) == KEYS | {"settings"}
    assert one["settings"] == {"rig": {"name": "x"}}
    assert one["recording"] == {"state": "complete", "size_bytes": record(3).size_bytes, "frames": 1250}


@pytest.mark.parametrize("call", ["get", "patch", "delete"])
@pytest.mark.parametrize("id", ["nowhere", "..%2F..%2Frig.toml", "x" * 80])
async def test_a_run_that_is_not_there_is_not_found(page, call, id):
    options = {"json": {"label": "x"}} if call == "patch" else {}
    answer = await getattr(page, call)(f"/runs/{id}", **options)
    assert answer.status_code == 404
    assert answer.json()["detail"]


async def test_label_tags_notes_and_pin_can_be_changed(page):
    body = {"label": " new  name ", "tags": ["a", " a", "b"], "notes": "line\nline", "pinned": True}
    answer = await page.patch(f"/runs/{record(5).id}", json=body)
    assert answer.status_code == 200
    changed = answer.json()
    assert (changed["label"], changed["tags"], changed["notes"], changed["pinned"]) == (
        "new name", ["a", "b"], "line\nline", True,
    )  # fmt: skip
    assert labels(await page.get("/runs", params={"tag": "b"})) == ["new name"]
    assert (await page.patch(f"/runs/{record(5).id}", json={"pinned": False})).json()["notes"] == "line\nline"


@pytest.mark.parametrize(
    "body",
    [{"state": "finished"}, {"label": "x" * 201}, {"tags": ["x" * 41]}, {"tags": [str(n) for n in range(21)]},
     {"notes": 5}, {"pinned": "yes"}, {"notes": "x" * 20_001}],
)  # fmt: skip
async def test_an_edit_out_of_bounds_changes_nothing(page, body):
    before = (await page.get(f"/runs/{record(5).id}")).json()
    answer = await page.patch(f"/runs/{record(5).id}", json=body)
    assert answer.status_code == 422
    assert (await page.get(f"/runs/{record(5).id}")).json() == before


async def test_a_run_is_deleted_with_its_recording(at, page):
    path = file_of(at.archive.folder, record(4).id)
    assert path.exists()
    answer = await page.delete(f"/runs/{record(4).id}")
    assert (answer.status_code, answer.content) == (204, b"")
    assert not path.exists()
    assert "walk 4" not in labels(await page.get("/runs"))
    assert (await page.delete(f"/runs/{record(4).id}")).status_code == 404


async def test_a_pinned_run_is_not_deleted(page):
    answer = await page.delete(f"/runs/{record(0).id}")
    assert answer.status_code == 409
    assert "take its pin away" in answer.json()["detail"]
    assert (await page.get(f"/runs/{record(0).id}")).status_code == 200


async def test_what_would_go_is_shown_before_it_goes(page):
    body = {"older_than_days": 30}
    would = (await page.post("/runs/prune", json={**body, "dry_run": True})).json()
    assert [run["label"] for run in would["runs"]] == [f"walk {index}" for index in range(1, 10)]
    assert would["bytes"] == sum(record(index).size_bytes for index in range(1, 10))
    assert (await page.get("/runs")).json()["total"] == 10
    assert (await page.post("/runs/prune", json=body)).json() == would
    assert labels(await page.get("/runs")) == ["walk 0"]


@pytest.mark.parametrize(
    "body", [{}, {"dry_run": True}, {"older_than_days": 0}, {"until_size_GB": -1}, {"older_than_days": "30"}]
)
async def test_a_pruning_that_does_not_say_what_may_go_is_refused(page, body):
    assert (await page.post("/runs/prune", json=body)).status_code == 422
    assert (await page.get("/runs")).json()["total"] == 10


async def test_everybody_hears_of_edits_and_deletions(at, page):
    async with at.socket("/api/v1/telemetry?rate_Hz=1") as telemetry:
        await page.patch(f"/runs/{record(5).id}", json={"label": "heard"})
        await page.delete(f"/runs/{record(6).id}")
        await page.post("/runs/prune", json={"older_than_days": 30})
        heard = []
        async with asyncio.timeout(10.0):
            while len(heard) < 3:
                message = json.loads(await telemetry.recv())
                if message["type"] == "run":
                    heard.append((message["event"], message["run"]))
    assert [event for event, _ in heard] == ["edited", "deleted", "pruned"]
    assert (heard[0][1]["label"], heard[1][1]) == ("heard", {"id": record(6).id})


async def until(api, wanted):
    """Ask until the answer is as wanted."""
    async with asyncio.timeout(10.0):
        while True:
            state = (await api.get("/state")).json()
            if wanted(state):
                return
            await asyncio.sleep(0.02)


async def test_a_run_that_goes_on_is_listed_first_and_cannot_be_deleted(at, page):
    await until(page, lambda state: state["tracking"] == "locked")
    async with asyncio.timeout(10.0):
        while (await page.post("/arm")).status_code == 409:
            await asyncio.sleep(0.05)
    await until(page, lambda state: state["rig"] == "armed")
    started = await page.post("/runs", json={"label": "now", "tags": ["live"]})
    assert started.status_code == 201, started.text
    id = started.json()["id"]
    listing = (await page.get("/runs", params={"limit": 3})).json()
    assert [run["label"] for run in listing["runs"]] == ["now", "walk 9", "walk 8"]
    assert (listing["total"], listing["runs"][0]["state"]) == (11, "running")
    assert (await page.get("/runs/current")).json()["id"] == id
    assert labels(await page.get("/runs", params={"tag": "live"})) == ["now"]
    assert (await page.delete(f"/runs/{id}")).status_code in (404, 409)
    await page.post("/runs/current/stop")
    await page.post("/disarm")
    assert await asyncio.to_thread(at.archive.recorder.written, id, 10.0)
    one = (await page.get(f"/runs/{id}")).json()
    assert (one["state"], one["recording"]["state"]) == ("stopped", "complete")
    assert one["recording"]["size_bytes"] == file_of(at.archive.folder, id).stat().st_size
    assert (await page.delete(f"/runs/{id}")).status_code == 204
    assert (await page.get(f"/runs/{id}")).status_code == 404
    assert labels(await page.get("/runs", params={"tag": "live"})) == []


async def test_what_another_program_deletes_leaves_this_session_s_list_too(at, page):
    selection = Selection()
    run = Run("walked-here", RunRequest(selection), RunState.STOPPED, datetime.now(UTC))
    at.rig.runs.start(run)
    assert (await page.get("/runs")).json()["runs"][0]["id"] == run.id
    await asyncio.to_thread(at.archive.catalogue.add, record(1, id=run.id, state="stopped", pinned=False))
    other = OpenShelf.open(at.archive.folder.parent)
    delete_run(other, run.id)
    other.close()
    assert (await page.get(f"/runs/{run.id}")).status_code == 404
    listing = (await page.get("/runs")).json()
    assert run.id not in [each["id"] for each in listing["runs"]]
    assert listing["total"] == listing["totals"]["runs"]
    assert run.id not in [each.id for each in at.rig.runs]


async def test_without_a_catalogue_this_session_s_runs_are_listed(at, page):
    """The file is taken away from under the server, as a disk that has gone would."""
    catalogue = at.archive.catalogue
    catalogue.close()
    for end in ("", "-wal", "-shm"):
        catalogue.path.with_name(catalogue.path.name + end).unlink(missing_ok=True)
    catalogue.path.mkdir()
    try:
        answer = await page.get("/runs")
        assert answer.status_code == 200
        trouble = answer.json()["trouble"]
        assert catalogue.path.name in trouble
        assert "cannot be" in trouble, "opened, or read where somebody still has it open"
        one = await page.get(f"/runs/{record(5).id}")
        assert (one.status_code, one.json()["title"]) == (503, "No catalogue")
    finally:
        catalogue.path.rmdir()
