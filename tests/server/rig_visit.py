"""What a client asks of a served rig, as a person would."""

import asyncio

TIMEOUT = 10.0


async def until(api, **wanted):
    """Poll the state until its fields are as wanted."""
    async with asyncio.timeout(TIMEOUT):
        while True:
            state = (await api.get("/state")).json()
            if all(state[name] == value for name, value in wanted.items()):
                return state
            await asyncio.sleep(0.02)


async def until_gone(api, duration):
    """Until the run has gone on for so long, s; resumed when a busy machine has made the rig hold it."""
    async with asyncio.timeout(TIMEOUT + duration):
        while True:
            state = (await api.get("/state")).json()
            if state["run"] is not None and state["run"]["elapsed_s"] >= duration:
                return
            if state["rig"] == "held":
                await api.post("/runs/current/resume")
            await asyncio.sleep(0.02)


async def act(api, path, status=200, **body):
    answer = await api.post(path, json=body) if body else await api.post(path)
    assert answer.status_code == status, answer.text
    return answer.json()


async def arm(api):
    """Once more when the robot, just let go, is still settling."""
    async with asyncio.timeout(TIMEOUT):
        while (answer := await api.post("/arm")).status_code == 409:
            await asyncio.sleep(0.05)
    assert answer.status_code == 200
    return answer.json()
