"""Star and latency over REST: a run of the loop like any other, whose figures are saved when the rig is disarmed."""

import asyncio
import contextlib
from pathlib import Path

import httpx
import pytest

from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.rig_changes import RigChanges
from server.rig_file import RigStore, load_rig_file
from server.settings import RigFile

pytestmark = pytest.mark.anyio

PATIENCE = 60.0
RIG = '# kept\n[simulation]\nstamps = "arrival"\nstart_x_mm = 0.0\nstart_y_mm = 0.0\n'
SHORT_STAR = {"legs": 2, "leg_mm": 12.0}
SHORT_WIGGLE = {"turns": 10}


class Bench:
    """A served rig that runs as fast as it goes, with its file."""

    def __init__(self, rig: Rig, path: Path, api: httpx.AsyncClient) -> None:
        self.rig, self.path, self.api = rig, path, api

    async def get(self, what: str):
        return (await self.api.get(what)).json()

    async def post(self, what: str, status: int = 200, **body):
        answer = await (self.api.post(what, json=body) if body else self.api.post(what))
        assert answer.status_code == status, answer.text
        return answer.json()

    async def until(self, what: str, condition):
        async with asyncio.timeout(PATIENCE):
            while not condition(answer := await self.get(what)):
                await asyncio.sleep(0.02)
        return answer

    async def armed(self) -> None:
        await self.until("/state", lambda state: state["tracking"] == "locked" and not state["faults"])
        async with asyncio.timeout(PATIENCE):
            while (await self.api.post("/arm")).status_code == 409:
                await asyncio.sleep(0.02)

    async def ended(self, kind: str):
        return await self.until(
            f"/calibration/{kind}", lambda each: each["stage"] not in ("walking", "working_out")
        )


@contextlib.asynccontextmanager
async def served_rig(serve, path: Path, as_run=lambda settings: settings):
    store = RigStore(path)

    def build(settings: RigFile):
        return build_machine(settings, realtime=False)

    archive = Archive.open(path.parent)
    rig = Rig(build(as_run(store.settings)), build, archive.recorder)
    changes = RigChanges(rig, store, as_run)
    async with (
        serve(create_app(rig, archive, changes=changes)) as at,
        httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=PATIENCE) as api,
    ):
        yield Bench(rig, path, api)


@pytest.fixture
async def bench(serve, tmp_path: Path):
    path = tmp_path / "rig.toml"
    path.write_text(RIG)
    async with served_rig(serve, path) as one:
        yield one


async def test_the_latency_is_measured_shown_and_saved_when_the_rig_is_disarmed(bench):
    idle = await bench.get("/calibration/latency")
    assert (idle["stage"], idle["figures"], idle["in_use"]["source"]) == ("idle", None, "not measured")
    await bench.armed()
    begun = await bench.post("/calibration/latency", 202, **SHORT_WIGGLE)
    assert begun["stage"] == "walking"
    assert (await bench.get(f"/runs/{begun['run_id']}"))["label"] == "latency calibration"
    done = await bench.ended("latency")
    assert done["stage"] == "done", done
    assert done["progress"] == 1.0
    assert done["figures"]["latency_ms"]["value"] == pytest.approx(35.0, abs=3.0)
    assert 0.0 < done["figures"]["latency_ms"]["standard_error"] < 3.0
    refused = await bench.post("/calibration/latency/save", 409)
    assert "disarmed" in refused["detail"]
    assert "latency" not in bench.path.read_text()
    await bench.post("/disarm")
    saved = await bench.post("/calibration/latency/save")
    assert saved["saved"]
    assert saved["in_use"]["latency_ms"] == done["changes"]["camera"]["latency_ms"]
    assert load_rig_file(bench.path).camera.latency_source.startswith("measured 20")
    assert "# kept" in bench.path.read_text()
    tick = await bench.until("/state", lambda state: state["camera"]["rate_Hz"] is not None)
    assert tick["camera"]["rate_Hz"] == pytest.approx(60.0, abs=3.0), (
        "the first interval has whole milliseconds"
    )
    assert tick["camera"]["latency_ms"] == pytest.approx(saved["in_use"]["latency_ms"], abs=1.0)


async def measured(bench, kind: str, **body):
    await bench.armed()
    await bench.post(f"/calibration/{kind}", 202, **body)
    done = await bench.ended(kind)
    assert done["stage"] == "done", done
    await bench.post("/disarm")
    return done


async def test_a_latency_that_was_measured_on_another_camera_is_not_saved(bench):
    await measured(bench, "latency", **SHORT_WIGGLE)
    await bench.api.patch("/rig", json={"camera": {"exposure_ms": 8.0}, "robot": {"lift_ratio": 3.3}})
    refused = await bench.post("/calibration/latency/save", 409)
    assert refused["detail"].startswith("camera.exposure_ms changed since")
    assert "latency" not in bench.path.read_text()
    await bench.api.post("/rig/undo")
    assert (await bench.post("/calibration/latency/save"))["saved"]
    saved = bench.path.read_text()
    await bench.post("/rig/undo")
    assert bench.rig.settings.camera.latency_ms == 0.0
    await bench.post("/rig/undo")
    assert bench.path.read_text() == saved
    await bench.post("/calibration/latency/save")
    assert bench.path.read_text() == saved


