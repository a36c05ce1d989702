"""When a picture was captured, for whoever draws over it; pictures alone for whoever does not ask."""

import asyncio
import json

import pytest

pytestmark = pytest.mark.anyio

JPEG = b"\xff\xd8\xff"
TIMEOUT = 10.0


async def test_each_picture_comes_after_the_time_of_its_capture(at):
    seen = []
    async with asyncio.timeout(TIMEOUT), at.socket("/api/v1/camera?with_time=1") as camera:
        for _ in range(5):
            seen.append(json.loads(await camera.recv()))
            assert (await camera.recv()).startswith(JPEG)
            await camera.send("ok")
    assert {about["type"] for about in seen} == {"picture"}
    frames, times = ([about[name] for about in seen] for name in ("frame", "captured_s"))
    assert frames == sorted(set(frames))
    assert times == sorted(set(times))


async def test_the_time_is_that_which_the_tick_of_the_same_frame_tells(at):
    captured = set()
    async with (
        asyncio.timeout(TIMEOUT),
        at.socket("/api/v1/telemetry?rate_Hz=30") as telemetry,
        at.socket("/api/v1/camera?with_time=1") as camera,
    ):
        shown = []
        while not captured & set(shown):
            shown.append(json.loads(await camera.recv())["captured_s"])
            await camera.recv()
            await camera.send("ok")
            message = json.loads(await telemetry.recv())
            captured.add(message.get("captured_s"))


async def test_who_does_not_ask_gets_pictures_alone(at):
    async with asyncio.timeout(TIMEOUT), at.socket("/api/v1/camera") as camera:
        for _ in range(3):
            assert (await camera.recv()).startswith(JPEG)
            await camera.send("ok")
