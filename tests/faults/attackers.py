"""`python -m tests.faults.attackers ADDRESS SECONDS`: what a broken script or a stranger can do to a server, at once.

Prints how often each of them got which answer, as JSON.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import sys
from collections import Counter
from collections.abc import Awaitable, Callable
from urllib.parse import urlsplit

from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

heard: Counter[str] = Counter()
JSON = "Content-Type: application/json\r\n"
PACE = 0.02
"""Between two tries of one attacker, s: the attackers themselves must leave the server a processor."""


class Target:
    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        assert parts.hostname is not None
        assert parts.port is not None
        self.host, self.port = parts.hostname, parts.port

    async def say(self, name: str, words: bytes, then: bytes = b"") -> None:
        """Open, speak, and note the status, or that it was closed."""
        reader, writer = await asyncio.open_connection(self.host, self.port)
        try:
            with contextlib.suppress(ConnectionError):
                writer.write(words)
                await writer.drain()
                if then:
                    writer.write(then)
                    await writer.drain()
            line = b""
            with contextlib.suppress(ConnectionError, TimeoutError):
                async with asyncio.timeout(15.0):
                    line = await reader.readline()
            heard[f"{name} {line.split()[1].decode() if line else 'closed'}"] += 1
        finally:
            writer.close()
            with contextlib.suppress(ConnectionError):
                await writer.wait_closed()

    def request(
        self, method: str, path: str, headers: str = "", body: bytes = b"", length: int | None = None
    ) -> bytes:
        size = len(body) if length is None else length
        head = f"{method} {path} HTTP/1.1\r\nHost: {self.host}:{self.port}\r\n{headers}Content-Length: {size}\r\n\r\n"
        return head.encode() + body


async def silent(target: Target) -> None:
    await target.say("silent", b"")


async def letters(target: Target) -> None:
    await target.say("letters", b"GET / HTTP/1.1\r\nHo")


async def huge(target: Target) -> None:
    await target.say(
        "huge", target.request("POST", "/api/v1/runs", JSON, b"x" * 100_000, length=2 << 20), b"x" * (2 << 20)
    )


async def slow(target: Target) -> None:
    await target.say("slow", target.request("POST", "/api/v1/runs", JSON, b"{", length=1000))


async def wide(target: Target) -> None:
    body = json.dumps({f"x{n}": n for n in range(60_000)}).encode()
    await target.say("wide", target.request("PUT", "/api/v1/selection", JSON, body))


async def deep(target: Target) -> None:
    await target.say("deep", target.request("PUT", "/api/v1/selection", JSON, b"[" * 200_000))


async def quick(target: Target) -> None:
    await target.say("quick", target.request("GET", "/api/v1/nowhere", "Connection: close\r\n"))


async def garbage(target: Target) -> None:
    await target.say("garbage", b"\x16\x03\x01" + bytes(range(256)) * 8)


async def chatter(target: Target) -> None:
    await messages(target, "chatter", "x", 2000)


async def shout(target: Target) -> None:
    await messages(target, "shout", "x" * 200_000, 1)


async def messages(target: Target, name: str, text: str, number: int) -> None:
    try:
        async with connect(f"ws://{target.host}:{target.port}/api/v1/telemetry", max_size=None) as socket:
            with contextlib.suppress(ConnectionClosed):
                for _ in range(number):
                    await socket.send(text)
                async for _ in socket:
                    pass
            heard[f"{name} {socket.close_code}"] += 1
    except (OSError, InvalidStatus, TimeoutError) as error:
        heard[f"{name} {type(error).__name__}"] += 1


async def again_and_again(attack: Callable[[Target], Awaitable[None]], target: Target, end: float) -> None:
    while asyncio.get_running_loop().time() < end:
        with contextlib.suppress(OSError):
            await attack(target)
        await asyncio.sleep(PACE)


CROWD = {
    silent: 60,
    letters: 60,
    slow: 20,
    huge: 2,
    wide: 1,
    deep: 1,
    quick: 2,
    garbage: 2,
    chatter: 1,
    shout: 1,
}
"""How many of each."""


async def main(address: str, seconds: float) -> None:
    target, end = Target(address), asyncio.get_running_loop().time() + seconds
    attacks = [
        again_and_again(attack, target, end) for attack, number in CROWD.items() for _ in range(number)
    ]
    tasks = [asyncio.create_task(each) for each in attacks]
    await asyncio.wait(tasks, timeout=seconds + 1.0)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    print(json.dumps(heard))


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1], float(sys.argv[2])))
