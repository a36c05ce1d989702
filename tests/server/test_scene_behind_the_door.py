import asyncio
import inspect
from dataclasses import replace

import msgspec
import numpy as np
import pytest
import viser
from scene_visit import seen
from viser import _messages
from viser.infra import WebsockServer
from websockets.exceptions import InvalidStatus

from control.model import Pose
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.scene import scene as scene_module
from server.scene.bridge import CameraPose, admitted
from server.scene.page import HIDDEN, PAGE, page
from server.scene.robot import ShownRobot
from server.scene.scene import View
from server.scene.shapes import arrows_of
from server.settings import RigFile

pytestmark = pytest.mark.anyio

PROTOCOL = f"viser-v{viser.__version__}"
POSE = {
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


def packed(**changes):
    return msgspec.msgpack.encode({**POSE, **changes})


def viewer_of(at, **options):
    return at.socket("/scene", subprotocols=[PROTOCOL], max_size=None, **options)


def feed_of(at):
    return at.server.config.app.state.scene


async def until(condition):
    async with asyncio.timeout(10.0):
        while not condition():
            await asyncio.sleep(0.01)


def test_the_private_names_that_keep_viser_closed_still_exist():
    """The scene relies on them; when an upgrade renames one, this says so instead of an open tunnel."""
    assert set(CameraPose.__struct_fields__) - {"type"} == set(_messages.ViewerCameraMessage.__annotations__)
    assert issubclass(_messages.ShareUrlRequest, _messages.Message)
    assert issubclass(_messages.ShareUrlDisconnect, _messages.Message)
    assert callable(WebsockServer.unregister_handler)
    assert "unregister_handler" in inspect.getsource(scene_module.start_viser)
    assert "_websock_server" in inspect.getsource(viser.ViserServer.__init__)
    assert "websockets.asyncio.server.serve(" in inspect.getsource(WebsockServer._background_worker)


def test_nobody_can_ask_viser_to_share_itself():
    server = scene_module.start_viser()
    try:
        handlers = set(server._websock_server._incoming_handlers)
        assert not {kind for kind in handlers if "Share" in kind.__name__}
    finally:
        server.stop()


def test_visers_own_panel_is_hidden_in_the_page():
    content, _ = page()
    text = content.decode()
    assert text.index("<style>" + ", ".join(HIDDEN)) < text.index("</head>")
    assert len(text) > len(PAGE.read_text(encoding="utf-8"))


def test_only_a_finite_camera_pose_passes():
    assert admitted(packed()) is not None
    for changes in (
        {"type": "ShareUrlRequest"},
        {"type": "GuiUpdateMessage"},
        {"type": "ShareUrlDisconnect"},
        {"fov": float("nan")},
        {"position": [0.0, float("inf"), 0.0]},
        {"position": [0.0, 0.0]},
        {"wxyz": "abcd"},
        {"extra": 1},
        {"fov": None},
    ):
        assert admitted(packed(**changes)) is None
    for garbage in (b"", b"\xc1", b"{}", packed()[:-1], packed() + b"\x00", msgspec.msgpack.encode([POSE])):
        assert admitted(garbage) is None


async def test_a_newcomer_sees_the_rig_as_it_is_now(at):
    async with viewer_of(at) as viewer:
        found = await seen(
            viewer, lambda message: message["type"] == "SetPositionMessage" and message["name"] == "/robot"
        )
    created = {message["name"] for message in found if "name" in message and "props" in message}
    assert {
        "/coils/x",
        "/coils/y",
        "/coils/z",
        "/plate",
        "/workspace",
        "/field/grid",
        "/robot/body",
    } <= created
    position = [m for m in found if m["type"] == "SetPositionMessage" and m["name"] == "/robot"][-1][
        "position"
    ]
    pose = at.rig.snapshot.pose
    assert position[:2] == pytest.approx([pose.x * 100, pose.y * 100], abs=0.2)


async def test_nothing_is_sent_while_nobody_looks(at):
    feed = feed_of(at)
    await until(lambda: feed.bridge.viewers == 0)
    await asyncio.sleep(0.2)
    counter = feed.scene.server._websock_server.get_message_buffer().message_counter
    await asyncio.sleep(0.3)
    assert feed.scene.server._websock_server.get_message_buffer().message_counter == counter
    async with viewer_of(at) as viewer:
        await viewer.recv()
        await until(lambda: feed.scene.server._websock_server.get_message_buffer().message_counter > counter)


async def test_a_camera_pose_reaches_viser_and_nothing_else_does(at):
    feed = feed_of(at)
    before = feed.bridge.refused
    async with viewer_of(at) as viewer:
        for kind in ("ShareUrlRequest", "GuiUpdateMessage", "ScenePointerMessage"):
            await viewer.send(msgspec.msgpack.encode({"type": kind}))
        await viewer.send("text")
        await until(lambda: feed.bridge.refused == before + 4)
        assert feed.scene.server.get_clients() == {}
        await viewer.send(packed())
        await until(lambda: len(feed.scene.server.get_clients()) == 1)
    await until(lambda: feed.scene.server.get_clients() == {})


async def test_a_viewer_that_leaves_is_no_longer_counted(at):
    feed = feed_of(at)
    async with viewer_of(at) as one, viewer_of(at) as two:
        await one.recv()
        await two.recv()
        assert feed.bridge.viewers == 2
    await until(lambda: feed.bridge.viewers == 0)


@pytest.mark.parametrize("protocols", [None, ["other"]])
async def test_only_a_viser_client_is_let_through(at, protocols):
    with pytest.raises(InvalidStatus):
        await at.socket("/scene", subprotocols=protocols)


async def test_a_page_from_elsewhere_cannot_look(at):
    with pytest.raises(InvalidStatus) as refused:
        await viewer_of(at, origin="http://evil.example")
    assert refused.value.response.status_code == 403


async def test_the_scenes_arrows_and_robot_follow_the_snapshot(at):
    scene = feed_of(at).scene
    path, currents = np.array([[0.0, 0.0], [0.01, 0.0]]), (2.0, -1.0, 0.5)
    walking = ShownRobot(Pose(0.01, 0.02, 0.5), 1, 0.1, path, path[:0])
    await asyncio.to_thread(scene.show, View(scene._geometry, currents, [walking]))
    points, _ = arrows_of(scene._arrows.field(currents), scene._arrows.origins, 0.012)
    assert scene._field.visible
    assert scene._field_at_robot.visible
    assert scene._field.points == pytest.approx(points * 100, abs=1e-4)
    [robot] = scene.robots
    assert robot.body.position[:2] == pytest.approx([1.0, 2.0], abs=0.1)
    assert (robot.lines["path"].visible, robot.lines["trail"].visible) == (True, False)
    lost = replace(walking, pose=None, trail=path)
    await asyncio.to_thread(scene.show, View(scene._geometry, (0.0, 0.0, 0.0), [lost]))
    assert not scene._field.visible
    assert not scene._field_at_robot.visible
    assert not robot.body.visible


async def test_a_scene_that_ends_closes_the_sockets_of_its_viewers(serve, tmp_path):
    archive = Archive.open(tmp_path)
    rig = Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder)
    async with serve(create_app(rig, archive)) as at, viewer_of(at) as viewer:
        await viewer.recv()
        feed = feed_of(at)
        await asyncio.get_running_loop().run_in_executor(None, feed.scene.stop)
        async with asyncio.timeout(10.0):
            await viewer.wait_closed()
        await until(lambda: feed.bridge.viewers == 0)
        async with at.socket("/api/v1/telemetry") as telemetry:
            await telemetry.recv()
