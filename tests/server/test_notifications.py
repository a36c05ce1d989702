"""Who is away is told of faults and of ends, as the rig file says; whoever does not answer holds up nothing."""

import asyncio
import contextlib

import pytest
from rig_visit import TIMEOUT, arm
from test_rig_file_changes import bench

from server.notifier import told_of
from tests.listening_ear import listening

pytestmark = pytest.mark.anyio


@pytest.fixture
async def ear():
    with listening() as one:
        yield one


@pytest.fixture
async def here(serve, tmp_path):
    async with bench(serve, tmp_path / "rig.toml") as one:
        await one.ready()
        yield one


async def heard(ear, number):
    return await asyncio.to_thread(ear.wait_for, number)


async def tell_to(here, ear, **more):
    answer = await here.patch({"notifications": {"webhook_url": ear.url, **more}})
    assert answer.status_code == 200, answer.text
    return answer.json()


async def test_a_fault_is_told_once_with_the_rig_s_name_and_the_key_stays_here(here, ear):
    saved = await tell_to(here, ear)
    assert saved["notifications"]["webhook_url"].endswith("/***")
    assert saved["rebuilt"] is False
    await arm(here.api)
    injected = await here.api.post("/simulation/faults", json={"name": "driver_fault"})
    assert injected.is_success, injected.text
    (told,) = await heard(ear, 1)
    assert (told["event"], told["rig"]) == ("fault", "The paper's rig")
    assert told["message"]
    assert told["time"].endswith("+00:00")
    for text in (
        (await here.api.get("/rig")).text,
        (await here.api.get("/events")).text,
        str(await here.messages()),
    ):
        assert "key-of-the-lab" not in text
    assert "key-of-the-lab" in here.path.read_text()


async def test_it_can_be_changed_while_armed_and_a_masked_address_is_the_own_one(here, ear):
    await tell_to(here, ear)
    await arm(here.api)
    shown = (await here.get("/rig"))["notifications"]["webhook_url"]
    answer = await here.patch({"notifications": {"webhook_url": shown, "timeout_s": 2.0}})
    assert answer.status_code == 200
    assert "key-of-the-lab" in here.path.read_text()
    refusal = await here.patch({"notifications": {"webhook_url": "http://elsewhere/***"}})
    assert refusal.status_code == 422
    assert "hidden part" in refusal.text
    await here.api.post("/disarm")


async def test_the_end_of_an_unattended_run_is_told_where_it_is_asked_for(here, ear):
    await tell_to(here, ear, on=["run"])
    await arm(here.api)
    for unattended in (False, True):
        begun = await here.api.post(
            "/runs", json={"duration_s": 0.4, "unattended": unattended, "label": f"watch {unattended}"}
        )
        assert begun.status_code == 201, begun.text
        await here.until("/state", lambda state: state["run"] is None)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(TIMEOUT):
                await arm(here.api) if (await here.get("/state"))["rig"] == "disarmed" else None
    (told,) = await heard(ear, 1)
    assert told["event"] == "run"
    assert "watch True" in told["message"]


async def test_a_test_says_what_came_of_it(here, ear):
    none = await here.api.post("/notifications/test")
    assert none.status_code == 409
    assert "no webhook is set" in none.json()["detail"]
    await tell_to(here, ear, timeout_s=0.5)
    sent = (await here.api.post("/notifications/test")).json()
    assert (sent["status"], sent["to"]) == (204, ear.url.split("/hooks")[0] + "/***")
    ear.answers = [500]
    refused = await here.api.post("/notifications/test")
    assert refused.status_code == 502
    assert "answered 500" in refused.json()["detail"]
    ear.mute.set()
    late = await here.api.post("/notifications/test")
    assert "has not answered within 0.5 s" in late.json()["detail"]
    assert "key-of-the-lab" not in late.text


async def test_one_that_hangs_holds_up_neither_the_loop_nor_another_test(here, ear):
    await tell_to(here, ear, timeout_s=3.0)
    ear.mute.set()
    first = asyncio.create_task(here.api.post("/notifications/test"))
    await heard(ear, 1)
    second = await here.api.post("/notifications/test")
    assert second.status_code == 409
    before = (await here.get("/state"))["tick"]
    await asyncio.sleep(0.5)
    assert (await here.get("/state"))["tick"] > before
    ear.ending.set()
    await first


def test_what_a_person_has_done_is_told_to_nobody():
    def fault(**more):
        return told_of({"type": "event", "severity": "error", "code": "camera", "message": "lost", **more})

    assert fault() == ("fault", "lost")
    assert fault(code="estop") == (None, "")
    assert fault(severity="warn") == (None, "")
    study = {"name": "Tilt", "state": "finished", "reason": "", "done": 3, "total": 3}
    assert told_of({"type": "study", "event": "ended", "study": study}) == (
        "study",
        "the study Tilt has finished: 3 of 3 runs",
    )
    assert told_of({"type": "study", "event": "progress", "study": study}) == (None, "")
    assert told_of({"type": "run", "event": "listed", "run": None}) == (None, "")
