"""A campaign on the rig that is served: it has the rig to itself, and whoever stops the rig stops it."""

import asyncio

import httpx
import pytest

from control.snapshot import RigState
from control.studies.definition import StudyDefinition
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.settings import RigFile
from server.studies.campaign import Campaign
from server.studies.campaign.on_rig import RigOperator
from server.studies.store import StudyStore
from tests.server.campaign_bench import CIRCLE, SHORT

pytestmark = pytest.mark.anyio

PATIENCE = 60.0
TWO_RUNS = {"axes": [{"of": "gait.tilt_deg", "values": [22, 28]}]}


class Bench:
    """A served rig that runs as fast as it goes."""

    def __init__(self, app, api):
        self.rig, self.archive, self.desk, self.api = app.state.rig, app.state.archive, app.state.studies, api
        self.store = StudyStore(self.archive.folder.parent, self.archive.catalogue)
        self.words = []

    def study(self, **changes):
        return self.store.create(StudyDefinition.from_json({**SHORT, **TWO_RUNS, **changes}))

    def begin(self, study, stop_at=None):
        """The campaign, and what becomes of it. stop_at: words at which there is an emergency stop."""

        def tell(now):
            self.words.append(now.words)
            if now.words == stop_at:
                self.rig.stop_coils()

        operator = RigOperator(self.rig, consent=False, heard=self.rig.occupation.latest_stop)
        campaign = Campaign(study, operator, self.archive.catalogue, tell)
        return campaign, asyncio.create_task(asyncio.to_thread(campaign.run))

    async def until_said(self, words):
        async with asyncio.timeout(PATIENCE):
            while not any(words in each for each in self.words):
                await asyncio.sleep(0.005)

    async def refused(self, method, path, body=None):
        """Why it was refused, in the server's words."""
        answer = await self.api.request(method, path, json=body)
        assert answer.status_code == 409, answer.text
        return answer.json()["detail"]


@pytest.fixture
async def bench(serve, tmp_path):
    def build(settings):
        return build_machine(settings, realtime=False)

    archive = Archive.open(tmp_path, patient=True)
    app = create_app(Rig(build(RigFile()), build, archive.recorder), archive)
    async with (
        serve(app) as at,
        httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=PATIENCE) as api,
    ):
        yield Bench(app, api)


async def test_a_campaign_has_the_rig_to_itself_but_for_a_pause_and_leaves_it_disarmed(bench):
    study = bench.study(duration_s=6.0, axes=[{"of": "gait.tilt_deg", "values": [25]}])
    campaign, ended = bench.begin(study)
    await bench.until_said("run 1 of 1: walking")
    paused = await bench.api.post("/runs/current/pause")
    assert paused.status_code == 200, paused.text
    words = "the study 'short' is running; stop it first"
    assert await bench.refused("POST", "/runs", {}) == words
    assert await bench.refused("POST", "/manual", {"pivot": 1, "rate_deg_s": 20.0}) == words
    assert await bench.refused("PATCH", "/rig", {"robot": {"length_mm": 11.0}})
    assert bench.rig.snapshot.rig is RigState.HELD, "only a person resumes what a person has paused"
    assert (await bench.api.post("/runs/current/resume")).status_code == 200
    outcome = await asyncio.wait_for(ended, PATIENCE)
    assert outcome.state == study.state == "finished", outcome
    (row,) = study.rows()
    assert (row.state, row.attempts) == ("finished", 1)
    assert bench.rig.snapshot.rig is RigState.DISARMED
    (listed,) = (await bench.api.get(f"/runs?study={study.id}")).json()["runs"]
    assert listed["id"] == row.run_id
    assert campaign.activity.words == "run 1 of 1: finished"
    assert (await bench.api.post("/arm")).status_code == 200, "it is free again"


@pytest.mark.parametrize(
    ("path", "reason", "state"),
    [
        ("/estop", "emergency stop", RigState.FAULT),
        ("/disarm", "the operator disarmed the rig", RigState.DISARMED),
        ("/runs/current/stop", "the operator stopped its run", RigState.DISARMED),
    ],
)
async def test_whoever_stops_the_rig_stops_the_campaign(bench, path, reason, state):
    study = bench.study(duration_s=20.0)
    _, ended = bench.begin(study)
    await bench.until_said("run 1 of 2: walking")
    assert (await bench.api.post(path)).status_code == 200
    outcome = await asyncio.wait_for(ended, PATIENCE)
    assert (outcome.state, outcome.reason) == ("stopped", reason)
    assert bench.rig.snapshot.rig is state
    assert study.rows() == []


