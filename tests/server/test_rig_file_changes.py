"""The rig file changed while the rig runs (faults.md row 32): whole or not at all, and only when it is disarmed."""

import asyncio
import contextlib
import json
import struct
import threading
from pathlib import Path

import cv2
import httpx
import numpy as np
import pytest
import viser
import zstandard
from rig_file_bench import PATIENCE, RigFileBench

from control.coil_heat import CoilHeat
from server.app import create_app
from server.archive import Archive
from server.assembly import Machine, build_machine
from server.atomic_save import previous_of
from server.rig import Rig
from server.rig_changes import RigChanges
from server.rig_file import RigStore, load_rig_file
from server.settings import RigFile
from tests.processes import started

pytestmark = pytest.mark.anyio


class Bench(RigFileBench):
    """Whose file is changed."""

    async def patch(self, changes) -> httpx.Response:
        return await self.api.patch("/rig", json=changes)

    async def messages(self) -> list[str]:
        return [event["message"] for event in (await self.get("/events"))["events"]]


@contextlib.asynccontextmanager
async def bench(serve, path: Path, build=None):
    store = RigStore(path)
    archive = Archive.open(path.parent)
    rig = Rig(build_machine(store.settings, realtime=True), build, archive.recorder)
    changes = RigChanges(rig, store, lambda settings: settings)
    async with serve(create_app(rig, archive, changes=changes)) as at:
        one = Bench(at, rig, path)
        async with one.api:
            yield one


@pytest.fixture
async def here(serve, tmp_path: Path):
    async with bench(serve, tmp_path / "rig.toml") as one:
        yield one


async def test_the_values_say_which_file_they_come_from(here):
    rig = await here.get("/rig")
    assert rig["file"] == {
        "path": str(here.path), "saved": False, "previous": None, "changed_on_disk": False, "overridden": [],
    }  # fmt: skip
    assert rig["version"] == 1
    await here.patch({"limits": {"field_mT": 12.0}})
    assert (await here.get("/rig"))["file"]["saved"] is True
    assert load_rig_file(here.path).limits.field_mT == 12.0


async def test_a_change_is_in_force_at_once_and_the_rig_can_be_armed_again(here):
    await here.ready()
    answer = (await here.patch({"limits": {"field_mT": 5.0}})).json()
    assert (answer["changed"], answer["rebuilt"]) == (["limits.field_mT"], True)
    await here.ready()
    refusal = await here.api.post("/arm")
    assert refusal.status_code == 409
    assert "beyond this rig's 5 mT" in refusal.json()["detail"]
    await here.patch({"limits": {"field_mT": None}})
    await here.ready()
    assert (await here.api.post("/arm")).json()["rig"] == "armed"
    await here.api.post("/disarm")


async def test_who_watches_goes_on_watching_and_sees_the_new_rig(here):
    await here.ready()
    async with (
        here.at.socket("/api/v1/telemetry") as telemetry,
        here.at.socket("/api/v1/camera?view=overlay") as camera,
    ):
        await telemetry.recv()
        first = await picture(camera)
        await here.patch({"camera": {"size_px": [320, 240]}})
        async with asyncio.timeout(PATIENCE):
            while await picture(camera) != (240, 320, 3):
                pass
            while (message := json.loads(await telemetry.recv()))["type"] != "rig":
                pass
    assert first == (480, 640, 3)
    assert message["settings"]["camera"]["size_px"] == [320, 240]
    assert (await here.get("/camera"))["size"] == [320, 240]


async def picture(camera) -> tuple[int, ...]:
    """Height, width and channels of the next picture."""
    data = await camera.recv()
    await camera.send("next")
    return np.asarray(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)).shape


async def test_while_it_is_armed_only_what_nothing_is_built_from_can_change(here):
    await here.ready()
    await here.api.post("/arm")
    refusal = await here.patch({"name": "Bench 9", "limits": {"field_mT": 12.0}, "robot": {"length_mm": 9.0}})
    assert refusal.status_code == 409
    assert [error["field"] for error in refusal.json()["errors"]] == ["limits.field_mT", "robot.length_mm"]
    assert "it is armed" in refusal.json()["detail"]
    assert (await here.get("/rig"))["name"] == "The paper's rig"
    assert not here.path.exists()
    answer = (await here.patch({"name": "Bench 9"})).json()
    assert (answer["name"], answer["rebuilt"]) == ("Bench 9", False)
    assert (await here.get("/state"))["rig"] == "armed"
    assert load_rig_file(here.path).name == "Bench 9"


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"limits": {"field_mT": -1.0}}, "limits.field_mT"),
        ({"limits": {"field_mT": "many"}}, "limits.field_mT"),
        ({"robot": {"lenght_mm": 10.0}}, "robot.lenght_mm"),
        ({"robot": 3}, "robot"),
        ({"camera": {"size_px": [640, "high"]}}, "camera.size_px.1"),
        ({"limits": {"workspace_mm": 900.0}}, ""),
        ({"version": 2}, "version"),
    ],
)
async def test_a_value_that_cannot_be_used_is_named_and_nothing_changes(here, changes, field):
    before = await here.get("/rig")
    answer = await here.patch({"name": "Bench 10", **changes})
    assert answer.status_code == 422
    assert [error["field"] for error in answer.json()["errors"]] == [field]
    assert await here.get("/rig") == before
    assert not here.path.exists()


