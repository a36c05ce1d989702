"""Faults on demand over REST, on a simulated rig in real time."""

import asyncio
import json
import time

import httpx
import pytest

from server.app import create_app
from server.assembly import build_machine
from server.rig import Rig
from server.settings import RigFile

pytestmark = pytest.mark.anyio

FAULTS = "/simulation/faults"


async def until(api, condition, within=10.0):
    give_up = time.monotonic() + within
    while not condition(state := (await api.get("/state")).json()):
        assert time.monotonic() < give_up, state["reason"]
        await asyncio.sleep(0.02)
    return state


async def walk(api):
    await api.delete(FAULTS)
    state = (await api.get("/state")).json()
    if state["rig"] == "fault":
        await api.post("/reset", json={})
    elif state["rig"] != "disarmed":
        await api.post("/disarm", json={})
    await until(api, lambda state: state["tracking"] == "locked" and not state["faults"])
    assert (await api.post("/arm", json={})).status_code == 200
    assert (await api.post("/runs", json={"gait": {"sweep_deg": 10.0}})).status_code == 201
    await until(api, lambda state: state["run"] is not None and state["run"]["elapsed_s"] > 0.2)


async def entry(api, name):
    faults = (await api.get(FAULTS)).json()["faults"]
    return next(fault for fault in faults if fault["name"] == name)


async def test_the_catalogue_says_what_there_is_in_words_with_units(api):
    fault = await entry(api, "supply_low")
    assert (fault["row"], fault["family"], fault["title"]) == (14, "board", "Supply low")
    volts = fault["parameters"]["properties"]["supply_V"]
    assert (volts["unit"], volts["minimum"], volts["maximum"]) == ("V", 0.0, 60.0)
    assert fault["injected"] is None
    assert fault["what"]
    assert fault["mends"]


async def test_a_fault_is_put_in_shown_logged_and_taken_away(api):
    await walk(api)
    body = {"name": "supply_low", "parameters": {"supply_V": 5.0}, "duration_s": 600.0}
    answer = await api.post(FAULTS, json=body)
    assert answer.status_code == 201
    assert answer.json()["injected"]["parameters"] == {"supply_V": 5.0}
    state = await until(api, lambda state: state["rig"] == "disarmed")
    assert "supply" in state["reason"]
    events = (await api.get("/events")).json()["events"]
    assert "injected: Supply low" in [event["message"] for event in events]
    answer = await api.delete(f"{FAULTS}/supply_low")
    assert answer.status_code == 200
    assert answer.json()["injected"] is None
    await until(api, lambda state: not state["faults"])


async def test_a_fault_ends_by_itself_after_its_duration(api):
    await api.post(FAULTS, json={"name": "robot_hidden", "duration_s": 0.2})
    await until(api, lambda state: state["tracking"] == "lost")
    await until(api, lambda state: state["tracking"] == "locked")
    assert (await entry(api, "robot_hidden"))["injected"] is None


async def test_a_fault_that_comes_and_goes_says_so(api):
    body = {"name": "camera_unplugged", "intermittent": {"on_s": 0.3, "off_s": 0.3}}
    assert (await api.post(FAULTS, json=body)).status_code == 201
    seen = set()
    give_up = time.monotonic() + 10.0
    while seen != {True, False} and time.monotonic() < give_up:
        seen.add((await entry(api, "camera_unplugged"))["injected"]["is_on"])
        await asyncio.sleep(0.05)
    assert seen == {True, False}
    await api.delete(FAULTS)
    assert all(fault["injected"] is None for fault in (await api.get(FAULTS)).json()["faults"])


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"name": "gremlins"}, "no fault called 'gremlins'"),
        ({}, "name"),
        (
            {"name": "supply_low", "parameters": {"supply_V": 1000.0}},
            "parameters.supply_V: must be less than",
        ),
        ({"name": "supply_low", "parameters": {"supply_V": "much"}}, "parameters.supply_V"),
        ({"name": "supply_low", "parameters": {"volts": 1.0}}, "parameters.volts: is not a known field"),
        ({"name": "coil_open", "parameters": {"coil": "w"}}, "parameters.coil"),
        ({"name": "supply_off", "duration_s": 0.0}, "duration_s"),
        ({"name": "board_reset", "duration_s": 1.0}, "happens once"),
        ({"name": "robot_put", "intermittent": {"on_s": 1.0, "off_s": 1.0}}, "happens once"),
    ],
)
async def test_a_fault_that_cannot_be_is_refused_in_words(api, body, words):
    answer = await api.post(FAULTS, json=body)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
    assert all(fault["injected"] is None for fault in (await api.get(FAULTS)).json()["faults"])


