import asyncio
import json

import pytest

pytestmark = pytest.mark.anyio

TIMEOUT = 10.0


async def until(api, **wanted):
    """Poll the state until its fields are as wanted."""
    async with asyncio.timeout(TIMEOUT):
        while True:
            state = (await api.get("/state")).json()
            if all(state[name] == value for name, value in wanted.items()):
                return state
            await asyncio.sleep(0.02)


async def act(api, path, status=200, **body):
    answer = await api.post(path, json=body) if body else await api.post(path)
    assert answer.status_code == status, answer.text
    return answer.json()


@pytest.fixture
async def disarmed(api):
    """The rig at rest, however the test before has left it."""
    await act(api, "/estop")
    await act(api, "/reset")
    await until(api, rig="disarmed", tracking="locked", faults=[])
    return api


async def arm(api):
    """Arm as a person would: once more when the robot, just let go, is still settling."""
    async with asyncio.timeout(TIMEOUT):
        while (answer := await api.post("/arm")).status_code == 409:
            await asyncio.sleep(0.05)
    assert answer.status_code == 200
    return answer.json()


@pytest.fixture
async def armed(disarmed):
    await arm(disarmed)
    await until(disarmed, rig="armed")
    return disarmed


@pytest.fixture
async def running(armed):
    await act(armed, "/runs", 201, label="a walk")
    await until(armed, rig="running")
    return armed


async def test_arming_answers_with_the_state_and_brings_the_field_up(disarmed):
    assert (await arm(disarmed))["rig"] == "armed"
    async with asyncio.timeout(TIMEOUT):
        while max(map(abs, (await until(disarmed, rig="armed"))["currents_A"])) < 1.0:
            await asyncio.sleep(0.02)


async def test_a_run_needs_an_armed_rig_and_says_so(disarmed):
    problem = await act(disarmed, "/runs", 409)
    assert "arm" in problem["detail"]
    assert (await disarmed.get("/state")).json()["run"] is None


async def test_a_run_takes_from_the_selection_what_it_is_not_told(armed):
    selection = (await armed.get("/selection")).json()
    answer = await armed.post(
        "/runs", json={"gait": {"tilt_deg": 20.0}, "label": "flat", "tags": ["x"], "passes": 0.5}
    )
    assert answer.status_code == 201
    run = answer.json()
    assert (run["label"], run["tags"], run["passes"], run["state"]) == ("flat", ["x"], 0.5, "running")
    assert run["gait"] == {**selection["gait"], "tilt_deg": 20.0}
    assert run["controller"] == selection["controller"]
    assert run["trajectory"] == selection["trajectory"]
    assert (await armed.get("/selection")).json() == selection


async def test_the_robot_walks_and_the_state_follows(running):
    async with asyncio.timeout(TIMEOUT):
        while (await until(running, rig="running"))["run"]["elapsed_s"] < 0.5:
            await asyncio.sleep(0.05)
    state = (await running.get("/state")).json()
    assert state["error_mm"] >= 0.0
    assert state["reference"]
    assert state["command"]["field_mT"] == pytest.approx(10.0)


async def test_a_second_run_is_refused_while_one_goes_on(running):
    await act(running, "/runs", 409)
    assert (await running.get("/runs")).json()["runs"][0]["label"] == "a walk"


async def test_a_running_walk_can_be_changed_in_part(running):
    before = (await running.get("/runs/current")).json()
    answer = await running.patch("/runs/current", json={"controller": {"parameters": {"gain": 5.5}}})
    assert answer.status_code == 200
    after = (await running.get("/runs/current")).json()
    assert after["controller"] == {"name": "geometric", "parameters": {"gain": 5.5}}
    assert (after["trajectory"], after["gait"]) == (before["trajectory"], before["gait"])


@pytest.mark.parametrize(
    "body",
    [
        {"gait": {"tilt_deg": 90.0}},
        {"controller": {"name": "magic"}},
        {"trajectory": {"parameters": {"width_mm": 400.0}}},
    ],
)
async def test_a_bad_change_is_refused_and_the_walk_goes_on_as_it_was(running, body):
    before = (await running.get("/runs/current")).json()
    answer = await running.patch("/runs/current", json=body)
    assert answer.status_code == 422
    now = (await running.get("/runs/current")).json()
    for part in ("state", "controller", "trajectory", "gait"):
        assert now[part] == before[part]
    await until(running, rig="running")


async def test_a_run_can_be_held_and_goes_on(running):
    await act(running, "/runs/current/pause")
    state = await until(running, rig="held")
    assert state["run"]["paused"] is True
    await act(running, "/runs/current/resume")
    await until(running, rig="running")


