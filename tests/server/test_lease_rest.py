"""Who may drive, over REST and WebSocket: one client at a time; everybody may stop."""

import asyncio
import contextlib
import json
from functools import partial

import httpx
import pytest

from tests.server.rig_visit import TIMEOUT, act, arm, until

pytestmark = pytest.mark.anyio


@pytest.fixture
async def client(at):
    """Makes clients by name, each another one for the server; those of a page are known by their Origin."""
    async with contextlib.AsyncExitStack() as open_clients:

        async def make(name, *, is_page=False):
            headers = {"X-Client": name} | ({"Origin": at.url} if is_page else {})
            made = httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=TIMEOUT, headers=headers)
            return await open_clients.enter_async_context(made)

        yield make


@pytest.fixture
async def ada(client):
    return await client("Ada")


@pytest.fixture
async def bob(client):
    return await client("Bob")


@pytest.fixture(autouse=True)
async def nobody_operates(at, api):
    """Each test begins, and ends, with a free lease and a rig at rest."""
    yield
    await api.post("/disarm")
    at.rig.attendance.lease = type(at.rig.attendance.lease)(term=at.rig.attendance.lease.term)


async def operator(api):
    return (await api.get("/operator")).json()


async def silent(at):
    """Until the holder has not been heard for longer than the lease; nothing is asked meanwhile."""
    async with asyncio.timeout(TIMEOUT):
        async with at.rig.updates.subscribe() as ticks:
            while not at.rig.attendance.absence(walking=True):
                await ticks.get()


async def held(at):
    async with asyncio.timeout(TIMEOUT), at.rig.updates.subscribe() as ticks:
        while (snapshot := await ticks.get()).rig != "held":
            assert snapshot.rig in ("running", "armed"), snapshot.reason
        return snapshot


async def test_the_first_command_takes_a_free_lease(ada, bob):
    assert (await operator(ada))["holder"] is None
    await act(ada, "/manual", 409, pivot=1, rate_deg_s=0.0)
    found = await operator(bob)
    assert found["holder"]["name"] == "Ada"
    assert found["holder"]["kind"] == "script"
    assert found["holder"]["id"] != found["you"]
    assert "Ada" not in found["holder"]["id"]


async def test_others_are_told_who_operates_and_may_stop_all_the_same(ada, bob):
    await arm(ada)
    await act(ada, "/runs", 201)
    refusal = await bob.post("/runs/current/resume")
    assert refusal.status_code == 409
    assert refusal.json()["title"] == "Somebody else operates"
    assert refusal.json()["holder"]["name"] == "Ada"
    await act(bob, "/runs/current/pause")
    await act(ada, "/runs/current/resume")
    await act(bob, "/runs/current/stop")
    assert (await act(bob, "/disarm"))["rig"] == "disarmed"
    assert (await act(bob, "/estop"))["rig"] == "fault"
    await act(bob, "/reset", 409)
    await act(ada, "/reset")


COMMANDS = [
    ("POST", "/arm", None),
    ("POST", "/reset", None),
    ("POST", "/manual", {"pivot": 1, "rate_deg_s": 0.0}),
    ("POST", "/runs", {}),
    ("PATCH", "/runs/current", {}),
    ("POST", "/runs/current/resume", None),
    ("PATCH", "/rig", {"name": "mine"}),
    ("POST", "/rig/import", {"toml": "", "apply": True}),
    ("POST", "/rig/reload", None),
    ("POST", "/rig/undo", None),
    ("PATCH", "/vision", {"heading_hint_deg": 0.0}),
    ("POST", "/vision/follow", {"u": 1.0, "v": 1.0}),
    ("POST", "/vision/profiles", {"name": "evening"}),
    ("DELETE", "/vision/profiles/evening", None),
    ("POST", "/calibration/star", None),
    ("POST", "/calibration/latency", None),
    ("POST", "/calibration/star/save", None),
    ("POST", "/calibration/save", None),
    ("DELETE", "/calibration", None),
    ("POST", "/simulation/faults", {"name": "robot_hidden"}),
    ("DELETE", "/simulation/faults", None),
    ("DELETE", "/simulation/faults/robot_hidden", None),
    ("PUT", "/simulation/board", {"shown": False}),
]