@pytest.mark.parametrize("body", [b"[1]", b'"x"', b"3", b"{", b'{"limits": {"field_mT": NaN}}'])
async def test_a_body_that_is_no_object_is_refused(here, body):
    answer = await here.api.patch("/rig", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422


async def test_two_changes_at_once_both_count(here):
    answers = await asyncio.gather(
        *(here.patch({"limits": {"field_mT": 10.0 + number}}) for number in range(3)),
        here.patch({"name": "Bench 11"}),
        here.patch({"robot": {"body_width_mm": 5.0}}),
        here.patch({"link": {"ramp_ms": 60}}),
    )
    assert [answer.status_code for answer in answers] == [200] * 6
    saved = load_rig_file(here.path)
    assert (saved.name, saved.robot.body_width_mm, saved.link.ramp_ms) == ("Bench 11", 5.0, 60)
    assert saved == here.rig.settings
    await here.ready()


async def test_the_change_before_comes_back_by_undo_and_goes_again_by_another(here):
    await here.patch({"limits": {"field_mT": 12.0}})
    await here.patch({"limits": {"field_mT": 11.0}})
    for field in (12.0, 11.0):
        assert (await here.api.post("/rig/undo")).json()["limits"]["field_mT"] == field
        assert load_rig_file(here.path).limits.field_mT == field


async def test_undo_before_anything_was_saved_says_so(here):
    answer = await here.api.post("/rig/undo")
    assert answer.status_code == 409
    assert "there is nothing to undo" in answer.json()["detail"]


async def test_the_very_first_save_can_be_undone(here):
    field = here.rig.settings.limits.field_mT
    assert (await here.patch({"limits": {"field_mT": 12.0}})).json()["file"]["previous"]
    assert (await here.api.post("/rig/undo")).json()["limits"]["field_mT"] == field
    assert load_rig_file(here.path) == here.rig.settings == RigFile()
    assert (await here.api.post("/rig/undo")).json()["limits"]["field_mT"] == 12.0


async def test_a_camera_that_cannot_be_opened_leaves_the_rig_as_it_was(here):
    await here.patch({"limits": {"field_mT": 12.0}})
    await here.ready()
    text = here.path.read_text()
    answer = await here.patch({"camera": {"uri": "v4l:///dev/nothing"}, "link": {"port": "/dev/nothing"}})
    assert answer.status_code == 409
    assert "is as it was: camera /dev/nothing is not plugged in" in answer.json()["detail"]
    assert here.path.read_text() == text
    assert (await here.get("/rig"))["camera"]["uri"] == "sim://"
    await here.ready()
    assert (await here.api.post("/arm")).json()["rig"] == "armed"


async def test_an_edit_on_the_disk_is_announced_and_applied_when_somebody_asks(here):
    await here.patch({"limits": {"field_mT": 12.0}})
    async with here.at.socket("/api/v1/telemetry?rate_Hz=1") as telemetry:
        here.path.write_text(here.path.read_text().replace("12.0", "13.0"))
        async with asyncio.timeout(PATIENCE):
            while (message := json.loads(await telemetry.recv()))["type"] != "rig":
                pass
    assert message["file"]["changed_on_disk"] is True
    assert "was changed on disk (limits.field_mT)" in (await here.messages())[0]
    assert (await here.get("/rig"))["limits"]["field_mT"] == 12.0
    refusal = await here.patch({"name": "Bench 12"})
    assert refusal.status_code == 409
    assert "reload it first" in refusal.json()["detail"]
    answer = (await here.api.post("/rig/reload")).json()
    assert (answer["changed"], answer["limits"]["field_mT"]) == (["limits.field_mT"], 13.0)
    assert answer["file"]["changed_on_disk"] is False
    assert load_rig_file(previous_of(here.path)).limits.field_mT == 12.0, "what ran before the edit is kept"


async def test_what_is_told_last_of_an_applied_file_is_that_it_is_in_force(here):
    """A page that asks when the new rig tells of its settings hears that its file is another one."""
    await here.patch({"limits": {"field_mT": 12.0}})
    here.path.write_text(here.path.read_text().replace("12.0", "13.0"))
    await here.until("/rig", lambda rig: rig["file"]["changed_on_disk"])
    told = []
    async with here.at.socket("/api/v1/telemetry?rate_Hz=1") as telemetry:
        await here.api.post("/rig/reload")
        async with asyncio.timeout(PATIENCE):
            while not (told and "file" in told[-1]):
                message = json.loads(await telemetry.recv())
                if message["type"] == "rig":
                    told.append(message)
    assert "settings" in told[0]
    assert told[-1]["file"]["changed_on_disk"] is False


async def test_an_emptied_file_is_an_edit_too(here):
    await here.patch({"limits": {"field_mT": 12.0}})
    here.path.write_text("")
    await here.until("/rig", lambda rig: rig["file"]["changed_on_disk"])


async def test_an_edit_that_cannot_be_used_is_announced_and_the_rig_goes_on(here):
    await here.patch({"limits": {"field_mT": 12.0}})
    here.path.write_text("[limits]\nfield_mT = -3.0\n")
    rig = await here.until("/rig", lambda rig: rig["file"]["changed_on_disk"])
    assert rig["limits"]["field_mT"] == 12.0
    assert (
        "limits.field_mT: Input should be greater than 0 (given: -3.0) (line 2)" in (await here.messages())[0]
    )
    answer = await here.api.post("/rig/reload")
    assert answer.status_code == 409
    assert "line 2" in answer.json()["detail"]
    await here.ready()


async def test_an_emergency_stop_during_the_exchange_holds_for_the_new_rig(serve, tmp_path: Path):
    building, go_on = threading.Event(), threading.Event()

    def slowly(settings: RigFile) -> Machine:
        building.set()
        assert go_on.wait(PATIENCE)
        return build_machine(settings, realtime=True)

    async with bench(serve, tmp_path / "rig.toml", slowly) as one:
        await one.ready()
        change = asyncio.create_task(one.patch({"limits": {"field_mT": 12.0}}))
        await asyncio.to_thread(building.wait, PATIENCE)
        stopped = await one.api.post("/estop")
        assert stopped.status_code == 200
        go_on.set()
        assert (await change).status_code == 200
        await one.until("/state", lambda state: state["rig"] == "fault")
        assert (await one.api.post("/arm")).status_code == 409
        await one.api.post("/reset")
        await one.ready()
        assert (await one.api.post("/arm")).json()["rig"] == "armed"


async def test_a_rig_that_cannot_be_opened_either_way_waits_until_its_devices_are_back(serve, tmp_path: Path):
    video, away = tmp_path / "robot.avi", tmp_path / "away.avi"
    write_video(video)
    with started("control.simulation.board_process", "--control-port", "0", "--linger", "60") as (_, line):
        port = line.split()[1].removeprefix("serial=")
        path = tmp_path / "rig.toml"
        path.write_text(f'[camera]\nuri = "file://{video}"\nsize_px = [64, 64]\n[link]\nport = "{port}"\n')
        async with bench(serve, path) as one:
            video.rename(away)
            answer = await one.patch({"limits": {"field_mT": 12.0}})
            assert answer.status_code == 409
            assert "cannot be opened any more" in answer.json()["detail"]
            state = await one.get("/state")
            assert state["rig"] == "fault"
            assert "see to its devices" in state["reason"]
            assert (await one.api.post("/estop")).status_code == 200
            away.rename(video)
            assert (await one.api.post("/rig/reload")).status_code == 200
            state = await one.until("/state", lambda state: state["link"]["state"] == "ready")
            assert state["rig"] == "fault", "the stop was asked of a rig that was not there"
            assert load_rig_file(path).limits.field_mT == 15.0


def write_video(path: Path) -> None:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, (64, 64))
    for shade in range(30):
        writer.write(np.full((64, 64, 3), 4 * shade, np.uint8))
    writer.release()


