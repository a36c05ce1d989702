"""What a server does for the archive after it has begun to serve: mend what is torn, delete what is too old."""

import asyncio
import json
import os

import pytest

from control.runs import Choice, RunRequest, Selection
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.catalogue.errors import NoSuchRun
from server.headless import Headless
from server.rig import Rig
from server.settings import RigFile
from tests.server.rig_visit import act, arm, until, until_gone

pytestmark = pytest.mark.anyio

TIMEOUT = 10.0
WALK = RunRequest(Selection(Choice("geometric"), Choice("eight")), duration=0.5)
KEEPS_NOTHING = RigFile.model_validate({"recording": {"keep_GB": 1e-6}})


def walked(data, *ids):
    archive = Archive.open(data, patient=True)
    for id in ids:
        Headless(build_machine(RigFile(), realtime=False), recorder=archive.recorder).run(id, WALK)
    archive.close()


async def told(rig, words):
    async with asyncio.timeout(TIMEOUT):
        while not any(words in line.message for line in rig.events):
            await asyncio.sleep(0.02)


async def pages_hear(messages, event):
    async with asyncio.timeout(TIMEOUT):
        while (await messages.get()).get("event") != event:
            pass


async def gone(archive, id):
    async with asyncio.timeout(TIMEOUT):
        while archive.path_of(id).exists():
            await asyncio.sleep(0.02)
    with pytest.raises(NoSuchRun):
        archive.catalogue.get(id)


async def test_after_the_start_what_is_torn_is_mended_and_what_is_too_much_deleted(serve, tmp_path):
    """A torn recording is whole again and its run listed; of the others the oldest go, but never a pinned one."""
    await asyncio.to_thread(walked, tmp_path, "torn", "loose")
    archive = Archive.open(tmp_path)
    os.truncate(archive.path_of("torn"), archive.path_of("torn").stat().st_size * 2 // 3)
    archive.catalogue.update("torn", pinned=True, state="running", recording_state="writing")
    rig = Rig(build_machine(KEEPS_NOTHING, realtime=True), recorder=archive.recorder)
    async with rig.announcements.subscribe() as messages, serve(create_app(rig, archive)):
        await told(rig, "torn")
        await pages_hear(messages, "listed")
        await gone(archive, "loose")
        await told(rig, "one old run was deleted")
        mended = archive.catalogue.get("torn")
        assert (mended.state, mended.recording_state) == ("interrupted", "recovered")
        assert archive.path_of("torn").exists()


async def test_after_a_run_the_oldest_make_room(api, at):
    settings = at.rig.settings
    at.rig.machine.settings = settings.model_copy(update={"recording": KEEPS_NOTHING.recording})
    try:
        await until(api, rig="disarmed", tracking="locked", faults=[])
        await arm(api)
        async with at.socket("/api/v1/telemetry?rate_Hz=1") as telemetry:
            id = (await act(api, "/runs", 201))["id"]
            await until_gone(api, 0.2)
            await act(api, "/runs/current/stop")
            await gone(at.archive, id)
            assert (await heard(telemetry, "pruned"))["runs"] == 1
        assert id not in [run["id"] for run in (await api.get("/runs")).json()["runs"]]
    finally:
        at.rig.machine.settings = settings


async def heard(telemetry, event):
    """What the page of a person who watches is told."""
    async with asyncio.timeout(TIMEOUT):
        while True:
            message = json.loads(await telemetry.recv())
            if message["type"] == "run" and message["event"] == event:
                return message


async def test_a_catalogue_that_is_lost_under_the_server_is_filled_again(at, api, monkeypatch):
    monkeypatch.setattr("server.upkeep.LOOK_AGAIN", 0.05)
    archive = at.archive
    await asyncio.to_thread(walked, archive.folder.parent, "kept")
    at.rig.announce("info", "test", "the disk has been tidied")  # from the next line on the new pace counts
    async with at.socket("/api/v1/telemetry?rate_Hz=1") as telemetry:
        for end in ("", "-wal", "-shm"):
            archive.catalogue.path.with_name(archive.catalogue.path.name + end).unlink(missing_ok=True)
        assert (await api.get("/runs")).json()["total"] == 0
        await heard(telemetry, "listed")
    assert "kept" in [run["id"] for run in (await api.get("/runs")).json()["runs"]]
