import asyncio
import contextlib
import json
import struct
import time
from typing import Any

import httpx
import pytest
import viser
from scene_visit import seen
from websockets.exceptions import ConnectionClosed

from control.runs import Choice, RunRequest, Selection
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.headless import Headless
from server.rig import Rig
from server.scene.private_viser import connect_to
from server.settings import RigFile

pytestmark = pytest.mark.anyio

PROTOCOL = f"viser-v{viser.__version__}"
WALKED = 4.0
"""Duration of the recorded runs, s."""
RIG = RigFile().with_simulation(plant="noslip", seed=5)
REQUEST = RunRequest(Selection(trajectory=Choice("circle")), duration=WALKED, label="first")


def walk(data, id, request, watch=None):
    archive = Archive.open(data, patient=True)
    try:
        return Headless(build_machine(RIG, realtime=False), watch, archive.recorder).run(id, request)
    finally:
        archive.close()


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """A data folder with two runs, and the snapshots of the first one."""
    data, seen = tmp_path_factory.mktemp("walked"), []
    walk(data, "one", REQUEST, seen.append)
    walk(data, "two", RunRequest(Selection(), duration=2.0, label="second"))
    return data, [snapshot for snapshot in seen if snapshot.run is not None]


@pytest.fixture(scope="module")
async def there(walked, serve):
    data, _ = walked
    rig = Rig(build_machine(RigFile(), realtime=True))
    async with serve(create_app(rig, Archive.open(data))) as served:
        served.rig = rig
        yield served


@pytest.fixture
async def rest(there):
    async with httpx.AsyncClient(base_url=there.url + "/api/v1", timeout=10.0) as client:
        yield client


class Page:
    """What a page does with its replay socket."""

    ready: dict[str, Any]

    def __init__(self, socket):
        self.socket = socket

    async def told(self):
        async with asyncio.timeout(10.0):
            return json.loads(await self.socket.recv())

    async def ask(self, at, *, frame=False):
        await self.socket.send(json.dumps({"at_s": at, "frame": frame}))
        return await self.told()

    async def picture(self):
        async with asyncio.timeout(10.0):
            data = await self.socket.recv()
        return struct.unpack_from("<II", data), data[8:]


@contextlib.asynccontextmanager
async def replay(there, *ids):
    query = "&".join(f"run={id}" for id in ids)
    async with there.socket(f"/api/v1/replay?{query}", max_size=None) as socket:
        page = Page(socket)
        page.ready = await page.told()
        assert page.ready["type"] == "ready"
        yield page
    await until(lambda: sessions_of(there).find(page.ready["session"]) is None)


def farewell(ended):
    """Code and reason with which the server has closed a socket."""
    assert ended.value.rcvd is not None
    return ended.value.rcvd.code, ended.value.rcvd.reason


def sessions_of(there):
    return there.server.config.app.state.replays


async def until(condition):
    async with asyncio.timeout(10.0):
        while not condition():
            await asyncio.sleep(0.01)