async def test_a_number_that_is_not_finite_is_refused(api):
    text = '{"name": "supply_low", "parameters": {"supply_V": NaN}}'
    answer = await api.post(FAULTS, content=text, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422


async def test_a_fault_that_there_is_not_cannot_be_taken_away(api):
    assert (await api.delete(f"{FAULTS}/gremlins")).status_code == 404


async def test_a_real_rig_has_no_faults_to_inject(at):
    machine = build_machine(RigFile(), realtime=False)
    machine.faults = None
    app = create_app(Rig(machine), at.archive)
    transport = httpx.ASGITransport(app)
    async with httpx.AsyncClient(transport=transport, base_url="http://localhost/api/v1") as client:
        for method, path in (("GET", ""), ("POST", ""), ("DELETE", ""), ("DELETE", "/supply_off")):
            body = {"name": "supply_off"} if method == "POST" else None
            answer = await client.request(method, FAULTS + path, json=body)
            assert answer.status_code == 404, (method, path)
            assert "This rig is real" in answer.json()["detail"]
    machine.close()


def _no_such_number(text):
    raise AssertionError(f"{text} is no JSON")


@pytest.mark.parametrize("name", ["sighting_nan", "report_nan", "camera_timeless"])
async def test_what_is_no_number_never_leaves_the_program(api, at, name):
    """Whatever is not a number inside, no page and no script ever reads NaN."""
    await api.delete(FAULTS)
    await api.post(FAULTS, json={"name": name})
    await asyncio.sleep(0.2)
    async with at.socket("/api/v1/telemetry") as telemetry:
        messages = [await telemetry.recv() for _ in range(10)]
    for text in (*messages, (await api.get("/state")).text, (await api.get("/events")).text):
        json.loads(text, parse_constant=_no_such_number)
    await api.delete(FAULTS)


async def test_a_hanging_controller_is_latched_and_let_go_again(api):
    """When a controller hangs, the page says so within a second, the coils are off, and the fault can be taken away
    although the loop stands still."""
    await walk(api)
    await api.post(FAULTS, json={"name": "controller_hangs", "parameters": {"hang_s": 60.0}})
    state = await until(api, lambda state: state["rig"] == "fault")
    assert "hangs" in state["reason"]
    assert state["currents_A"] == [0.0, 0.0, 0.0]
    assert (await api.delete(f"{FAULTS}/controller_hangs")).status_code == 200
    await until(api, lambda state: state["tick"] > 0 and state["measured_currents_A"] == [0.0, 0.0, 0.0])
    give_up = time.monotonic() + 5.0
    while (answer := await api.post("/reset", json={})).status_code != 200:
        assert time.monotonic() < give_up, answer.text
        await asyncio.sleep(0.05)
    assert answer.json()["rig"] == "disarmed"


async def test_what_is_promised_stands_beside_what_the_rig_did(api):
    """The figures are the rig's own; on a busy computer they may be late, which is what the verdict then says."""
    await walk(api)
    before = await entry(api, "line_unplugged")
    assert before["promise"]["states"] == ["disarmed"]
    assert before["promise"]["noticed_ms"] == 34
    await api.post(FAULTS, json={"name": "line_unplugged"})
    async with asyncio.timeout(10.0):
        while (reaction := (await entry(api, "line_unplugged"))["reaction"])["verdict"] == "watching":
            await asyncio.sleep(0.05)
    await api.delete(FAULTS)
    assert (reaction["was"], reaction["became"]) == ("running", "disarmed")
    assert reaction["reason"]
    assert 0 < reaction["noticed_ms"] < 1000
    assert 0 < reaction["gone_ms"] < 1000
    assert reaction["verdict"] in ("kept", "broken", "open")


async def test_a_rig_at_rest_has_nothing_to_show(api):
    await walk(api)
    await api.post("/disarm", json={})
    await until(api, lambda state: state["rig"] == "disarmed")
    answer = await api.post(FAULTS, json={"name": "camera_frozen"})
    assert answer.json()["reaction"]["verdict"] == "at_rest"
    await api.delete(FAULTS)
