"""Every run of a served rig is recorded, and what happens to the recording is told like everything else."""

import asyncio
import contextlib
import json
import signal
import sqlite3
import time

import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner

from server.archive import Archive
from server.catalogue.opening import NAME
from server.cli import app
from server.recording.reading.recording import Recording
from tests.processes import served
from tests.server.rig_visit import act, arm, until, until_gone

pytestmark = pytest.mark.anyio

WALK = {"gait": {"sweep_deg": 10.0}}
GONE_WITHIN = 5.0
TOLD_WITHIN = 1.0


@pytest.fixture
async def disarmed(api):
    """The rig at rest, however the test before has left it."""
    for fault in ("disk_full", "disk_read_only", "disk_slow"):
        await api.delete(f"/simulation/faults/{fault}")
    await act(api, "/estop")
    await act(api, "/reset")
    await until(api, rig="disarmed", tracking="locked", faults=[])
    return api


async def walk(api, duration, **body):
    """Arm, start a run and let it go on for a while; its id."""
    await arm(api)
    await until(api, rig="armed")
    id = (await act(api, "/runs", 201, **WALK, **body))["id"]
    await until_gone(api, duration)
    return id


async def written(at, id):
    """The recording of a run that is over, once it is whole."""
    assert await asyncio.to_thread(at.archive.recorder.written, id, 10.0)
    return at.archive.path_of(id)


def messages_of(path, topic):
    """By the public reader; path: of a whole recording."""
    with open(path, "rb") as file:
        return [
            json.loads(message.data)
            for _, _, message in make_reader(file, validate_crcs=True).iter_messages(topics=[topic])
        ]


async def test_a_run_is_recorded_from_its_first_tick_until_the_coils_are_empty(at, disarmed):
    id = await walk(disarmed, 0.7, label="a walk")
    state = (await disarmed.get("/state")).json()
    assert state["recording"]["state"] == "recording"
    assert state["recording"]["run"] == id
    assert state["recording"]["failure"] == ""
    await act(disarmed, "/runs/current/stop")
    path = await written(at, id)
    states = messages_of(path, "/state")
    assert [states[0]["rig"], states[-1]["rig"]] == ["running", "armed"]
    ticks = [tick["tick"] for tick in states]
    assert ticks == list(range(ticks[0], ticks[0] + len(ticks))), "none is left out"
    assert len(messages_of(path, "/camera")) > 5
    assert "run stopped" in [line["message"] for line in messages_of(path, "/events")]
    record = at.archive.catalogue.get(id)
    assert (record.state, record.label, record.recording_state) == ("stopped", "a walk", "complete")
    assert record.metrics == (await disarmed.get(f"/runs/{id}")).json()["metrics"]


async def test_what_is_changed_on_the_way_is_recorded(at, disarmed):
    id = await walk(disarmed, 0.3)
    answer = await disarmed.patch("/runs/current", json={"gait": {"sweep_deg": 15.0}})
    assert answer.status_code == 200, answer.text
    await until_gone(disarmed, 0.5)
    await act(disarmed, "/runs/current/stop")
    gaits = [
        json.loads(each["gait"])["sweep_deg"] for each in messages_of(await written(at, id), "/selection")
    ]
    assert gaits == [10.0, 15.0]


async def test_a_run_that_cannot_be_recorded_is_refused_in_words_and_the_rig_stays_armed(disarmed):
    await arm(disarmed)
    await act(disarmed, "/simulation/faults", 201, name="disk_full")
    problem = await act(disarmed, "/runs", 409, **WALK)
    assert "MB" in problem["detail"]
    assert "free" in problem["detail"]
    assert (await disarmed.get("/state")).json()["rig"] == "armed"


async def test_a_recording_holds_no_tick_of_the_rig_that_the_changed_settings_make(at, disarmed):
    """The robot's coils are still being seen to go when another machine, with a clock of its own, is put in place."""
    id = await walk(disarmed, 0.3)
    await act(disarmed, "/runs/current/stop")
    await act(disarmed, "/disarm")
    await at.rig.rebuild(at.rig.settings)
    times = [state["time_s"] for state in messages_of(await written(at, id), "/state")]
    assert times == sorted(times)