async def test_what_a_simulation_shows_is_not_saved_as_a_real_rig_s(serve, tmp_path: Path):
    path = tmp_path / "rig.toml"
    path.write_text(RIG + '[camera]\nuri = "v4l://0"\n[link]\nport = "/dev/ttyACM0"\n')
    async with served_rig(serve, path, RigFile.as_simulated) as bench:
        before = path.read_text()
        await measured(bench, "latency", **SHORT_WIGGLE)
        assert "--sim" in (await bench.post("/calibration/latency/save", 409))["detail"]
        assert path.read_text() == before


async def test_the_star_gives_the_gait_s_figures_and_saves_them(bench):
    await bench.api.patch("/rig", json={"simulation": {"stamps": "capture"}})
    await bench.armed()
    await bench.post("/calibration/star", 202, **SHORT_STAR)
    busy = await bench.post("/calibration/latency", 409)
    assert "star" in busy["detail"]
    done = await bench.ended("star")
    assert done["stage"] == "done", done
    assert done["figures"]["length_mm"]["value"] == pytest.approx(10.0, abs=0.2)
    assert all(figure["standard_error"] > 0.0 for figure in done["figures"].values())
    await bench.post("/disarm")
    saved = await bench.post("/calibration/star/save")
    assert saved["saved"]
    assert saved["in_use"]["length_mm"] == load_rig_file(bench.path).robot.length_mm
    assert saved["in_use"]["source"].startswith("measured 20")
    await bench.post("/rig/undo")
    undone = await bench.get("/calibration/star")
    assert (undone["saved"], undone["in_use"]["source"]) == (False, "not measured")
    assert (await bench.post("/calibration/star/save"))["saved"], "what was undone can be saved again"


async def test_a_star_that_loses_the_robot_says_that_the_camera_s_latency_comes_first(bench):
    await bench.armed()
    await bench.post("/calibration/star", 202)
    failed = await bench.ended("star")
    assert failed["stage"] == "failed"
    assert "latency has not been measured" in failed["reason"]


async def test_a_rig_that_is_not_armed_does_not_walk(bench):
    for kind in ("star", "latency"):
        refused = await bench.post(f"/calibration/{kind}", 409)
        assert "arm it first" in refused["detail"]
        assert (await bench.get(f"/calibration/{kind}"))["stage"] == "idle"
        nothing = await bench.post(f"/calibration/{kind}/save", 409)
        assert "found nothing yet" in nothing["detail"]


async def test_a_star_without_room_is_refused_before_anything_moves(bench):
    await bench.armed()
    refused = await bench.post("/calibration/star", 409, leg_mm=50.0)
    assert "leaves no room" in refused["detail"]
    assert (await bench.get("/state"))["rig"] == "armed"


@pytest.mark.parametrize("body", [{"legs": 1}, {"leg_mm": "20"}, {"rate_deg_s": 1e9}, {"unknown": 1}])
async def test_what_makes_no_star_is_refused_in_words(bench, body):
    assert (await bench.post("/calibration/star", 422, **body))["errors"]


async def stop_at_once(bench):
    await bench.post("/estop")


async def pause(bench):
    await bench.post("/runs/current/pause")


async def lose_the_robot(bench):
    bench.rig.machine.camera.disturbance.hidden = True


async def change_the_walk(bench):
    await bench.api.patch("/runs/current", json={"controller": {"name": "hold"}})


async def stop_the_run(bench):
    await bench.post("/runs/current/stop")


@pytest.mark.parametrize(
    ("interrupt", "words", "state"),
    [
        (stop_at_once, "emergency stop", "fault"),
        (pause, "paused by the operator", "disarmed"),
        (lose_the_robot, "not seen", "disarmed"),
        (change_the_walk, "somebody changed the walk", "armed"),
        (stop_the_run, "stopped by the operator", "armed"),
    ],
)
async def test_whatever_ends_the_walk_ends_the_calibration_with_its_reason(bench, interrupt, words, state):
    """No current is left but that of a rig that stays armed, and nothing is found."""
    await bench.armed()
    await bench.post("/calibration/latency", 202, turns=200)
    await bench.until("/calibration/latency", lambda each: each["progress"] > 0.0)
    await interrupt(bench)
    ended = await bench.ended("latency")
    assert ended["stage"] == "failed"
    assert words in ended["reason"]
    assert ended["figures"] is None
    await bench.until("/state", lambda now: now["rig"] == state)
    if state != "armed":
        world = bench.rig.machine.world
        async with asyncio.timeout(PATIENCE):
            while max(map(abs, world.currents)) > 0.05:
                await asyncio.sleep(0.02)
    await bench.post("/calibration/latency/save", 409)
    assert bench.path.read_text() == RIG


async def test_a_server_that_ends_takes_a_calibration_with_it(serve, tmp_path):
    archive = Archive.open(tmp_path)
    rig = Rig(build_machine(RigFile(), realtime=False), recorder=archive.recorder)
    app = create_app(rig, archive)
    async with serve(app) as at, httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=PATIENCE) as api:
        bench = Bench(rig, Path(), api)
        await bench.armed()
        await bench.post("/calibration/latency", 202, turns=200)
    assert not any("calibration" in task.get_name() for task in asyncio.all_tasks())
