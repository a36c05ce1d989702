"""What the robot looks like, over REST: colours by a click, profiles of lighting, and which blob is meant."""

from __future__ import annotations

import asyncio
import base64
import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from vision_bench import BLUE, COMMENTED, RED, bench

from server.atomic_save import previous_of
from server.rig_file import RigStore, load_rig_file

pytestmark = pytest.mark.anyio


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