async def test_a_stopped_campaign_goes_on_once_a_person_has_reset_the_rig(bench):
    study = bench.study()
    _, ended = bench.begin(study, stop_at="run 2 of 2: walking")
    assert (await asyncio.wait_for(ended, PATIENCE)).state == "stopped"
    (before,) = study.rows()
    bench.words.clear()
    _, ended = bench.begin(study)
    await bench.until_said("waiting for a person: reset and arm the rig (emergency stop)")
    await bench.api.post("/reset")
    await bench.until_said("waiting for a person: arm the rig")
    assert bench.rig.snapshot.rig is RigState.DISARMED, "a reset is no consent"
    await bench.api.post("/arm")
    outcome = await asyncio.wait_for(ended, PATIENCE)
    assert outcome.state == "finished", outcome
    assert before in study.rows()
    assert len(study.rows()) == 2


async def test_a_stop_that_comes_before_a_campaign_has_the_rig_counts(bench):
    """Between the request and the rig there are threads and files."""
    study = bench.study()
    asked = bench.desk.asked(consent=True, jobs=0)
    assert (await bench.api.post("/disarm")).status_code == 200
    states = set()
    with bench.rig.watched(lambda snapshot: states.add(snapshot.rig)):
        await bench.desk.begin(study, asked)
        async with asyncio.timeout(PATIENCE):
            while bench.desk.work_on(study.id) is not None:
                await asyncio.sleep(0.005)
    condition = study.condition
    assert (condition.state, condition.reason) == ("stopped", "the operator disarmed the rig")
    assert states == {RigState.DISARMED}


async def test_a_run_that_somebody_else_has_begun_is_not_the_campaigns_to_resume(bench):
    async with asyncio.timeout(PATIENCE):
        while (await bench.api.post("/arm")).status_code != 200:
            await asyncio.sleep(0.05)
    assert (await bench.api.post("/runs", json={})).status_code == 201
    assert (await bench.api.post("/runs/current/pause")).status_code == 200
    _, ended = bench.begin(bench.study())
    outcome = await asyncio.wait_for(ended, PATIENCE)
    assert outcome.state == "interrupted"
    assert outcome.reason.startswith("a run is held; let it come to its end, or stop it")
    assert bench.rig.snapshot.rig is RigState.HELD, "it is as it was"
    assert bench.rig.snapshot.run is not None


async def test_a_way_back_can_be_paused_and_looked_at_though_it_is_no_run(bench):
    far = {"name": "circle", "parameters": {**CIRCLE, "centre_y_mm": 10.0}}
    study = bench.study(trajectory=far)
    campaign, ended = bench.begin(study)
    await bench.until_said("walking back")
    async with asyncio.timeout(PATIENCE):
        while bench.rig.snapshot.run is None:
            await asyncio.sleep(0.005)
    paused = await bench.api.post("/runs/current/pause")
    assert (paused.status_code, paused.json()["rig"]) == (200, "held")
    assert (await bench.api.get("/runs")).json()["runs"] == []
    campaign.stop("enough")
    assert (await asyncio.wait_for(ended, PATIENCE)).reason == "enough"
    assert (await bench.api.get("/runs")).json()["runs"] == [], "a way back is no run"


async def test_a_campaign_is_interrupted_when_the_rig_is_closed(bench):
    study = bench.study(duration_s=20.0)
    _, ended = bench.begin(study)
    await bench.until_said("run 1 of 2: walking")
    await bench.rig.stop()
    outcome = await asyncio.wait_for(ended, PATIENCE)
    assert outcome.state == study.state == "interrupted"
    assert study.rows() == []


async def test_a_path_that_a_campaign_walks_along_stays_until_it_has_ended(bench):
    bow = {
        "name": "of the campaign",
        "points_mm": [[-3.0, -40.0], [3.0, -40.0], [0.0, -36.0]],
        "speed_mm_s": 8.0,
    }
    assert (await bench.api.post("/trajectories", json=bow)).status_code == 201
    study = bench.study(trajectory={"name": bow["name"]})
    await bench.desk.begin(study, bench.desk.asked(consent=False, jobs=0))
    address = f"/trajectories/{bow['name']}"
    assert "the study 'short' walks along" in await bench.refused("DELETE", address)
    assert "rename it when that has ended" in await bench.refused("PATCH", address, {"name": "another"})
    await bench.desk.stop(study.id)
    assert (await bench.api.delete(address)).status_code == 200