async def test_the_scene_is_drawn_anew_for_who_looks_at_it(here):
    protocol = f"viser-v{viser.__version__}"
    async with here.at.socket("/scene", subprotocols=[protocol], max_size=None) as viewer:
        await labels(viewer, "x coils, 390 mm", "120 mm")
        await here.patch({"coils": {"x": {"diameter_mm": 400.0}}, "limits": {"workspace_mm": 100.0}})
        await labels(viewer, "x coils, 400 mm", "100 mm")


async def labels(viewer, *texts: str) -> None:
    """Until the scene has carried these texts; they travel in compressed messages."""
    missing = {text.encode() for text in texts}
    async with asyncio.timeout(PATIENCE):
        while missing:
            data = uncompressed(await viewer.recv())
            missing -= {text for text in missing if text in data}


def uncompressed(data: bytes) -> bytes:
    whole, compressed = struct.unpack_from("<QQ", data)
    return zstandard.ZstdDecompressor().decompress(data[16 : 16 + compressed], max_output_size=whole)


async def test_hot_coils_stay_hot_through_an_exchange(here):
    here.rig.machine.loop.coil_heat = CoilHeat((0.5, 0.4, 0.3))
    bore = here.rig.settings.limits.continuous_A
    await here.patch({"limits": {"continuous_A": [bore[0] / 2.0, bore[1], bore[2]]}})
    x, y, z = here.rig.machine.loop.coil_heat.shares
    assert (x, y, z) == pytest.approx((2.0, 0.4, 0.3), rel=0.01), "half the current: a quarter of the heat"
