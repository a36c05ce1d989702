"""A real server on a free port, with the simulated rig behind it, as long as a module's tests need it."""

import asyncio
import contextlib
import logging

import httpx
import pytest
import uvicorn
from fastapi import FastAPI
from websockets.asyncio.client import connect

from server.app import create_app, end_streams
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.settings import RigFile


@pytest.fixture(scope="session")
def anyio_backend():
    return "asyncio"


class Served:
    """Where an application is served. server: to be told to end."""

    rig: Rig
    archive: Archive

    def __init__(self, server):
        self.server = server
        self.port = server.servers[0].sockets[0].getsockname()[1]
        self.host = f"127.0.0.1:{self.port}"
        self.url = f"http://{self.host}"

    def socket(self, path, name=None, **options):
        """A client's socket, under another name of the server's if need be."""
        url = f"ws://{name or '127.0.0.1'}:{self.port}{path}"
        return connect(url, host="127.0.0.1", port=self.port, compression=None, proxy=None, **options)


class EndingServer(uvicorn.Server):
    """Tells streams to end before it waits for them, as the program's own server does."""

    async def shutdown(self, sockets=None):
        if isinstance(self.config.app, FastAPI):
            end_streams(self.config.app)
        await super().shutdown(sockets)


@contextlib.asynccontextmanager
async def served(app):
    logging.getLogger("uvicorn.error").setLevel(logging.WARNING)
    config = uvicorn.Config(
        app,
        port=0,
        log_config=None,
        access_log=False,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=2,
    )
    server = EndingServer(config)
    task = asyncio.create_task(server.serve())
    while not server.started:
        if task.done():
            await task
        await asyncio.sleep(0.01)
    try:
        yield Served(server)
    finally:
        server.should_exit = True
        await task


@pytest.fixture(scope="session")
def serve():
    """`async with serve(app) as at:` serves an ASGI application on loopback."""
    return served


@pytest.fixture(scope="module")
async def at(tmp_path_factory):
    """The whole server with the paper's rig, simulated in real time. rig, archive: what stands behind it."""
    archive = Archive.open(tmp_path_factory.mktemp("data"))
    rig = Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder)
    async with served(create_app(rig, archive)) as served_rig:
        served_rig.rig, served_rig.archive = rig, archive
        yield served_rig


@pytest.fixture
async def api(at):
    """An HTTP client of the server's REST interface."""
    async with httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=10.0) as client:
        yield client
