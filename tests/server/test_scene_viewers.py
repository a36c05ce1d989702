"""What each viewer of the scene chooses for itself, through the real server's sockets."""

import asyncio
import json

import cv2
import msgspec
import numpy as np
import pytest
import viser
from scene_visit import messages_in, seen

pytestmark = pytest.mark.anyio

PROTOCOL = f"viser-v{viser.__version__}"
ONE, OTHER = "0123456789abcdef", "fedcba9876543210"
EYE = {
    "type": "ViewerCameraMessage",
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, -30.0, 20.0],
    "fov": 1.0,
    "near": 0.01,
    "far": 1000,
    "image_height": 600,
    "image_width": 800,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 0.0, 1.0],
}


def scene_of(at, viewer):
    return at.socket(f"/scene/live/{viewer}", subprotocols=[PROTOCOL], max_size=None)


def page_of(at, viewer):
    return at.socket(f"/api/v1/scene?viewer={viewer}")


async def say(page, **wish):
    await page.send(json.dumps(wish))


async def told(page, holds):
    async with asyncio.timeout(10.0):
        while not holds(heard := json.loads(await page.recv())):
            pass
        return heard


def switched(layer, *, on):
    return lambda message: (
        message["type"] == "SetSceneNodeVisibilityMessage"
        and (message["name"], message["owner"], message["visible"]) == (f"/{layer}", "viewer", on)
    )


def is_eye(message):
    return message["type"] == "SetCameraPositionMessage" and not message["initial"]


def is_picture(message):
    return message["type"] == "ImageMessage"


async def heard_for(scene, seconds):
    """All messages of some time, s."""
    found = []
    try:
        async with asyncio.timeout(seconds):
            while True:
                found += messages_in(await scene.recv())
    except TimeoutError:
        return found


async def test_a_hidden_layer_is_hidden_from_its_viewer_alone(at):
    async with page_of(at, ONE) as page, scene_of(at, ONE) as mine, scene_of(at, OTHER) as others:
        await seen(mine, switched("coils", on=True))
        await say(page, type="show", layers=["field", "trail"])
        await seen(mine, switched("coils", on=False))
        assert not any(map(switched("coils", on=False), await heard_for(others, 0.5)))


async def test_what_the_page_wants_holds_for_a_scene_that_opens_later(at):
    async with page_of(at, ONE) as page:
        await say(page, type="show", layers=["field"])
        await say(page, type="show", layers=[])
        await asyncio.sleep(0.1)
        async with scene_of(at, ONE) as mine:
            await seen(mine, switched("field", on=False))


async def test_a_hidden_layer_stays_hidden_when_the_rig_is_drawn_anew(at):
    """Viser removes only what the server itself has drawn."""
    scene = at.server.config.app.state.scene.scene
    async with page_of(at, ONE) as page, scene_of(at, ONE) as mine:
        await say(page, type="show", layers=[])
        await seen(mine, switched("coils", on=False))
        await asyncio.to_thread(scene.rebuild, scene._geometry)
        found = await seen(mine, lambda message: message.get("name") == "/coils/x" and "props" in message)
        mine_only = [m for m in found if m.get("name") == "/coils" and m.get("owner") == "viewer"]
        assert mine_only == []


async def test_a_view_leads_the_eye_of_its_viewer_alone_and_ends_where_it_was_asked_to(at):
    async with page_of(at, ONE) as page, scene_of(at, ONE) as mine, scene_of(at, OTHER) as others:
        for scene in (mine, others):
            await scene.send(msgspec.msgpack.encode(EYE))
        await asyncio.sleep(0.2)
        await say(page, type="view", name="overview", smooth=True)
        way = [m["position"] for m in await heard_for(mine, 2.0) if is_eye(m)]
        assert not any(map(is_eye, await heard_for(others, 0.3)))
        assert len(way) > 3
        assert way[0] != way[-1]
        await say(page, type="view", name="overview", smooth=False)
        [there] = [m["position"] for m in await heard_for(mine, 1.0) if is_eye(m)]
        assert there == pytest.approx(way[-1])


async def test_the_camera_is_sent_to_who_has_it_on_and_to_nobody_else(at):
    async with page_of(at, ONE) as page, scene_of(at, ONE) as mine, scene_of(at, OTHER) as others:
        await say(page, type="show", layers=["camera"])
        found = await seen(mine, is_picture)
        [picture] = [m for m in found if is_picture(m)]
        assert picture["props"]["render_width"] == pytest.approx(13.0)
        await seen(mine, lambda m: m["type"] == "SceneNodeUpdateMessage" and m["name"] == picture["name"])
        await say(page, type="show", layers=[])
        await seen(mine, switched("camera", on=False))
        await heard_for(mine, 0.6)
        late = [m for m in await heard_for(mine, 1.0) if m.get("name") == picture["name"]]
        assert late == []
        assert not any(m.get("name") == picture["name"] for m in await heard_for(others, 0.2))
    assert robot_offset(picture["props"]["_data"], at.rig.snapshot.pose) < 0.004


def robot_offset(jpeg, pose):
    """How far the red in the middle of a picture of 130 mm is from the robot, m."""
    picture = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    image = picture.astype(int)
    rows, columns = np.nonzero(image[..., 2] > 1.6 * image[..., :2].max(axis=2) + 30)
    step = 0.130 / (image.shape[0] - 1)
    x, y = columns.mean() * step - 0.065, 0.065 - rows.mean() * step
    return np.hypot(x - pose.x, y - pose.y)


async def test_the_page_hears_whether_its_scene_is_watched_and_what_the_colours_mean(at):
    async with page_of(at, ONE) as page:
        assert await told(page, lambda heard: heard["watching"] is False)
        async with scene_of(at, ONE):
            heard = await told(page, lambda heard: heard["watching"] and heard["full_field_mT"])
            assert heard["full_field_mT"] == 12.0
            await say(page, type="view", name="follow")
            await told(page, lambda heard: heard["follows"])
            await say(page, type="view", name="above")
            await told(page, lambda heard: not heard["follows"])
        await told(page, lambda heard: heard["watching"] is False)


async def test_what_makes_no_sense_is_answered_and_changes_nothing(at):
    async with page_of(at, ONE) as page:
        await page.recv()
        for wish in (
            '{"type": "show", "layers": ["plate"]}',
            '{"type": "view", "name": "backwards"}',
            "field",
            b"\xff",
        ):
            await page.send(wish)
            heard = await told(page, lambda heard: heard["type"] == "problem")
            assert heard["detail"]


async def test_nobody_is_remembered_once_page_and_scene_are_gone(at):
    viewers = at.server.config.app.state.viewers
    async with page_of(at, ONE), scene_of(at, ONE), scene_of(at, OTHER):
        assert len(viewers) == 2
    async with asyncio.timeout(10.0):
        while len(viewers):
            await asyncio.sleep(0.01)


async def test_a_newcomer_after_a_long_day_gets_the_scene_and_not_the_day(at):
    """Viser keeps the newest of each node's values, not all that there were."""
    feed = at.server.config.app.state.scene
    async with scene_of(at, ONE) as mine:
        await seen(mine, switched("field", on=True))
        view = feed._source.view(at.rig.snapshot)
        before = len(feed.scene.server._websock_server.get_message_buffer().message_from_id)

        def a_day():
            for _ in range(500):
                feed.scene.show(view)

        await asyncio.to_thread(a_day)
        kept = len(feed.scene.server._websock_server.get_message_buffer().message_from_id)
    assert kept < before + 40
