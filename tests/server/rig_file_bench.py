"""A served rig with its file, and somebody who asks it."""

from __future__ import annotations

import asyncio
from pathlib import Path

import httpx

from server.rig import Rig

PATIENCE = 20.0


class RigFileBench:
    """A served rig with its file."""

    def __init__(self, at, rig: Rig, path: Path) -> None:
        self.at, self.rig, self.path = at, rig, path
        self.api = httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=PATIENCE)

    async def get(self, what: str):
        return (await self.api.get(what)).json()

    async def until(self, what: str, condition):
        async with asyncio.timeout(PATIENCE):
            while not condition(answer := await self.get(what)):
                await asyncio.sleep(0.02)
        return answer

    async def ready(self) -> None:
        await self.until("/state", lambda state: state["tracking"] == "locked" and not state["faults"])
