"""Driving by hand: each jog is good for 300 ms, and only an armed rig without a run takes one."""

import asyncio
import math
from collections.abc import Iterator

import pytest

from control.controllers.manual import HOLD, Jog, Manual
from control.gait import Gait
from control.model import PIVOT_A, PIVOT_B, Pose, wrap
from control.runs import RunRequest
from control.safety import Refused
from control.snapshot import RigState
from control.steering import Steering
from control.workspace_guard import WorkspaceGuard
from server.assembly import build_machine
from server.settings import RigFile
from tests.server.test_complete_loop import EIGHT, Bench

RATE = math.radians(60.0)


@pytest.fixture
def bench() -> Iterator[Bench]:
    machine = build_machine(RigFile().with_simulation(seed=3, plant="noslip"), realtime=False)
    yield Bench(machine)
    machine.close()


@pytest.fixture
def armed(bench: Bench) -> Bench:
    bench.arm()
    bench.run_for(0.5)
    return bench


def heading(bench: Bench) -> float:
    return bench.world.body().pose.heading


def test_a_jog_swings_for_300_ms_and_no_longer(armed: Bench) -> None:
    before = heading(armed)
    armed.loop.jog(Jog(PIVOT_A, RATE))
    armed.tick()
    assert armed.snapshot.command.controller == "manual"
    armed.run_for(1.0)
    turned = wrap(heading(armed) - before)
    assert 0.8 * HOLD * RATE <= turned <= 1.01 * HOLD * RATE
    assert armed.snapshot.command.controller == ""
    assert armed.snapshot.command.rate == 0.0
    assert armed.snapshot.rig is RigState.ARMED


def test_jogs_that_are_renewed_go_on_without_a_break(armed: Bench) -> None:
    before = heading(armed)
    for _ in range(10):
        armed.loop.jog(Jog(PIVOT_B, -RATE))
        armed.run_for(0.1)
    assert armed.snapshot.command.pivot == PIVOT_B
    assert wrap(heading(armed) - before) == pytest.approx(-RATE * 0.95, rel=0.05)


def test_a_rate_of_zero_stops_at_once(armed: Bench) -> None:
    armed.loop.jog(Jog(PIVOT_A, RATE))
    armed.run_for(0.1)
    armed.loop.jog(Jog(PIVOT_A, 0.0))
    armed.run_for(0.05)
    before = heading(armed)
    armed.run_for(0.5)
    assert wrap(heading(armed) - before) == pytest.approx(0.0, abs=1e-3)


def test_the_tilt_stays_until_another_is_given(armed: Bench) -> None:
    armed.loop.jog(Jog(PIVOT_A, RATE, math.radians(35.0)))
    armed.run_for(1.0)
    assert math.degrees(armed.snapshot.command.tilt) == pytest.approx(35.0)


def test_only_an_armed_rig_without_a_run_takes_a_jog(bench: Bench) -> None:
    bench.run_for(0.3)
    with pytest.raises(Refused, match="cannot jog while the rig is disarmed: arm it first"):
        bench.loop.jog(Jog(PIVOT_A, RATE))
    bench.arm()
    bench.loop.start("a run", RunRequest(EIGHT))
    with pytest.raises(Refused, match="cannot jog while the rig is running: stop the run first"):
        bench.loop.jog(Jog(PIVOT_A, RATE))


def test_a_rate_beyond_the_rig_is_refused_and_changes_nothing(armed: Bench) -> None:
    with pytest.raises(Refused, match="beyond this rig's"):
        armed.loop.jog(Jog(PIVOT_A, 7.0))
    armed.run_for(0.1)
    assert armed.snapshot.rig is RigState.ARMED
    assert armed.snapshot.command.rate == 0.0


@pytest.mark.parametrize("x", [0.05, 0.5, math.nan])
def test_to_stop_is_never_refused_wherever_the_robot_is(bench: Bench, x: float) -> None:
    """At the edge of the workspace a swing may lead out of it; letting go does not."""
    steering = Steering(bench.loop.parts, WorkspaceGuard(0.06, 0.07, 0.01))
    steering.take(Jog(PIVOT_A, 0.0), Pose(x, 0.0, 0.0), 1.0)
    if not x < 0.06:
        with pytest.raises(Refused, match="leads out of the workspace"):
            steering.take(Jog(PIVOT_A, RATE), Pose(x, 0.0, 0.0), 1.0)


def test_a_jog_does_not_outlive_a_disarming(armed: Bench) -> None:
    armed.loop.jog(Jog(PIVOT_A, RATE))
    armed.loop.disarm()
    armed.expect_no_current()
    assert armed.snapshot.command.rate == 0.0


def test_a_rig_that_is_armed_again_at_once_does_not_go_on_with_the_old_jog(armed: Bench) -> None:
    """A weak field is up before a jog is too old."""
    armed.loop.jog(Jog(PIVOT_A, RATE))
    armed.tick()
    armed.loop.disarm()
    armed.loop.arm(Gait(field=0.002))
    for _ in range(10):
        armed.tick()
        assert armed.snapshot.rig is RigState.ARMED
        assert (armed.snapshot.command.controller, armed.snapshot.command.rate) == ("", 0.0)
    assert armed.loop.parts.field.is_ready


@pytest.mark.parametrize("later", [HOLD + 1e-6, 10.0, -1.0, math.nan])
def test_a_jog_counts_only_in_the_300_ms_after_it_came(later: float) -> None:
    manual = Manual()
    manual.take(Jog(PIVOT_A, RATE), 5.0)
    assert manual.decide(5.0 + 0.5 * HOLD) is not None
    assert manual.decide(5.0 + later) is None


async def prepared(api, armed):
    """The rig at rest or armed, however the test before has left it."""
    await api.post("/estop")
    await api.post("/reset")
    async with asyncio.timeout(10.0):
        while armed and (await api.post("/arm")).status_code == 409:
            await asyncio.sleep(0.05)


@pytest.mark.anyio
async def test_the_call_answers_with_the_state_and_stops_by_itself(api):
    await prepared(api, armed=True)
    await asyncio.sleep(0.4)
    answer = await api.post("/manual", json={"pivot": -1, "rate_deg_s": -45.0, "tilt_deg": 30.0})
    assert answer.status_code == 200
    command = answer.json()["command"]
    assert (command["controller"], command["pivot"], command["tilt_deg"]) == ("manual", -1, 30.0)
    async with asyncio.timeout(2.0):
        while (await api.get("/state")).json()["command"]["rate_deg_s"] != 0.0:
            await asyncio.sleep(0.02)


@pytest.mark.anyio
async def test_the_call_is_refused_unless_armed(api):
    await prepared(api, armed=False)
    answer = await api.post("/manual", json={"pivot": 1, "rate_deg_s": 30.0})
    assert answer.status_code == 409
    assert "arm it first" in answer.json()["detail"]


@pytest.mark.anyio
@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({"pivot": 0, "rate_deg_s": 1.0}, "pivot"),
        ({"pivot": 1}, "rate_deg_s"),
        ({"pivot": 1, "rate_deg_s": 360.0}, "rate_deg_s"),
        ({"pivot": 1, "rate_deg_s": -1e9}, "rate_deg_s"),
        ({"pivot": 1, "rate_deg_s": 1.0, "tilt_deg": 60.0}, "tilt_deg"),
        ({"pivot": 1, "rate_deg_s": 1.0, "speed": 2}, "speed"),
    ],
)
async def test_a_body_that_cannot_be_meant_names_its_field(api, body, field):
    answer = await api.post("/manual", json=body)
    assert answer.status_code == 422
    assert [error["field"] for error in answer.json()["errors"]] == [field]