@pytest.mark.parametrize(("method", "path", "body"), COMMANDS)
async def test_what_changes_what_the_rig_does_is_the_operators(ada, bob, method, path, body):
    await act(ada, "/operator")
    before = (await ada.get("/state")).json()["rig"], (await ada.get("/rig")).json()["name"]
    answer = await bob.request(method, path, json=body)
    assert answer.status_code == 409, answer.text
    assert answer.json()["title"] == "Somebody else operates", answer.text
    assert before == ((await ada.get("/state")).json()["rig"], (await ada.get("/rig")).json()["name"])


async def test_the_selection_is_the_operators(ada, bob):
    chosen = (await bob.get("/selection")).json()
    await act(ada, "/operator")
    assert (await bob.put("/selection", json=chosen)).status_code == 409
    assert (await ada.put("/selection", json=chosen)).status_code == 200


async def test_the_holder_hands_it_over_or_keeps_it(ada, bob):
    await act(ada, "/operator", note="tuning the gait")
    waiting = await act(bob, "/operator", 202, note="only a minute")
    assert waiting["asking"]["id"] == waiting["you"]
    assert (await operator(ada))["asking"]["note"] == "only a minute"
    await act(bob, "/operator", 409, answer="grant")
    assert (await act(ada, "/operator", answer="refuse"))["asking"] is None
    await act(ada, "/operator", 409, answer="grant")
    await act(bob, "/operator", 202)
    handed = await act(ada, "/operator", answer="grant")
    assert handed["holder"]["name"] == "Bob"
    await act(ada, "/manual", 409, pivot=1, rate_deg_s=0.0)


async def test_a_second_asker_sees_who_asks(ada, bob, client):
    eve = await client("Eve")
    await act(ada, "/operator")
    await act(bob, "/operator", 202)
    assert (await act(eve, "/operator", 202))["asking"]["name"] == "Bob"


async def test_the_log_tells_who_takes_asks_and_gives_up(at, ada, bob):
    await act(ada, "/operator", note="a test")
    await act(bob, "/operator", 202)
    await act(ada, "/operator", answer="refuse")
    await ada.delete("/operator")
    said = [event.message for event in at.rig.events if event.code == "operator"][-4:]
    assert said == [
        "Ada operates the rig: a test",
        "Bob asks to operate the rig",
        "Ada keeps the rig; Bob was refused",
        "Ada gave the rig up",
    ]


@pytest.mark.parametrize(
    "body", [{"name": "a\nb"}, {"note": "x" * 201}, {"name": "x" * 61}, {"answer": "yes"}, {"holder": 1}]
)
async def test_a_body_that_cannot_be_meant_is_refused(ada, body):
    answer = await ada.post("/operator", json=body)
    assert answer.status_code == 422
    assert (await operator(ada))["holder"] is None


async def test_everybody_is_told_of_each_change(at, ada):
    async with asyncio.timeout(TIMEOUT), at.socket("/api/v1/telemetry?client=Eve") as line:
        greeting = json.loads(await line.recv())
        assert greeting["you_may"] == "administer"
        assert json.loads(await line.recv()) == {"type": "operator", "holder": None, "asking": None}
        await act(ada, "/operator")
        while (message := json.loads(await line.recv()))["type"] != "operator":
            pass
        assert message["holder"]["name"] == "Ada"
        while (message := json.loads(await line.recv()))["type"] != "tick":
            pass
    assert message["operator"]["name"] == "Ada"


