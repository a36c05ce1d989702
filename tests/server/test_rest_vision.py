"""What the robot looks like, over REST: colours by a click, profiles of lighting, and which blob is meant."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import math
import tomllib
from collections.abc import Callable
from pathlib import Path

import cv2
import httpx
import numpy as np
import pytest

from server.app import create_app
from server.assembly import build_machine
from server.atomic_save import previous_of
from server.rig import Rig
from server.rig_changes import RigChanges
from server.rig_file import RigStore, load_rig_file

pytestmark = pytest.mark.anyio

PATIENCE = 20.0
BLUE = {"hue_deg": [200.0, 260.0], "saturation": [80, 255], "value": [40, 255]}
RED = {"hue_deg": [340.0, 20.0], "saturation": [110, 255], "value": [60, 255]}
COMMENTED = "[vision]\nvalue = [60, 255]   # a red robot\n"


class Bench:
    """A served rig with its file."""

    def __init__(self, at, rig: Rig, store: RigStore) -> None:
        self.rig, self.path = rig, store.path
        self.api = httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=PATIENCE)

    async def get(self, what: str):
        return (await self.api.get(what)).json()

    async def until(self, what: str, condition):
        async with asyncio.timeout(PATIENCE):
            while not condition(answer := await self.get(what)):
                await asyncio.sleep(0.02)
        return answer

    async def ready(self) -> None:
        await self.until("/state", lambda state: state["tracking"] == "locked" and not state["faults"])

    async def robot_px(self) -> tuple[float, float]:
        """Where the robot is in the picture."""
        await self.until("/vision", lambda vision: vision["tracking"] == "locked")
        pose = self.rig.snapshot.pose
        assert pose is not None
        return self.rig.machine.camera_model.to_pixel(pose.x, pose.y, self.rig.machine.body_height)

    async def change(self, **changes) -> httpx.Response:
        return await self.api.patch("/vision", json=changes)

    def in_use(self) -> dict:
        """The colours that the tracker itself has."""
        colour = self.rig.machine.tracker._settings.colour
        return {
            "hue_deg": list(colour.hue),
            "saturation": list(colour.saturation),
            "value": list(colour.value),
        }

    def on_disk(self) -> dict:
        return tomllib.loads(self.path.read_text())["vision"]


@contextlib.asynccontextmanager
async def bench(serve, store: RigStore):
    rig = Rig(build_machine(store.settings, realtime=True))
    changes = RigChanges(rig, store, lambda settings: settings)
    async with serve(create_app(rig, changes=changes)) as at:
        one = Bench(at, rig, store)
        async with one.api:
            yield one


@pytest.fixture
async def here(serve, tmp_path: Path):
    path = tmp_path / "rig.toml"
    path.write_text(COMMENTED)
    async with bench(serve, RigStore(path)) as one:
        yield one


def fits(colour: dict, hue: float) -> bool:
    low, high = colour["hue_deg"]
    return low <= hue <= high if low <= high else hue >= low or hue <= high


async def test_what_the_robot_is_looked_for_by_is_told_with_whether_it_is_seen(here):
    await here.ready()
    vision = await here.get("/vision")
    assert vision["profile"] == "default"
    assert vision["profiles"] == ["default"]
    assert vision["colour"] == RED
    assert vision["end_mark"] is None
    assert vision["area_mm2"] == [12.0, 90.0]
    assert vision["heading_hint_deg"] == 90.0
    assert vision["tracking"] == "locked"
    assert vision["reason"] == ""


async def test_a_click_on_the_robot_proposes_its_colour_and_changes_nothing(here):
    u, v = await here.robot_px()
    before = await here.get("/rig")
    answer = await here.api.post("/vision/pick", json={"u": u, "v": v})
    assert answer.status_code == 200, answer.text
    proposal = answer.json()
    assert fits(proposal["colour"], 0.0)
    assert proposal["separation"] == 1.0
    assert proposal["warnings"] == []
    low, high = proposal["area_mm2"]
    assert low < 40.0 < high
    left, top, right, bottom = proposal["box_px"]
    assert left < u < right
    assert top < v < bottom
    assert await here.get("/rig") == before


async def test_however_many_click_one_click_at_a_time_is_looked_at(here):
    u, v = await here.robot_px()
    clicks = (here.api.post("/vision/pick", json={"u": u, "v": v}) for _ in range(6))
    statuses = sorted([answer.status_code for answer in await asyncio.gather(*clicks)])
    assert statuses[0] == 200
    assert 409 in statuses
    assert set(statuses) == {200, 409}
    assert (await here.api.post("/vision/pick", json={"u": u, "v": v})).status_code == 200


async def test_the_proposed_mask_is_a_picture_of_the_cameras_size_that_shows_the_robot_alone(here):
    u, v = await here.robot_px()
    proposal = (await here.api.post("/vision/pick", json={"u": u, "v": v})).json()
    kind, data = proposal["mask_png"].split(",")
    assert kind == "data:image/png;base64"
    layer = cv2.imdecode(np.frombuffer(base64.b64decode(data), np.uint8), cv2.IMREAD_UNCHANGED)
    assert layer is not None
    assert layer.shape == (480, 640, 4)
    left, top, right, bottom = proposal["box_px"]
    assert layer[round(v), round(u), 3] > 0
    assert np.count_nonzero(layer[:, :, 3]) - np.count_nonzero(layer[top:bottom, left:right, 3]) < 50


async def test_a_proposal_that_is_used_finds_the_robot(here):
    u, v = await here.robot_px()
    proposal = (await here.api.post("/vision/pick", json={"u": u, "v": v})).json()
    answer = await here.change(colour=proposal["colour"], area_mm2=proposal["area_mm2"])
    assert answer.status_code == 200, answer.text
    assert answer.json()["colour"] == proposal["colour"]
    await here.ready()


@pytest.mark.parametrize(
    ("place", "words"),
    [((30, 30), "not on a blob"), ((639, 240), "not on a blob"), ((2000, 10), "outside the picture")],
)
async def test_a_click_beside_the_robot_is_answered_with_what_to_do(here, place, words):
    await here.robot_px()
    answer = await here.api.post("/vision/pick", json={"u": place[0], "v": place[1]})
    assert answer.status_code == 422
    assert words in answer.json()["detail"]


async def test_other_colours_hold_from_the_next_frame_on_with_the_same_machine_and_are_saved(here):
    await here.ready()
    machine = here.rig.machine
    assert (await here.change(colour=BLUE)).json()["colour"] == BLUE
    await here.until("/vision", lambda vision: vision["tracking"] == "lost")
    assert here.rig.machine is machine
    assert (await here.get("/rig"))["vision"]["hue_deg"] == BLUE["hue_deg"]
    assert load_rig_file(here.path) == here.rig.settings
    assert "# a red robot" in here.path.read_text()
    assert previous_of(here.path).read_text() == COMMENTED
    assert (await here.api.post("/rig/undo")).status_code == 200
    assert (await here.get("/vision"))["colour"] == RED
    await here.ready()
    assert here.rig.machine is machine
    assert here.path.read_text() == COMMENTED


async def test_the_mask_view_shows_the_colour_in_use_now(here):
    await here.ready()
    whites = []
    for colour in (RED, BLUE):
        await here.change(colour=colour)
        frame = here.rig.frame
        await here.until("/state", lambda _, seen=frame: here.rig.frame is not seen)
        jpeg = (await here.api.get("/camera/snapshot.jpg?view=mask")).content
        mask = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_GRAYSCALE)
        assert mask is not None
        whites.append(int(np.count_nonzero(np.greater(mask, 128))))
    assert whites[0] > 300
    assert whites[1] < 100


async def test_a_profile_for_each_light_is_saved_switched_to_and_deleted(here):
    await here.ready()
    answer = await here.api.post("/vision/profiles", json={"name": "evening lamp"})
    assert answer.status_code == 201, answer.text
    assert answer.json()["profile"] == "evening lamp"
    assert answer.json()["profiles"] == ["default", "evening lamp"]
    dimmer = {**RED, "value": [30, 255]}
    assert (await here.change(colour=dimmer)).json()["colour"] == dimmer
    assert here.on_disk()["profiles"]["evening lamp"]["value"] == [30, 255]
    assert here.on_disk()["value"] == [60, 255]
    await here.ready()
    assert (await here.change(profile="default")).json()["colour"] == RED
    assert (await here.change(profile="evening lamp")).json()["colour"] == dimmer
    assert (await here.api.delete("/vision/profiles/evening lamp")).status_code == 409
    both = (await here.change(profile="default", colour={**RED, "value": [50, 255]})).json()
    assert (both["profile"], both["colour"]["value"]) == ("default", [50, 255])
    answer = await here.api.delete("/vision/profiles/evening lamp")
    assert answer.json()["profiles"] == ["default"]
    assert "profiles" not in here.on_disk()
    assert "# a red robot" in here.path.read_text()
    assert load_rig_file(here.path) == here.rig.settings


async def test_a_profile_needs_a_name_that_is_new_and_plain(here):
    await here.ready()
    for name, status in (("default", 409), ("", 422), ("../etc", 422), ("x" * 60, 422), ("day\n", 422)):
        assert (await here.api.post("/vision/profiles", json={"name": name})).status_code == status, name
    assert (await here.api.post("/vision/profiles", json={"name": "day"})).status_code == 201
    assert (await here.api.post("/vision/profiles", json={"name": "day"})).status_code == 409
    assert (await here.change(profile="night")).status_code == 422
    assert (await here.api.delete("/vision/profiles/night")).status_code == 404
    assert (await here.api.delete("/vision/profiles/default")).status_code == 409
    refused = await here.api.post("/vision/profiles", json={"name": "lamp "})
    assert refused.status_code == 422
    assert "1 to 40 letters" in refused.json()["detail"]


async def test_of_two_who_save_a_profile_under_one_name_at_once_one_is_refused(here):
    await here.ready()
    body = {"name": "day"}
    answers = await asyncio.gather(*(here.api.post("/vision/profiles", json=body) for _ in range(2)))
    assert sorted(answer.status_code for answer in answers) == [201, 409]


async def test_a_profile_saved_and_a_change_of_colours_at_once_both_count(here):
    await here.ready()
    _, saved = await asyncio.gather(
        here.change(colour=BLUE), here.api.post("/vision/profiles", json={"name": "day"})
    )
    assert saved.status_code == 201
    assert here.on_disk()["profiles"]["day"]["hue_deg"] == BLUE["hue_deg"]
    now = await here.get("/vision")
    assert (now["profile"], now["colour"]) == ("day", BLUE)


async def test_an_end_mark_has_colours_of_its_own_in_each_profile(here):
    await here.ready()
    assert (await here.change(end_mark=BLUE)).json()["end_mark"] == BLUE
    assert here.on_disk()["end_mark"]["hue_deg"] == [200.0, 260.0]
    await here.api.post("/vision/profiles", json={"name": "day"})
    assert (await here.change(end_mark=None)).json()["end_mark"] is None
    assert (await here.change(profile="default")).json()["end_mark"] == BLUE
    assert (await here.change(end_mark=None)).json()["end_mark"] is None
    assert "end_mark" not in here.on_disk()
    await here.ready()


async def test_the_other_heading_holds_at_once(here):
    await here.ready()
    before = here.rig.snapshot.pose.heading
    await here.change(heading_hint_deg=-90.0)

    def is_turned(_) -> bool:
        pose = here.rig.snapshot.pose
        return pose is not None and math.cos(pose.heading - before) < -0.9

    await here.until("/state", is_turned)
    await here.ready()


@pytest.mark.parametrize(
    "body",
    [
        {"colour": {**RED, "saturation": [200, 100]}},
        {"colour": {**RED, "hue_deg": [0.0, 400.0]}},
        {"colour": {"hue_deg": [0.0, 40.0]}},
        {"area_mm2": [50.0, 20.0]},
        {"area_mm2": [20.0]},
        {"colour": "red"},
        {"tint": 3},
    ],
)
async def test_looks_that_cannot_be_are_refused_and_nothing_changes(here, body):
    before = await here.get("/vision")
    answer = await here.change(**body)
    assert answer.status_code == 422
    assert answer.json()["detail"]
    assert {**await here.get("/vision"), "tracking": 0, "reason": 0} == {**before, "tracking": 0, "reason": 0}
    assert here.path.read_text() == COMMENTED


async def test_an_armed_rig_keeps_its_colours_and_its_robot_and_says_why(here):
    await here.ready()
    u, v = await here.robot_px()
    assert (await here.api.post("/arm")).status_code == 200
    for answer in (
        await here.change(colour=BLUE),
        await here.api.post("/vision/profiles", json={"name": "day"}),
        await here.api.post("/vision/follow", json={"u": u, "v": v}),
    ):
        assert answer.status_code == 409, answer.text
        assert "disarmed" in answer.json()["detail"]
    assert (await here.api.post("/vision/pick", json={"u": u, "v": v})).status_code == 200
    await here.api.post("/disarm")
    assert (await here.change(colour=BLUE)).status_code == 200


async def test_the_operator_points_at_the_robot(here):
    await here.ready()
    u, v = await here.robot_px()
    answer = await here.api.post("/vision/follow", json={"u": u, "v": v})
    assert answer.status_code == 200, answer.text
    await here.ready()
    assert (await here.api.post("/vision/follow", json={"u": 700.0, "v": 3.0})).status_code == 422


async def test_a_held_rig_is_told_which_blob_is_its_robot(here):
    await here.ready()
    u, v = await here.robot_px()
    await here.api.post("/arm")
    assert (await here.api.post("/runs", json={})).status_code == 201
    assert (await here.api.post("/vision/follow", json={"u": u, "v": v})).status_code == 409
    await here.api.post("/runs/current/pause")
    assert (await here.get("/state"))["rig"] == "held"
    u, v = await here.robot_px()
    answer = await here.api.post("/vision/follow", json={"u": u, "v": v})
    assert answer.status_code == 200, answer.text
    assert (await here.change(colour=BLUE)).status_code == 409
    await here.api.post("/disarm")


async def test_colours_that_cannot_be_saved_are_not_used_either(here):
    await here.ready()
    (previous_of(here.path) / "in the way").mkdir(parents=True)
    assert (await here.change(colour=BLUE)).status_code == 409
    assert (await here.get("/vision"))["colour"] == RED
    assert here.path.read_text() == COMMENTED
    await here.ready()


class Meanwhile(RigStore):
    """A rig file during whose saving something else happens."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.event: Callable[[], object] = lambda: None

    def commit(self, staged, plan) -> None:
        self.event()
        super().commit(staged, plan)