async def test_a_stopped_run_leaves_the_rig_armed_and_its_metrics_in_the_list(running):
    await act(running, "/runs/current/stop")
    await until(running, rig="armed", run=None)
    run = (await running.get("/runs")).json()["runs"][0]
    assert run["state"] == "stopped"
    assert set(run["metrics"]) == {
        "mean_error_mm", "normalized_mean_error", "rms_error_mm", "max_error_mm", "steps", "travelled_mm",
        "end_error_mm", "duration_s", "ticks", "sweeps", "reversals",
    }  # fmt: skip
    one = (await running.get(f"/runs/{run['id']}")).json()
    assert (one["metrics"], one["settings"]["run"]["id"]) == (run["metrics"], run["id"])


async def test_disarming_ends_the_run(running):
    await act(running, "/disarm")
    await until(running, rig="disarmed", run=None)


async def test_an_emergency_stop_latches_until_reset_and_a_new_arming(running):
    await act(running, "/estop")
    state = await until(running, rig="fault")
    assert state["reason"]
    await act(running, "/arm", 409)
    await act(running, "/runs", 409)
    await act(running, "/reset")
    await until(running, rig="disarmed")
    await act(running, "/runs", 409)


async def test_an_emergency_stop_succeeds_in_any_state_and_twice(disarmed):
    for _ in range(2):
        assert (await act(disarmed, "/estop"))["rig"] == "fault"


@pytest.mark.parametrize("path", ["/runs/current/stop", "/runs/current/pause", "/runs/current/resume"])
async def test_without_a_run_there_is_nothing_to_stop_or_hold(armed, path):
    problem = await act(armed, path, 409)
    assert problem["detail"]


async def test_without_a_run_there_is_nothing_to_change(armed):
    answer = await armed.patch("/runs/current", json={})
    assert answer.status_code == 409


async def test_runs_are_listed_newest_first_in_pages(armed):
    for label in ("one", "two", "three"):
        await act(armed, "/runs", 201, label=label)
        await act(armed, "/runs/current/stop")
        await until(armed, rig="armed")
    first = (await armed.get("/runs?limit=2")).json()
    second = (await armed.get(f"/runs?limit=1&cursor={first['next']}")).json()
    assert [run["label"] for run in (*first["runs"], *second["runs"])] == ["three", "two", "one"]


async def test_every_viewer_hears_of_runs_events_and_selections(at, armed):
    async with at.socket("/api/v1/telemetry") as telemetry:
        await act(armed, "/runs", 201, label="heard")
        await act(armed, "/runs/current/stop")
        selection = (await armed.get("/selection")).json()
        await armed.put("/selection", json=selection)
        heard = []
        async with asyncio.timeout(TIMEOUT):
            while not heard or heard[-1]["type"] != "rig":
                message = json.loads(await telemetry.recv())
                if message["type"] != "tick":
                    heard.append(message)
    runs = [(message["event"], message["run"]["label"]) for message in heard if message["type"] == "run"]
    assert runs == [("started", "heard"), ("stopped", "heard")]
    assert heard[-1]["selection"] == selection


async def test_a_saved_path_can_be_chosen_by_its_name(disarmed):
    body = {"name": "My square", "points_mm": [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0]], "speed_mm_s": 4.0}
    answer = await disarmed.post("/trajectories", json=body)
    assert answer.status_code == 201
    assert (await disarmed.post("/trajectories", json=body)).status_code == 409
    preview = (
        await disarmed.post("/trajectories/preview", json={"name": "My square", "parameters": {}})
    ).json()
    assert preview["length_mm"] == pytest.approx(40.0 + 2**0.5 * 20.0, rel=1e-2)
    selection = (await disarmed.get("/selection")).json()
    chosen = {**selection, "trajectory": {"name": "My square"}}
    assert (await disarmed.put("/selection", json=chosen)).status_code == 200
    assert (await disarmed.get("/selection")).json()["trajectory"]["name"] == "My square"
    assert (await disarmed.put("/selection", json=selection)).status_code == 200


async def test_two_changes_at_once_both_count(running):
    tilt = running.patch("/runs/current", json={"gait": {"tilt_deg": 22.0}})
    sweep = running.patch("/runs/current", json={"gait": {"sweep_deg": 17.0}})
    for answer in await asyncio.gather(tilt, sweep):
        assert answer.status_code == 200
    gait = (await running.get("/runs/current")).json()["gait"]
    assert (gait["tilt_deg"], gait["sweep_deg"]) == (22.0, 17.0)


async def test_events_are_paged_and_filtered(running):
    await act(running, "/estop")
    whole = (await running.get("/events", params={"limit": 2})).json()
    assert len(whole["events"]) == 2
    assert whole["next"] == whole["events"][-1]["number"]
    rest = (await running.get("/events", params={"limit": 500, "cursor": whole["next"]})).json()
    numbers = [event["number"] for event in (*whole["events"], *rest["events"])]
    assert numbers == list(range(len(numbers), 0, -1))
    assert rest["next"] is None
    errors = (await running.get("/events", params={"severity": "error"})).json()["events"]
    assert errors[0]["code"] == "estop"
    assert {event["severity"] for event in errors} == {"error"}