async def test_a_silent_holder_keeps_its_place_until_somebody_takes_it(at, ada, bob):
    await arm(ada)
    await silent(at)
    await act(bob, "/manual", 409, pivot=1, rate_deg_s=0.0)
    assert (await operator(bob))["holder"]["name"] == "Ada"
    assert (await act(bob, "/operator"))["holder"]["name"] == "Bob"
    assert (await ada.post("/arm")).json()["holder"]["name"] == "Bob"


async def test_a_script_that_has_ended_keeps_no_rig_at_rest_from_the_next_one(at, ada, bob):
    await act(ada, "/operator")
    await act(bob, "/reset", 409)
    await silent(at)
    await arm(bob)
    assert (await operator(bob))["holder"]["name"] == "Bob"
    assert (await ada.post("/arm")).json()["holder"]["name"] == "Bob"


async def test_an_attended_run_is_held_when_its_script_says_nothing_more(at, ada):
    await arm(ada)
    await act(ada, "/runs", 201)
    snapshot = await held(at)
    assert "Ada operates and has not been heard for 2 s" in snapshot.reason
    assert any(event.code == "operator" and event.message == snapshot.reason for event in at.rig.events)
    assert snapshot.run is not None
    await ada.get("/state")
    assert (await ada.get("/state")).json()["rig"] == "held", "it does not go on by itself"
    await until(ada, tracking="locked")
    assert (await act(ada, "/runs/current/resume"))["state"] == "running"


async def test_an_unattended_run_goes_on_without_anybody(at, ada):
    await arm(ada)
    await act(ada, "/runs", 201, unattended=True)
    await silent(at)
    async with at.rig.updates.subscribe() as ticks:
        for _ in range(10):
            assert (await ticks.get()).rig == "running"


async def test_what_is_given_up_while_it_is_on_is_held_at_once(at, client):
    page = await client("a-page", is_page=True)
    await arm(page)
    await page.delete("/operator")
    assert "gave the rig up" in (await held(at)).reason


async def test_a_page_lives_by_its_heartbeats_and_not_by_its_requests(at, client):
    page = await client("a-page", is_page=True)
    polling = partial(page.get, "/state", headers={"Sec-Fetch-Site": "same-origin"})
    async with at.socket("/api/v1/telemetry?client=a-page", origin=at.url) as line:

        async def hear():
            async for _ in line:
                pass

        reading = asyncio.create_task(hear())
        await arm(page)
        beat = json.dumps({"type": "heartbeat", "visible": True})
        for _ in range(6):
            await line.send(beat)
            await asyncio.sleep(0.5)
        assert at.rig.snapshot.rig == "armed", at.rig.snapshot.reason
        hidden = json.dumps({"type": "heartbeat", "visible": False})
        async with asyncio.timeout(TIMEOUT):
            while at.rig.snapshot.rig != "held":
                await line.send(hidden)
                await polling()
                await asyncio.sleep(0.1)
        reading.cancel()
    assert "Dashboard at 127.0.0.1" in at.rig.snapshot.reason


async def test_a_run_that_is_handed_over_goes_on(at, ada, bob):
    await arm(ada)
    await act(ada, "/runs", 201)
    await act(bob, "/operator", 202)
    await act(ada, "/operator", answer="grant")
    async with asyncio.timeout(TIMEOUT), at.rig.updates.subscribe() as ticks:
        for _ in range(90):
            await bob.get("/state")
            assert (await ticks.get()).rig == "running", at.rig.snapshot.reason


async def test_who_asks_and_gets_no_answer_takes_over(at, ada, bob):
    """The clock of the lease alone is put forward; the holder is heard all the time."""
    desk = at.rig.attendance
    await act(ada, "/operator")
    await act(bob, "/operator", 202)
    clock = desk._clock
    desk._clock = lambda: clock() + 10.5
    try:
        await ada.get("/state")
        assert (await act(bob, "/operator"))["holder"]["name"] == "Bob"
    finally:
        desk._clock = clock
