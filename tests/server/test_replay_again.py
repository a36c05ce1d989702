import json
import math

import httpx
import numpy as np
import pytest
from rig_visit import act, arm
from typer.testing import CliRunner

from control.gait import Gait
from control.runs import Choice, RunRequest, Selection
from control.trajectories import trajectories
from control.trajectories.custom import SavedPath, save_path
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.commands.runs import app
from server.commands.runs_replay import what_was_asked
from server.headless import Headless
from server.recording.reading.recording import Recording
from server.rig import Rig
from server.settings import RigFile

pytestmark = pytest.mark.anyio

OWN = "own corner"
CORNER = np.array([[0.0, -0.042], [0.0, -0.03], [0.01, -0.03]])


def walk(data, id, request, rig):
    archive = Archive.open(data, patient=True)
    try:
        return Headless(build_machine(rig, realtime=False), None, archive.recorder).run(id, request)
    finally:
        archive.close()


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """A data folder with a run of another rig along a path that somebody had saved."""
    data = tmp_path_factory.mktemp("walked")
    save_path(OWN, CORNER, False, 0.004)
    request = RunRequest(
        Selection(trajectory=Choice(OWN)), duration=1.0, label="corner", tags=("a", "b"), unattended=True
    )
    walk(data, "one", request, RigFile().with_simulation(seed=5, latency_ms=30.0))
    trajectories.forget(OWN)
    return data


@pytest.fixture(autouse=True)
def the_path_is_gone_again():
    yield
    if OWN in trajectories:
        trajectories.forget(OWN)


@pytest.fixture(scope="module")
async def there(walked, serve):
    rig = Rig(build_machine(RigFile(), realtime=True))
    async with serve(create_app(rig, Archive.open(walked))) as served:
        served.rig = rig
        yield served


@pytest.fixture
async def rest(there):
    async with httpx.AsyncClient(base_url=there.url + "/api/v1", timeout=10.0) as client:
        yield client
        await client.post("/disarm")


async def test_an_unarmed_rig_starts_nothing_again(rest):
    refused = await rest.post("/runs/one/again")
    assert refused.status_code == 409
    assert "arm" in refused.json()["detail"]
    assert (await rest.get("/runs/current")).status_code == 409


async def test_a_run_of_nobody_cannot_be_started_again(rest):
    assert (await rest.post("/runs/nobody/again")).status_code == 404


async def test_the_same_is_asked_for_again_and_what_has_changed_since_is_told(rest):
    await arm(rest)
    answer = await act(rest, "/runs/one/again", 201)
    run = answer["run"]
    assert run["trajectory"] == {"name": OWN, "parameters": {"speed_mm_s": 4.0}}
    assert (run["label"], run["tags"], run["duration_s"]) == ("corner again", ["a", "b"], 1.0)
    assert run["unattended"]
    saved = trajectories[OWN]
    assert issubclass(saved, SavedPath)
    assert saved.whole.points_mm == [(0.0, -42.0), (0.0, -30.0), (10.0, -30.0)]
    told = {each["name"]: (each["then"], each["now"]) for each in answer["differences"]}
    assert told == {"simulation.seed": (5, 1), "simulation.latency_ms": (30.0, 35.0)}
    assert "simulation.seed was 5 and is 1 now" in [each["words"] for each in answer["differences"]]
    await rest.post("/runs/current/stop")


async def test_another_path_of_that_name_is_not_taken_for_it(rest):
    save_path(OWN, CORNER * 0.5, False, 0.004)
    await arm(rest)
    refused = await rest.post("/runs/one/again")
    assert refused.status_code == 409
    assert "another one of that name" in refused.json()["detail"]


def outcome_of(data, id):
    with Recording.open(data / "recordings" / f"{id}.mcap") as recording:
        outcome, last = recording.outcome, recording.tick_at(recording.duration)
    assert outcome is not None
    assert last is not None
    return outcome["metrics"], last


def test_a_headless_run_comes_out_the_same_to_the_last_digit(tmp_path):
    gait = Gait(sweep=math.radians(100.0 / 3.0), tilt=math.radians(22.2222222))
    walk(tmp_path, "first", RunRequest(Selection(gait=gait), duration=2.0), RigFile().with_simulation(seed=9))
    done = CliRunner().invoke(app, ["again", "last", "--json", "--data", str(tmp_path)])
    assert done.exit_code == 0, done.output
    result = json.loads(done.stdout)
    (metrics, last), (metrics_again, last_again) = (
        outcome_of(tmp_path, "first"),
        outcome_of(tmp_path, result["run_id"]),
    )
    assert metrics == metrics_again
    assert result["mean_error_mm"] == metrics["mean_error_mm"]
    for topic in ("/estimate", "/measurement", "/currents"):
        assert last[topic] == last_again[topic]


def test_a_run_that_is_walked_again_is_a_run_of_its_own(walked):
    refused = CliRunner().invoke(app, ["again", "nobody", "--data", str(walked)])
    assert refused.exit_code == 2
    more = CliRunner().invoke(app, ["again", "one", "--no-record", "--json", "--data", str(walked)])
    assert more.exit_code == 0, more.output
    assert json.loads(more.stdout)["run_id"] != "one"


def test_the_rig_and_the_request_come_from_the_recording(walked):
    archive = Archive.open(walked)
    try:
        rig, request = what_was_asked(archive.catalogue.get("one"))
    finally:
        archive.close()
    assert (rig.simulation.seed, rig.simulation.latency_ms) == (5, 30.0)
    assert request.selection.trajectory == Choice(OWN, {"speed_mm_s": 4.0})
    assert request.selection.gait == Gait()