async def test_a_rig_armed_while_its_colours_could_not_be_saved_says_that_they_are_not_in_the_file(
    serve, tmp_path
):
    store = Meanwhile(tmp_path / "rig.toml")
    async with bench(serve, store) as one:
        (previous_of(one.path) / "in the way").mkdir(parents=True)
        await one.ready()
        loop = asyncio.get_running_loop()
        store.event = lambda: asyncio.run_coroutine_threadsafe(one.rig.arm(), loop).result(PATIENCE)
        wider = {**RED, "value": [50, 255]}
        refused = await one.change(colour=wider)
        assert refused.status_code == 409
        assert "values that are not in its file" in refused.json()["detail"]
        assert (await one.get("/vision"))["colour"] == wider == one.in_use()
        store.event = lambda: None
        await one.api.post("/disarm")
        previous_of(one.path).joinpath("in the way").rmdir()
        previous_of(one.path).rmdir()
        assert (await one.change(colour=wider)).status_code == 200
        assert load_rig_file(one.path) == one.rig.settings


async def test_an_edit_on_the_disk_while_a_change_is_made_is_not_overwritten(serve, tmp_path):
    edited = "# my own hand\n[vision]\nvalue = [70, 255]\n"
    store = Meanwhile(tmp_path / "rig.toml")
    async with bench(serve, store) as one:
        await one.ready()
        store.event = lambda: one.path.write_text(edited)
        refused = await one.change(colour=BLUE)
        assert refused.status_code == 409
        assert "reload it first" in refused.json()["detail"]
        assert one.path.read_text() == edited
        assert (await one.get("/vision"))["colour"] == RED == one.in_use()


async def test_an_edit_of_the_colours_on_the_disk_is_taken_without_a_new_machine(here):
    await here.ready()
    machine = here.rig.machine
    here.path.write_text(
        '[vision]\nvalue = [45, 255]\nprofile = "lamp"\n[vision.profiles.lamp]\nvalue = [33, 255]\n'
    )
    answer = await here.api.post("/rig/reload")
    assert answer.status_code == 200, answer.text
    assert answer.json()["rebuilt"] is False
    assert here.rig.machine is machine
    assert (await here.get("/vision"))["colour"]["value"] == [33, 255]
    await here.ready()


async def test_a_change_of_colours_together_with_another_value_builds_the_machine_anew(here):
    await here.ready()
    machine = here.rig.machine
    answer = await here.api.patch("/rig", json={"vision": {"value": [50, 255]}, "robot": {"lift_ratio": 3.0}})
    assert answer.json()["rebuilt"] is True
    assert here.rig.machine is not machine
    assert (await here.get("/vision"))["colour"]["value"] == [50, 255]
