"""Taking a run away over REST, from a server that goes on with its work."""

import asyncio
import csv
import io
import json
import os
import time
from datetime import UTC, datetime
from pathlib import Path

import av
import httpx
import pytest
from mcap.reader import make_reader
from pyarrow import parquet

from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.catalogue.records import RunRecord
from server.exports.work import AT_ONCE
from server.rig import Rig
from server.settings import RigFile
from tests.server.rig_visit import act, arm, until_gone
from tests.server.walked_run import walk

pytestmark = pytest.mark.anyio

ID = "20261123-093000-a1b2"
UNRECORDED, DAMAGED = "20261123-093100-0000", "20261123-093200-0000"
STARTED = datetime(2026, 11, 23, 9, 31, tzinfo=UTC)
TIMEOUT = 60.0
GONE_WITHIN = 5.0
"""A server that is told to end, s (faults.md, row 16)."""
FILES = {
    "samples.csv": "text/csv; charset=utf-8",
    "samples.parquet": "application/vnd.apache.parquet",
    "recording.mcap": "application/octet-stream",
    "plot.svg": "image/svg+xml",
    "video.mp4": "video/mp4",
    "video.mp4?overlay=true": "video/mp4",
}


@pytest.fixture(scope="module")
async def at(tmp_path_factory, serve):
    """A server whose data folder holds a walked run, one without a recording, and one that cannot be read."""
    data = tmp_path_factory.mktemp("data")
    walk(data, ID, duration=2.0, label="First try / μ")
    archive = Archive.open(data)
    archive.catalogue.add(RunRecord(UNRECORDED, STARTED, state="finished"))
    archive.catalogue.add(RunRecord(DAMAGED, STARTED, state="finished", recording_state="complete"))
    rig = Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder)
    async with serve(create_app(rig, archive)) as served:
        served.rig, served.archive = rig, archive
        yield served


@pytest.fixture
async def api(at):
    async with httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=TIMEOUT) as client:
        yield client


@pytest.fixture(scope="module")
async def fetched(at):
    """Every file of the walked run, all asked for at the same time; and how many were made at once at most."""
    most = 0
    async with httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=TIMEOUT) as client:
        asked = asyncio.gather(*(client.get(f"/runs/{ID}/{file}") for file in FILES))
        while not asked.done():
            most = max(most, len(exports()))
            await asyncio.sleep(0.02)
        return dict(zip(FILES, await asked, strict=True)), most


@pytest.fixture
def content(fetched):
    answers, _ = fetched
    return {file: answer.content for file, answer in answers.items()}


async def problem(api, file, id, status):
    answer = await api.get(f"/runs/{id}/{file}")
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    return answer.json()["detail"]