@pytest.mark.parametrize("fault", ["disk_full", "disk_read_only"])
async def test_a_disk_that_fails_under_way_ends_the_run_and_everybody_is_told_why(at, disarmed, fault):
    id = await walk(disarmed, 1.5)
    newest = (await disarmed.get("/state")).json()["time_s"]
    began = time.monotonic()
    await act(disarmed, "/simulation/faults", 201, name=fault)
    state = await until(disarmed, rig="disarmed")
    assert time.monotonic() - began <= TOLD_WITHIN + 0.5
    assert "its recording has failed" in state["reason"]
    assert state["recording"]["state"] == "failed"
    assert state["recording"]["failure"] in state["reason"]
    run = (await disarmed.get(f"/runs/{id}")).json()
    assert (run["state"], run["reason"]) == ("aborted", state["reason"])
    lines = [line["code"] for line in (await disarmed.get("/events")).json()["events"]]
    assert "recording" in lines
    await disarmed.delete(f"/simulation/faults/{fault}")
    with Recording.open(at.archive.path_of(id)) as recording:
        kept = recording.tick_at(recording.duration)
    assert kept is not None
    assert kept["/state"]["time_s"] >= newest - 1.25


async def test_a_catalogue_that_cannot_be_written_stops_no_run(at, disarmed):
    """Somebody else keeps the catalogue locked; the run goes on, and its recording is whole."""
    with contextlib.closing(sqlite3.connect(at.archive.folder.parent / NAME, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        id = await walk(disarmed, 1.0)
        assert (await disarmed.get("/state")).json()["rig"] == "running"
        await act(disarmed, "/runs/current/stop")
        other.execute("ROLLBACK")
    assert messages_of(await written(at, id), "/state")


def test_a_server_that_is_ended_ends_its_run_in_good_order(tmp_path):
    with served(tmp_path, "--sim") as server:
        server.start_walking()
        id = server.get("/state")["run"]["id"]
        began = time.monotonic()
        server.process.send_signal(signal.SIGTERM)
        assert server.process.wait(10) == 0
        assert time.monotonic() - began <= GONE_WITHIN
    archive = Archive.open(tmp_path)
    try:
        record = archive.catalogue.get(id)
        assert (record.state, record.reason) == ("aborted", "pivotrig was ended")
        assert record.recording_state == "complete"
        with Recording.open(archive.path_of(id)) as recording:
            assert recording.is_whole
            assert recording.outcome is not None
            assert recording.outcome["state"] == "aborted"
    finally:
        archive.close()


@pytest.mark.exclusive
def test_a_server_whose_disk_hangs_is_gone_as_soon_and_its_recording_opens(tmp_path):
    with served(tmp_path, "--sim") as server:
        server.start_walking()
        id = server.get("/state")["run"]["id"]
        server.post("/simulation/faults", {"name": "disk_slow", "parameters": {"delay_s": 60.0}})
        time.sleep(1.5)  # within a second the disk is waited for
        began = time.monotonic()
        server.process.send_signal(signal.SIGTERM)
        assert server.process.wait(10) == 0
        assert time.monotonic() - began <= GONE_WITHIN
    with Recording.open(tmp_path / "recordings" / f"{id}.mcap") as recording:
        assert recording.tick_at(recording.duration) is not None


def run(*arguments):
    answer = CliRunner().invoke(app, ["run", "--sweep", "10", "--duration", "2", "--json", *arguments])
    assert answer.exit_code == 0, answer.output
    return json.loads(answer.stdout)


def test_a_run_of_the_command_line_is_recorded_and_none_the_worse_for_it(tmp_path):
    recorded = run("--data", str(tmp_path / "data"))
    alone = run("--data", str(tmp_path / "none"), "--no-record")
    for measured in ("wall_s", "run_id"):
        del alone[measured]
    assert {name: recorded[name] for name in alone} == alone
    archive = Archive.open(tmp_path / "data")
    try:
        record = archive.catalogue.get(recorded["run_id"])
        assert (record.state, record.recording_state) == ("finished", "complete")
        ticks = [state["tick"] for state in messages_of(archive.path_of(record.id), "/state")]
        assert len(ticks) >= recorded["ticks"]
        assert ticks == list(range(ticks[0], ticks[0] + len(ticks)))
    finally:
        archive.close()
    assert not (tmp_path / "none").exists()