async def test_a_page_is_told_of_any_instant_what_the_rig_was_then(there, walked):
    _, seen = walked
    begin = seen[0].time
    async with replay(there, "one") as page:
        for snapshot in (seen[0], seen[len(seen) // 2], seen[7]):
            answer = await page.ask(snapshot.time - begin + 0.012)
            [tick] = answer["ticks"]
            assert abs(tick["tick"] - snapshot.tick) <= 1
            assert tick["rig"] == "running"
            assert tick["pose"]["x_mm"] == pytest.approx(snapshot.pose.x * 1e3, abs=1.0)
            assert answer["pictures"] is None


async def test_before_the_first_tick_there_is_none_and_after_the_last_one_it_stays(there):
    async with replay(there, "one") as page:
        [run] = page.ready["runs"]
        last = await page.ask(run["duration_s"])
        far = await page.ask(run["duration_s"] + 1e5)
        assert last["ticks"][0]["tick"] == far["ticks"][0]["tick"]
        first = (await page.ask(0.0))["ticks"][0]
        assert first is None or first["tick"] < last["ticks"][0]["tick"]


async def test_a_picture_comes_once_with_the_tick_that_was_made_of_it(there):
    async with replay(there, "one") as page:
        answer = await page.ask(2.0, frame=True)
        [about] = answer["pictures"]
        (run, _), jpeg = await page.picture()
        assert run == 0
        assert jpeg[:2] == b"\xff\xd8"
        assert about["new"]
        assert about["captured_s"] < about["time_s"] <= 2.0
        seen_at = about["tick"]["captured_s"] - (about["tick"]["run"]["elapsed_s"] or 0.0)
        tick_at = about["tick"]["time_s"] - (about["tick"]["run"]["elapsed_s"] or 0.0)
        assert tick_at - seen_at == pytest.approx(0.035, abs=0.02)
        again = await page.ask(2.0, frame=True)
        assert not again["pictures"][0]["new"]
        assert (await page.ask(2.0))["type"] == "replay"


async def test_of_many_requests_at_once_the_newest_is_answered(there):
    async with replay(there, "one") as page:
        for step in range(200):
            await page.socket.send(json.dumps({"at_s": step / 100}))
        answers = [await page.told()]
        while answers[-1]["at_s"] != 1.99:
            answers.append(await page.told())
        assert [a["at_s"] for a in answers] == sorted(a["at_s"] for a in answers)


async def test_a_message_that_is_no_request_is_answered_in_words_and_the_replay_goes_on(there):
    async with replay(there, "one") as page:
        await page.socket.send("forward!")
        problem = await page.told()
        assert problem["type"] == "problem"
        assert "at_s" in problem["detail"]
        assert (await page.ask(1.0))["at_s"] == 1.0


async def test_two_runs_are_shown_at_the_same_time_since_their_starts(there):
    async with replay(there, "one", "two") as page:
        assert [run["id"] for run in page.ready["runs"]] == ["one", "two"]
        answer = await page.ask(1.0, frame=True)
        elapsed = [tick["run"]["elapsed_s"] for tick in answer["ticks"]]
        assert elapsed[0] == pytest.approx(elapsed[1], abs=0.05)
        assert 0.5 < elapsed[0] <= 1.0
        assert {(await page.picture())[0][0] for _ in range(2)} == {0, 1}


@pytest.mark.parametrize(
    ("query", "code", "words"),
    [
        ("run=nobody", 4404, "nobody"),
        ("run=..%2F..%2Fetc", 4404, "etc"),
        ("", 4422, "not 0"),
        ("run=one&run=two&run=one", 4422, "not 3"),
    ],
)
async def test_a_replay_of_nothing_is_ended_with_the_reason(there, query, code, words):
    async with there.socket(f"/api/v1/replay?{query}") as socket:
        with pytest.raises(ConnectionClosed) as ended:
            await socket.recv()
    given, reason = farewell(ended)
    assert given == code
    assert words in reason


async def test_only_so_many_replays_are_open_at_once_and_each_ends_with_its_page(there):
    async with contextlib.AsyncExitStack() as pages:
        for _ in range(6):
            await pages.enter_async_context(replay(there, "one"))
        async with there.socket("/api/v1/replay?run=one") as seventh:
            with pytest.raises(ConnectionClosed) as ended:
                await seventh.recv()
        code, reason = farewell(ended)
        assert code == 4429
        assert "close one" in reason
    assert len(sessions_of(there)) == 0
    async with replay(there, "one") as page:
        assert (await page.ask(0.5))["type"] == "replay"


# The scene ---------------------------------------------------------------------------------------


def moves(name):
    return lambda message: message["type"] == "SetPositionMessage" and message["name"] == name


def viewer_of(there, session):
    return there.socket(f"/scene/{session}", subprotocols=[PROTOCOL], max_size=None)


async def test_a_replay_has_a_scene_of_its_own_with_both_robots(there):
    live = there.server.config.app.state.scene
    async with replay(there, "one", "two") as page:
        session = page.ready["session"]
        answer = await page.ask(1.5)
        async with viewer_of(there, session) as viewer:
            found = await seen(viewer, moves("/compared/1/robot"))
        places = {m["name"]: m["position"] for m in found if m["type"] == "SetPositionMessage"}
        for name, tick in zip(("/robot", "/compared/1/robot"), answer["ticks"], strict=True):
            pose = tick["pose"]
            assert places[name][:2] == pytest.approx([pose["x_mm"] / 10, pose["y_mm"] / 10], abs=0.25)
        labels = [m["props"]["text"] for m in found if m["type"] == "LabelMessage"]
        assert sorted(label for label in labels if label in ("A", "B", "first", "second")) == [
            "A",
            "B",
            "second",
        ]
        ended = sessions_of(there).find(session)._scene.scene.server
        assert ended.get_host() != live.scene.server.get_host()
        assert live.bridge.viewers == 0
    assert len(sessions_of(there)) == 0
    with pytest.raises(ConnectionRefusedError):
        await connect_to(ended)


async def test_a_scene_of_a_replay_follows_what_is_asked_for(there):
    async with replay(there, "one") as page:
        await page.ask(0.5)
        async with viewer_of(there, page.ready["session"]) as viewer:
            await seen(viewer, moves("/robot"))
            tick = (await page.ask(3.5))["ticks"][0]
            found = await seen(viewer, moves("/robot"))
        position = next(m for m in reversed(found) if moves("/robot")(m))["position"]
        assert position[:2] == pytest.approx([tick["pose"]["x_mm"] / 10, tick["pose"]["y_mm"] / 10], abs=0.25)


async def test_the_page_of_a_replays_scene_stands_beside_its_socket(there):
    async with replay(there, "one") as page, httpx.AsyncClient(base_url=there.url) as client:
        session = page.ready["session"]
        answer = await client.get("/scene/", params={"replay": session, "darkMode": ""})
        assert answer.headers["location"] == f"/scene/{session}/?darkMode="
        scene = await client.get(answer.headers["location"])
        assert scene.headers["content-type"].startswith("text/html")
        assert "unsafe-eval" in scene.headers["content-security-policy"]
        assert (await client.get("/scene/", params={"replay": "gone"})).status_code == 404
        with pytest.raises(Exception, match="403"):
            await viewer_of(there, "gone")


async def test_a_server_that_ends_takes_its_replays_with_it(walked, serve):
    data, _ = walked
    async with serve(create_app(Rig(build_machine(RigFile(), realtime=True)), Archive.open(data))) as there:
        socket = await there.socket("/api/v1/replay?run=one", max_size=None)
        page = Page(socket)
        session = (await page.told())["session"]
        viewer = await viewer_of(there, session)
        await viewer.recv()
        replays, began = sessions_of(there), time.monotonic()
    assert time.monotonic() - began < 5.0
    assert len(replays) == 0
    with pytest.raises(ConnectionClosed) as ended:
        await socket.recv()
    assert farewell(ended)[0] == 1012
    await viewer.close()


async def test_a_recording_that_is_deleted_meanwhile_is_played_to_its_end(there, walked):
    data, _ = walked
    path = data / "recordings" / "two.mcap"
    async with replay(there, "two") as page:
        content = path.read_bytes()
        path.unlink()
        try:
            assert (await page.ask(1.5))["ticks"][0]["run"]["id"] == "two"
        finally:
            path.write_bytes(content)


# At a glance -------------------------------------------------------------------------------------


async def test_the_overview_has_what_a_page_needs_to_draw_the_run(rest, walked):
    _, seen = walked
    overview = (await rest.get("/runs/one/overview")).json()
    series = overview["series"]
    assert (overview["id"], overview["label"], overview["is_whole"]) == ("one", "first", True)
    assert overview["duration_s"] == pytest.approx(WALKED, abs=0.7)
    assert len({len(column) for column in series.values()}) == 1
    assert series["time_s"] == sorted(series["time_s"])
    assert overview["camera"]["size"] == overview["frame_size_px"] == [640, 480]
    assert overview["workspace"] == {"half_mm": 60.0}
    assert overview["robot"] == {"length_mm": 10.0}
    assert len(overview["reference_points_mm"]) > 100
    assert overview["ticks"] >= len(seen)
    assert overview["frames"] > 0
    errors = [error for error in series["error_mm"] if error is not None]
    assert max(errors) == pytest.approx(max(s.error for s in seen if s.error is not None) * 1e3, rel=0.2)


async def test_the_overview_tells_of_the_camera_as_the_rig_does(rest):
    recorded = (await rest.get("/runs/one/overview")).json()["camera"]["model"]
    live = (await rest.get("/camera")).json()["model"]
    assert recorded.keys() == live.keys()
    for name in live:
        assert recorded[name] == pytest.approx(live[name])


async def test_a_torn_recording_has_the_same_curves(rest, walked):
    data, _ = walked
    whole = (await rest.get("/runs/one/overview")).json()
    path = data / "recordings" / "one.mcap"
    content = path.read_bytes()
    try:
        path.write_bytes(content[: len(content) * 2 // 3])
        torn = (await rest.get("/runs/one/overview")).json()
    finally:
        path.write_bytes(content)
    assert not torn["is_whole"]
    assert torn["series"].keys() == whole["series"].keys()
    assert 0.0 < torn["duration_s"] < whole["duration_s"]
    assert len(torn["series"]["time_s"]) > 50


async def test_what_is_no_recording_is_said_to_be_none(rest, walked):
    data, _ = walked
    path = data / "recordings" / "two.mcap"
    content = path.read_bytes()
    try:
        path.write_bytes(b"nothing of this kind")
        refused = await rest.get("/runs/two/overview")
        path.unlink()
        gone = await rest.get("/runs/two/overview")
    finally:
        path.write_bytes(content)
    assert (refused.status_code, gone.status_code) == (409, 404)
    assert "cannot be read" in refused.json()["detail"] or "no recording" in refused.json()["detail"]
    assert (await rest.get("/runs/nobody/overview")).status_code == 404


async def test_the_curves_of_a_part_of_a_run_hold_every_tick_of_it(rest, walked):
    _, seen = walked
    begin = seen[0].time
    answer = await rest.get("/runs/one/series", params={"start_s": 1.0, "end_s": 1.5})
    series = answer.json()["series"]
    within = [shot for shot in seen if 1.0 <= shot.time - begin <= 1.5]
    recorded = [shot.pose.x * 1e3 for shot in within]
    assert series["x_mm"][-len(recorded) :] == pytest.approx(recorded)
    assert all(1.0 <= time <= 1.5 for time in series["time_s"])
    for query in ({"start_s": 2.0, "end_s": 1.0}, {"start_s": 900.0}):
        assert (await rest.get("/runs/one/series", params=query)).json() == {"series": {}}
    assert (await rest.get("/runs/one/series", params={"end_s": "nan"})).status_code == 422
    assert (await rest.get("/runs/none/series")).status_code == 404
