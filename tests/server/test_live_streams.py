import asyncio
import json
import socket
import time

import httpx
import pytest
from starlette.websockets import WebSocket
from websockets.exceptions import ConnectionClosed

from server.api.sockets import Line
from server.api.sockets import serve as serve_socket
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.settings import RigFile

pytestmark = pytest.mark.anyio

JPEG = b"\xff\xd8\xff"


async def ticks(telemetry, count):
    found = []
    while len(found) < count:
        message = json.loads(await telemetry.recv(), parse_constant=pytest.fail)
        if message["type"] == "tick":
            found.append(message)
    return found


async def test_telemetry_brings_the_state_in_order(at, api):
    async with at.socket("/api/v1/telemetry") as telemetry:
        numbers = [tick["tick"] for tick in await ticks(telemetry, 10)]
    assert numbers == sorted(set(numbers))
    state = (await api.get("/state")).json()
    async with at.socket("/api/v1/telemetry") as telemetry:
        (tick,) = await ticks(telemetry, 1)
    assert set(tick) == {"type", *state}


async def test_the_first_word_of_telemetry_says_who_the_server_is(at, api):
    """A page knows by it that it is of another version, or that the server has started anew."""
    async with at.socket("/api/v1/telemetry") as telemetry:
        greeting = json.loads(await telemetry.recv())
    assert greeting["type"] == "server"
    assert greeting["version"] == (await api.get("/health")).json()["version"]
    async with at.socket("/api/v1/telemetry") as telemetry:
        assert json.loads(await telemetry.recv()) == greeting


@pytest.mark.parametrize("rate", [5.0, 30.0])
async def test_telemetry_keeps_to_the_rate_that_was_asked_for(at, rate):
    async with at.socket(f"/api/v1/telemetry?rate_Hz={rate}") as telemetry:
        await ticks(telemetry, 2)
        start = time.monotonic()
        count = max(5, int(rate / 2))
        await ticks(telemetry, count)
        taken = time.monotonic() - start
    assert taken > 0.9 * (count - 1) / rate


async def test_all_viewers_share_one_text_of_a_tick(at):
    text = at.rig.updates
    async with text.subscribe() as mailbox:
        snapshot = await mailbox.get()
    cache = create_app(at.rig, at.archive).state.tick_text
    assert cache.of(snapshot) is cache.of(snapshot)


async def test_a_viewer_that_does_not_read_delays_nobody_and_is_dropped(at):
    def deaf_viewer():
        deaf = socket.create_connection(("127.0.0.1", at.port))
        deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        deaf.sendall(
            b"GET /api/v1/telemetry HTTP/1.1\r\nHost: %b\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n"
            % at.host.encode()
        )
        return deaf

    before = at.rig.updates.subscribers
    viewers = [deaf_viewer() for _ in range(3)]
    try:
        while at.rig.updates.subscribers < before + 3:
            await asyncio.sleep(0.01)
        big = {"type": "event", "time_s": 0.0, "severity": "info", "code": "test", "message": "x" * 100_000}
        publishing = 0.0
        async with asyncio.timeout(30.0), at.socket("/api/v1/telemetry", max_size=None) as telemetry:
            while at.rig.updates.subscribers > before + 1:
                start = time.perf_counter()
                at.rig.announcements.publish(big)
                publishing = max(publishing, time.perf_counter() - start)
                await ticks(telemetry, 1)
        assert publishing < 0.05
    finally:
        for viewer in viewers:
            viewer.close()


async def test_the_camera_sends_one_picture_for_each_acknowledgement(at):
    async with at.socket("/api/v1/camera") as camera:
        assert (await camera.recv()).startswith(JPEG)
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(camera.recv(), 0.2)
        await camera.send("ok")
        assert (await camera.recv()).startswith(JPEG)


async def test_an_acknowledged_picture_is_the_newest_one(at):
    async with at.socket("/api/v1/camera") as camera:
        first = await camera.recv()
        await asyncio.sleep(0.1)
        index = at.rig.frame.index
        await camera.send("ok")
        second = await camera.recv()
    assert first != second
    assert at.rig.frame.index >= index