def exports():
    """Processes of this one that make an export."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(status.read_text().rpartition(")")[2].split()[1])
            words = (status.parent / "cmdline").read_bytes()
        except OSError:  # it has just ended
            continue
        if parent == os.getpid() and b"server.exports" in words:
            found.append(int(status.parent.name))
    return found


async def until(condition):
    async with asyncio.timeout(TIMEOUT):
        while not condition():
            await asyncio.sleep(0.02)


async def test_every_form_has_its_type_and_a_safe_name(fetched):
    answers, _ = fetched
    for file, answer in answers.items():
        assert answer.status_code == 200, answer.text
        assert answer.headers["content-type"] == FILES[file]
        suffix = Path(file.partition("?")[0]).suffix
        assert answer.headers["content-disposition"].endswith(f'; filename="{ID}_First-try{suffix}"')
        assert len(answer.content) > 1000


async def test_two_exports_at_once_are_made_and_the_others_wait(fetched):
    _, most = fetched
    assert most == AT_ONCE


async def test_the_table_is_the_same_in_every_form(content):
    table = parquet.read_table(io.BytesIO(content["samples.parquet"]))
    rows = list(csv.DictReader(io.StringIO(content["samples.csv"].decode())))
    reader = make_reader(io.BytesIO(content["recording.mcap"]))
    errors = [json.loads(message.data)["error_mm"] for _, _, message in reader.iter_messages("/reference")]
    assert [float(row["error_mm"]) for row in rows if row["error_mm"]] == errors
    assert [error for error in table["error_mm"].to_pylist() if error is not None] == errors


async def test_the_recording_can_be_fetched_in_parts(api, content):
    part = await api.get(f"/runs/{ID}/recording.mcap", headers={"Range": "bytes=100-199"})
    assert part.status_code == 206
    assert part.content == content["recording.mcap"][100:200]


async def test_a_film_plays_and_can_be_had_with_overlay(content):
    plain, drawn = content["video.mp4"], content["video.mp4?overlay=true"]
    assert plain != drawn
    for each in (plain, drawn):
        with av.open(io.BytesIO(each), "r") as film:
            assert sum(1 for _ in film.decode(video=0)) > 15


async def test_a_figure_is_shown_in_the_page(fetched):
    headers = fetched[0]["plot.svg"].headers
    assert headers["content-disposition"].startswith("inline")
    assert "max-age" in headers["cache-control"]


async def test_an_export_ends_with_its_client(at):
    async with httpx.AsyncClient(base_url=at.url + "/api/v1") as client:
        asked = asyncio.create_task(client.get(f"/runs/{ID}/samples.mat"))
        await until(exports)
        asked.cancel()
        await asyncio.gather(asked, return_exceptions=True)
    await until(lambda: not exports())


async def test_a_server_that_ends_takes_its_exports_with_it_and_says_so(at, serve):
    rig, archive = Rig(build_machine(RigFile(), realtime=True)), Archive.open(at.archive.folder.parent)
    async with httpx.AsyncClient(timeout=TIMEOUT) as client:
        async with serve(create_app(rig, archive)) as ending:
            address = f"{ending.url}/api/v1/runs/{ID}/samples.mat"
            asked = [asyncio.create_task(client.get(address)) for _ in range(AT_ONCE + 1)]
            await until(lambda: len(exports()) == AT_ONCE)
            began = time.monotonic()
        assert time.monotonic() - began < GONE_WITHIN
        assert not exports()
        for answer in await asyncio.gather(*asked):
            assert answer.status_code == 503
            assert "going down" in answer.json()["detail"]


async def test_an_export_is_made_wherever_the_server_was_started(api, tmp_path, monkeypatch):
    """Also in a folder with a program of its own that is called as ours is."""
    (tmp_path / "server").mkdir()
    (tmp_path / "server" / "__init__.py").write_text("raise SystemExit('another server')")
    monkeypatch.chdir(tmp_path)
    answer = await api.get(f"/runs/{ID}/samples.csv")
    assert answer.status_code == 200, answer.text


async def test_what_is_not_there_is_said(api, at):
    at.archive.path_of(DAMAGED).write_bytes(b"rubbish")
    assert "no run" in await problem(api, "samples.csv", "20200101-000000-0000", 404)
    assert "no run" in await problem(api, "samples.csv", "etc", 404)
    assert "was not recorded" in await problem(api, "samples.csv", UNRECORDED, 409)
    assert "without pictures" in await problem(api, "video.mp4", DAMAGED, 409)
    assert "no recording that can be read" in await problem(api, "plot.png", DAMAGED, 409)


async def test_a_run_that_goes_on_is_stopped_first_and_its_recording_waited_for(api):
    await arm(api)
    run = await act(api, "/runs", 201, duration_s=30)
    await until_gone(api, 0.3)
    for file in ("samples.csv", "recording.mcap", "plot.png", "video.mp4"):
        assert "is being recorded; stop it first" in await problem(api, file, run["id"], 409)
    await act(api, "/runs/current/stop")
    answer = await api.get(f"/runs/{run['id']}/recording.mcap")
    assert answer.status_code == 200, answer.text
    errors = list(make_reader(io.BytesIO(answer.content)).iter_messages("/reference"))
    assert len(errors) > 15
    answer = await api.get(f"/runs/{run['id']}/samples.csv")
    assert len(answer.text.splitlines()) > 20
    await act(api, "/disarm")
