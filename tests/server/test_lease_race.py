"""Two clients who race for the rig: one of them has it, and no command of the other one comes between."""

import asyncio
import contextlib
import math
import threading
from dataclasses import dataclass, field
from itertools import count

import httpx
import pytest

from tests.server.rig_visit import TIMEOUT, act, arm, until

pytestmark = pytest.mark.anyio

ROUNDS = 1000
A_FEW = 30


@dataclass
class Effects:
    """What the rig did, in its order: each jog (rate, °/s) and the term in which it was. names: whose each was."""

    seen: list = field(default_factory=list)
    names: dict = field(default_factory=dict)

    @contextlib.contextmanager
    def noted(self, rig):
        """Each jog that takes effect, on the rig's thread, and each change of the lease, on the event loop."""
        loop, desk = rig.machine.loop, rig.attendance
        jog, tell = loop.jog, desk._tell

        def noting(wanted):
            term = desk.lease.term
            jog(wanted)
            self.seen.append((math.degrees(wanted.rate), term))

        def telling():
            if (holder := desk.lease.holder) is not None:
                assert self.names.setdefault(desk.lease.term, holder.party.name) == holder.party.name
            tell()

        loop.jog, desk._tell = noting, telling
        try:
            yield self
        finally:
            loop.jog, desk._tell = jog, tell

    def check_order(self):
        """Terms only grow; a command of a former term, which had begun when its term ended, comes before all of the
        next one."""
        begun = 0
        for rate, term in self.seen:
            name = "Ada" if rate > 0 else "Bob"
            own = term if self.names[term] == name else term - 1
            assert self.names[own] == name, f"a jog of {name} took effect in the term of {self.names[term]}"
            assert own >= begun, "commands of two holders interleave"
            begun = own


@contextlib.asynccontextmanager
async def two_clients(at):
    async with contextlib.AsyncExitStack() as stack:
        yield [
            await stack.enter_async_context(
                httpx.AsyncClient(base_url=at.url + "/api/v1", headers={"X-Client": name}, timeout=TIMEOUT)
            )
            for name in ("Ada", "Bob")
        ]


async def jog(client, rate):
    return rate, (await client.post("/manual", json={"pivot": 1, "rate_deg_s": rate})).status_code


async def ready(client):
    """Armed, also after a busy machine has made the rig let go."""
    if (await client.get("/state")).json()["rig"] == "held":
        await act(client, "/disarm")
    if (await client.get("/state")).json()["rig"] != "armed":
        await until(client, tracking="locked")
        await arm(client)


async def race(clients, rates):
    """Both take the rig, command, and the one who has it hands it over in the middle of it; (rate, status) of each
    jog, Ada's to the left."""
    asked = await asyncio.gather(*(client.post("/operator") for client in clients))
    assert sorted(answer.status_code for answer in asked) == [200, 202], "exactly one has it"
    winner = [answer.status_code for answer in asked].index(200)
    first, second = clients[winner], clients[1 - winner]
    await ready(first)
    sign = 1.0 if winner == 0 else -1.0
    done = await asyncio.gather(
        *(jog(first, sign * next(rates)) for _ in range(3)),
        *(jog(second, -sign * next(rates)) for _ in range(2)),
        first.post("/operator", json={"answer": "grant"}),
        *(jog(first, sign * next(rates)) for _ in range(3)),
        *(jog(second, -sign * next(rates)) for _ in range(2)),
    )
    await second.delete("/operator")
    return [each for each in done if isinstance(each, tuple)]


async def test_racing_clients_never_interleave(at, full):
    """With each round exactly one gets the free lease, and what took effect is what was answered with 200."""
    rates, answered = (0.01 + 1e-5 * number for number in count()), []
    async with two_clients(at) as clients:
        with Effects().noted(at.rig) as effects:
            for _ in range(ROUNDS if full else A_FEW):
                answered += await race(clients, rates)
        await act(clients[0], "/disarm")
    done = sorted(round(rate, 6) for rate, status in answered if status == 200)
    assert sorted(round(rate, 6) for rate, _ in effects.seen) == done
    assert {rate > 0 for rate, _ in effects.seen} == {True, False}, "both have had their turns"
    effects.check_order()


@contextlib.asynccontextmanager
async def busy(rig):
    """The rig's thread is at something else meanwhile; what is asked for waits."""
    begun, go_on = threading.Event(), threading.Event()
    work = asyncio.create_task(rig.between_ticks(lambda: (begun.set(), go_on.wait(TIMEOUT))))
    await asyncio.to_thread(begun.wait, TIMEOUT)
    try:
        yield
    finally:
        go_on.set()
        await work


async def late_command(at, clients, *handovers):
    """Ada's jog, which waits for the rig's thread while the lease goes from hand to hand."""
    ada = clients[0]
    await act(ada, "/operator")
    await ready(ada)
    with Effects().noted(at.rig) as effects:
        async with busy(at.rig):
            late = asyncio.create_task(ada.post("/manual", json={"pivot": 1, "rate_deg_s": 1.0}))
            while at.rig._thread._executor._work_queue.qsize() == 0:
                await asyncio.sleep(0.001)
            for giver, taker in handovers:
                await act(taker, "/operator", 202)
                await act(giver, "/operator", answer="grant")
        answer = await late
    await act(ada, "/disarm")
    for client in clients:
        await client.delete("/operator")
    return answer, effects.seen


async def test_a_late_command_of_the_old_holder_is_refused_where_it_would_take_effect(at):
    async with two_clients(at) as (ada, bob):
        answer, effects = await late_command(at, (ada, bob), (ada, bob))
    assert answer.status_code == 409
    assert answer.json()["title"] == "Somebody else operates"
    assert answer.json()["holder"]["name"] == "Bob"
    assert effects == []


async def test_a_late_command_is_refused_even_when_its_client_holds_the_lease_again(at):
    async with two_clients(at) as (ada, bob):
        answer, effects = await late_command(at, (ada, bob), (ada, bob), (bob, ada))
    assert answer.status_code == 409
    assert answer.json()["title"] == "Too late"
    assert effects == []
