"""The load of a soak, in a process of its own: people who watch, come and go, and one who never reads.

python -m tests.soak.crowd ADDRESS --load light --seed 1; at SIGTERM it prints what it has seen as one line of JSON.
None of them commands.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import random
import signal
from collections import Counter
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field

import httpx
import viser
import websockets
from websockets.asyncio.client import connect
from websockets.typing import Subprotocol

STAYS = 4.0, 25.0
"""A viewer goes and comes back after so long, s."""
AWAY = 0.2, 2.0
PIECE = 1 << 16
READS = (
    "/state",
    "/events",
    "/runs",
    "/rig",
    "/vision",
    "/selection",
    "/operator",
    "/simulation/faults",
    "/health",
)
UNWELL = "/health", 503
"""What a program says whose loop stands still: the right answer while a controller hangs."""
SCENE = Subprotocol(f"viser-v{viser.__version__}")
LOADS = {"light": 1, "full": 3}
"""How many of each kind there are."""


@dataclass(slots=True)
class Crowd:
    """counts: what has come.  wrong: what should never come."""

    address: str
    chance: random.Random
    counts: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)

    @property
    def sockets(self) -> str:
        return self.address.replace("http", "ws", 1)

    def headers(self, name: str) -> dict[str, str]:
        return {"X-Client": f"soak viewer {name}"}

    async def come_and_go(self, name: str, look: Callable[[str], Awaitable[None]]) -> None:
        """For ever."""
        while True:
            with contextlib.suppress(
                OSError, websockets.WebSocketException, httpx.TransportError, TimeoutError
            ):
                async with asyncio.timeout(self.chance.uniform(*STAYS)):
                    await look(name)
            self.counts["reconnects"] += 1
            await asyncio.sleep(self.chance.uniform(*AWAY))

    async def telemetry(self, name: str) -> None:
        rate = self.chance.choice((5, 15, 30))
        url = f"{self.sockets}/api/v1/telemetry?rate_Hz={rate}"
        async with connect(url, additional_headers=self.headers(name), max_size=None, proxy=None) as line:
            async for message in line:
                self.counts["telemetry messages"] += 1
                if not isinstance(message, str) or "NaN" in message or "Infinity" in message:
                    self.wrong.append(f"telemetry sends what is no JSON: {message[:200]!r}")

    async def camera(self, name: str) -> None:
        view = self.chance.choice(("raw", "overlay", "mask"))
        url = f"{self.sockets}/api/v1/camera?view={view}"
        async with connect(url, additional_headers=self.headers(name), max_size=None, proxy=None) as line:
            async for _ in line:
                self.counts["pictures"] += 1
                await asyncio.sleep(0.1)
                await line.send("next")

    async def film(self, name: str) -> None:
        async with (
            httpx.AsyncClient(headers=self.headers(name), trust_env=False, timeout=None) as client,
            client.stream("GET", f"{self.address}/api/v1/camera/stream.mjpg") as answer,
        ):
            async for piece in answer.aiter_bytes(PIECE):
                self.counts["MJPEG bytes"] += len(piece)
                await asyncio.sleep(0.1)

    async def scene(self, name: str) -> None:
        url = f"{self.sockets}/scene"
        async with connect(
            url,
            subprotocols=[SCENE],
            additional_headers=self.headers(name),
            max_size=None,
            compression=None,
            proxy=None,
        ) as line:
            async for _ in line:
                self.counts["scene messages"] += 1

    async def deaf(self, name: str) -> None:
        """Asks for pictures without end and reads none."""
        host, port = self.address.removeprefix("http://").rsplit(":", 1)
        _, writer = await asyncio.open_connection(host, int(port), limit=1)
        head = f"GET /api/v1/camera/stream.mjpg HTTP/1.1\r\nHost: {host}:{port}\r\nX-Client: {name}\r\n\r\n"
        writer.write(head.encode("ascii"))
        self.counts["deaf clients"] += 1
        try:
            await asyncio.sleep(STAYS[1])
        finally:
            writer.close()

    async def rest(self, name: str) -> None:
        async with httpx.AsyncClient(headers=self.headers(name), trust_env=False, timeout=20.0) as client:
            while True:
                path = self.chance.choice(READS)
                answer = await client.get(f"{self.address}/api/v1{path}")
                self.counts["REST answers"] += 1
                if answer.status_code >= 500 and (path, answer.status_code) != UNWELL:
                    self.wrong.append(f"GET {path}: {answer.status_code} {answer.text[:200]}")
                await asyncio.sleep(self.chance.uniform(0.1, 1.0))


async def watch(crowd: Crowd, load: str) -> None:
    """Until SIGTERM."""
    ended = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, ended.set)
    looks = (crowd.telemetry, crowd.telemetry, crowd.camera, crowd.film, crowd.scene, crowd.deaf, crowd.rest)
    people = [
        asyncio.create_task(crowd.come_and_go(f"{number} of {set_}", look))
        for set_ in range(LOADS[load])
        for number, look in enumerate(looks)
    ]
    fallen = asyncio.create_task(asyncio.wait(people, return_when=asyncio.FIRST_COMPLETED))
    await asyncio.wait([fallen, asyncio.create_task(ended.wait())], return_when=asyncio.FIRST_COMPLETED)
    crowd.wrong += [repr(person.exception()) for person in people if person.done()]
    for person in people:
        person.cancel()
    await asyncio.gather(*people, return_exceptions=True)
    print(json.dumps({"counts": crowd.counts, "wrong": crowd.wrong}), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("address")
    parser.add_argument("--load", choices=LOADS, default="light")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    asyncio.run(watch(Crowd(given.address, random.Random(given.seed)), given.load))


if __name__ == "__main__":
    main()