@pytest.mark.parametrize("view", ["raw", "overlay", "mask"])
async def test_each_view_is_a_picture_of_its_own(at, api, view):
    answer = await api.get(f"/camera/snapshot.jpg?view={view}")
    assert answer.headers["content-type"] == "image/jpeg"
    assert answer.content.startswith(JPEG)
    async with at.socket(f"/api/v1/camera?view={view}") as camera:
        assert (await camera.recv()).startswith(JPEG)


async def test_any_number_of_viewers_costs_one_encoding_of_a_frame(at):
    pictures = create_app(at.rig, at.archive).state.pictures
    frame = at.rig.frame
    made = await asyncio.gather(*(pictures.encoded(frame, "raw") for _ in range(10)))
    assert all(picture is made[0] for picture in made)
    pictures.close()


async def test_the_mjpeg_stream_goes_on_with_picture_after_picture(at):
    received = b""
    async with (
        httpx.AsyncClient() as client,
        client.stream("GET", f"{at.url}/api/v1/camera/stream.mjpg") as stream,
    ):
        assert stream.headers["content-type"].startswith("multipart/x-mixed-replace")
        async for chunk in stream.aiter_raw():
            received += chunk
            if received.count(b"--picture") > 3:
                break
    part = received.split(b"--picture\r\n")[1]
    head, _, body = part.partition(b"\r\n\r\n")
    length = int(head.split(b"Content-Length: ")[1])
    assert body[:length].startswith(JPEG)
    assert body[length:] == b"\r\n"


async def test_a_flood_of_words_from_a_viewer_ends_its_own_socket_only(at):
    async with at.socket("/api/v1/telemetry") as calm, at.socket("/api/v1/telemetry") as loud:
        await loud.send("x" * 100_000)
        with pytest.raises(ConnectionClosed) as closed:
            await ticks(loud, 1000)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1009
        await ticks(calm, 2)


async def until_frame(rig, index):
    async with asyncio.timeout(10.0):
        while rig.frame.index < index:
            await asyncio.sleep(0.01)


async def whole_stream(at):
    async with httpx.AsyncClient() as client:
        return (await client.get(f"{at.url}/api/v1/camera/stream.mjpg", timeout=10.0)).content


async def test_the_end_comes_soon_with_every_kind_of_viewer_and_leaves_no_task_or_port(serve, tmp_path):
    tasks = asyncio.all_tasks()
    archive = Archive.open(tmp_path)
    rig = Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder)
    async with serve(create_app(rig, archive)) as at:
        telemetry, camera = await at.socket("/api/v1/telemetry"), await at.socket("/api/v1/camera")
        await telemetry.recv()
        await camera.recv()
        deaf = socket.create_connection(("127.0.0.1", at.port))
        deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        deaf.sendall(b"GET /api/v1/camera/stream.mjpg HTTP/1.1\r\nHost: %b\r\n\r\n" % at.host.encode())
        listening = asyncio.create_task(whole_stream(at))
        await until_frame(rig, 30)
        start = time.monotonic()
    assert time.monotonic() - start < 1.5
    for viewer in (telemetry, camera):
        with pytest.raises(ConnectionClosed):
            await ticks(viewer, 1000) if viewer is telemetry else await viewer.recv()
    deaf.close()
    assert (await listening).count(b"--picture") > 0
    async with asyncio.timeout(2.0):
        while {task for task in asyncio.all_tasks() - tasks if not task.done()}:
            await asyncio.sleep(0.01)
    with pytest.raises(OSError, match="refused"):
        socket.create_connection(("127.0.0.1", at.port), timeout=1.0)


async def test_a_client_that_goes_while_several_things_are_sent_to_it_ends_its_socket_quietly():
    for _ in range(20):  # which sender's error is told depends on chance
        socket = socket_of_a_client_that_has_gone()
        await socket.accept()
        line = Line(socket)
        await serve_socket(socket, line.send_text("a tick"), line.send_text("an event"))


def socket_of_a_client_that_has_gone():
    async def receive():
        return {"type": "websocket.connect"}

    async def send(message):
        if message["type"] != "websocket.accept":
            raise OSError("the connection is closed")

    return WebSocket({"type": "websocket", "path": "/", "headers": []}, receive, send)
