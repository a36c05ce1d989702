"""Recorded pictures looked at again through REST: one at a time, in a process beside the live rig."""

import asyncio
import math

import httpx
import pytest

from control.gait import Gait
from control.runs import RunRequest, Selection
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.headless import Headless
from server.rig import Rig
from server.settings import RigFile

pytestmark = pytest.mark.anyio

DONE_WITHIN = 60.0
"""Of a busy computer, s; it takes about 4."""


def walk(archive, id, **recording):
    settings = RigFile.model_validate({"recording": recording})
    request = RunRequest(Selection(gait=Gait(sweep=math.radians(20.0))), duration=1.5)
    Headless(build_machine(settings, realtime=False), recorder=archive.recorder).run(id, request)
    archive.recorder.finish()


@pytest.fixture(scope="module")
async def there(tmp_path_factory, serve):
    data = tmp_path_factory.mktemp("walked")
    archive = Archive.open(data, patient=True)
    for id, rate in (("walked", 20.0), ("also", 20.0), ("blind", 0.0)):
        walk(archive, id, frames_Hz=rate)
    archive.close()
    async with serve(create_app(Rig(build_machine(RigFile(), realtime=True)), Archive.open(data))) as served:
        served.data = data
        yield served


@pytest.fixture
async def rest(there):
    async with httpx.AsyncClient(base_url=there.url + "/api/v1", timeout=10.0) as client:
        yield client


async def ended(rest, id):
    """The answer once nobody works on that run any more, and all that was told of the progress on the way."""
    told = []
    async with asyncio.timeout(DONE_WITHIN):
        while (answer := (await rest.get(f"/runs/{id}/retrack")).json())["stage"] == "working":
            told.append(answer["progress"])
            await asyncio.sleep(0.05)
    return answer, told


async def test_a_run_is_looked_at_again_beside_the_rig(rest):
    body = {"estimator": {"slip_mm": 0.4}, "controller": {"name": "straight"}}
    started = await rest.post("/runs/walked/retrack", json=body)
    assert started.status_code == 202, started.text
    answer, told = await ended(rest, "walked")
    assert (answer["stage"], answer["reason"], answer["progress"]) == ("done", "", 1.0)
    assert answer["job"] == started.json()["job"]
    assert told == sorted(told)
    assert 0.0 <= told[0] <= told[-1] <= 1.0
    assert answer["changes"]["estimator"] == {"slip_mm": 0.4}
    comparison, series = answer["comparison"], answer["series"]
    assert comparison["position_mm"]["max"] < 1.0
    assert comparison["command"]["ticks"] > 60
    lengths = {name: len(column) for name, column in series.items()}
    assert set(lengths.values()) == {comparison["ticks"]}
    assert {"time_s", "x_mm", "heading_deg", "tracking", "then_x_mm", "rate_deg_s"} <= lengths.keys()


async def test_two_at_once_are_refused_and_a_cancelled_one_leaves_nothing(rest, there):
    before = sorted(path.name for path in (there.data / "recordings").iterdir())
    assert (await rest.post("/runs/walked/retrack", json={})).status_code == 202
    refused = await rest.post("/runs/also/retrack", json={})
    assert refused.status_code == 409
    assert "walked" in refused.json()["detail"]
    cancelled = await rest.delete("/runs/walked/retrack")
    assert cancelled.json()["stage"] == "cancelled"
    assert (await rest.get("/runs/walked/retrack")).json()["series"] is None
    assert sorted(path.name for path in (there.data / "recordings").iterdir()) == before
    assert (await rest.delete("/runs/walked/retrack")).status_code == 200
    assert (await rest.get("/runs/walked/retrack")).json()["stage"] == "none"


@pytest.mark.parametrize(
    ("id", "body", "status", "words"),
    [
        ("nobody", {}, 404, "nobody"),
        ("blind", {}, 409, "without pictures"),
        ("walked", {"vision": {"hue": 3}}, 422, "vision.hue"),
        ("walked", {"estimator": {"slip_mm": "much"}}, 422, "estimator.slip_mm"),
        ("walked", {"controller": {"name": "nobody"}}, 422, "no controller called"),
        ("walked", {"camera": {}}, 422, "camera"),
        ("walked", {"estimate": "mine"}, 422, "estimate"),
    ],
)
async def test_what_cannot_be_done_is_refused_in_words(rest, id, body, status, words):
    refused = await rest.post(f"/runs/{id}/retrack", json=body)
    assert refused.status_code == status
    assert words in refused.json()["detail"]


async def test_a_run_that_nobody_looked_at_has_no_second_look(rest):
    assert (await rest.get("/runs/also/retrack")).json()["stage"] == "none"
    assert (await rest.get("/runs/nobody/retrack")).status_code == 404
    assert (await rest.delete("/runs/also/retrack")).status_code == 404


async def test_a_recording_that_turns_out_to_be_unreadable_says_so(rest, there):
    path = there.data / "recordings" / "also.mcap"
    whole = path.read_bytes()
    path.write_bytes(b"rubbish")
    try:
        assert (await rest.post("/runs/also/retrack", json={})).status_code == 202
        answer, _ = await ended(rest, "also")
    finally:
        path.write_bytes(whole)
    assert answer["stage"] == "failed"
    assert "no recording that can be read" in answer["reason"]
