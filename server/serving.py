"""From a rig file to a running server: the socket first, the rig behind it, zero coils at the first signal."""

from __future__ import annotations

import asyncio.constants
import errno
import os
import signal
import socket
import sys
import webbrowser
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import FrameType
from typing import NoReturn

import uvicorn
from fastapi import FastAPI

from control.link.conversion import LinkError
from server.access.guard import Guard
from server.access.opening import HANDSHAKE, Opening, OpeningError, guard_for
from server.app import create_app, end_streams
from server.archive import Archive
from server.assembly import Machine, build_machine
from server.catalogue.errors import CatalogueError
from server.custom_trajectories import NAME as TRAJECTORIES
from server.door import MESSAGE_LIMIT
from server.exchange import Build
from server.garbage import set_aside
from server.reception.connections import IDLE_TIME, PatientProtocol, allow_files
from server.rig import Rig
from server.rig_changes import RigChanges
from server.rig_file import RigStore
from server.rig_life import ENDED
from server.settings import RigFile
from server.signals import ESTOP, handled
from vision.sources.opening import CameraError

GRACE = 2
"""Seconds that open streams get at shutdown; the coils are zero long before."""


SEND_BUFFER = 64 << 10
"""What the system keeps of what a client has not read, bytes; connections inherit it. With the system's own megabytes
a client that never reads would be found out after a minute."""

TURN = 0.0002
"""How long another thread may keep the interpreter while the rig's thread waits for it, s. Python's own 5 ms would
be longer than the whole way from a frame to its command."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where to listen; port 0 picks a free one. fragment: what of the dashboard its address leads to."""

    host: str
    port: int
    fragment: str = ""
    opening: Opening = Opening()


class ServeError(Exception):
    """The server cannot start; the text says why and what to do."""


def serve_rig(
    store: RigStore, as_run: Callable[[RigFile], RigFile], place: Place, data: Path, open_browser: bool
) -> None:
    """Serve until a signal comes; raises `ServeError`. as_run: makes of the file's rig the one that runs."""
    _prepare_data(data)
    allow_files()
    guard = _guard(place, data)
    listener = _listen(place.host, place.port)
    sys.setswitchinterval(TURN)
    asyncio.constants.SSL_HANDSHAKE_TIMEOUT = HANDSHAKE  # uvicorn has no option for it
    build = partial(build_machine, realtime=True, data=data)
    try:
        machine, archive = _open(build, as_run(store.settings), data)
    except ServeError:
        listener.close()
        raise
    address = _address(listener, place.opening) + place.fragment
    rig = Rig(machine, build, archive.recorder)
    for problem in rig.custom_trajectories.open(data / TRAJECTORIES):
        rig.announce("warn", "trajectories", problem)
    application = create_app(
        rig, archive, changes=RigChanges(rig, store, as_run), guard=guard, opening=place.opening
    )
    application.state.notifier.address = address
    server = _Server(rig, application, address, open_browser, place.opening)
    application.openapi()  # kept for whoever asks: to make it takes 0.3 s, in which the loop would stand still
    set_aside()  # the greater part before the loop runs, which a search would hold up
    with listener, handled({ESTOP: server.handle_estop, signal.SIGHUP: server.handle_exit}):
        server.run(sockets=[listener])
    if server.failure is not None:
        raise ServeError(f"the rig could not be opened: {server.failure}")
    if server.hangs:
        _leave("the control loop never came back")


def _open(build: Build, settings: RigFile, data: Path) -> tuple[Machine, Archive]:
    """The rig and the archive of its runs; the application closes both."""
    try:
        archive = Archive.open(data)
    except CatalogueError as error:
        raise ServeError(str(error)) from error
    try:
        return build(settings), archive
    except (ValueError, LinkError, CameraError, OSError) as error:
        archive.close()
        raise ServeError(str(error)) from error


def _guard(place: Place, data: Path) -> Guard:
    try:
        place.opening.check()
        return guard_for(place.host, place.opening, data)
    except OpeningError as error:
        raise ServeError(str(error)) from error


def _leave(reason: str) -> NoReturn:
    """End at once: the interpreter would wait for the thread that hangs."""
    print(f"pivotrig: {reason}", file=sys.stderr, flush=True)
    os._exit(1)


class _Server(uvicorn.Server):
    """uvicorn, but a signal zeroes the coils before anything else, and readiness is announced."""

    def __init__(
        self, rig: Rig, application: FastAPI, address: str, open_browser: bool, opening: Opening
    ) -> None:
        self._rig = rig
        self._address = address
        self._open_browser = open_browser
        self.failure: BaseException | None = None
        self._application = application
        config = uvicorn.Config(
            self._application,
            http=PatientProtocol,
            timeout_keep_alive=IDLE_TIME,
            log_config=None,
            access_log=False,
            ws_per_message_deflate=False,
            ws_max_size=MESSAGE_LIMIT,
            timeout_graceful_shutdown=GRACE,
            server_header=False,
            proxy_headers=bool(opening.proxies),
            forwarded_allow_ips=list(opening.proxies),
            ssl_certfile=opening.certificate,
            ssl_keyfile=opening.key,
        )
        super().__init__(config)

    @property
    def hangs(self) -> bool:
        return self._rig.hangs

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002 (uvicorn's signature)
        """Zero current first. The exit is then an orderly one, and the status 0; a second Ctrl-C cuts it short."""
        self._rig.stop_coils("ended", ENDED)
        self.force_exit = self.should_exit and sig == signal.SIGINT
        self.should_exit = True

    def handle_estop(self, _number: int, _frame: FrameType | None) -> None:
        """The coils are off and stay off until a reset; everything else goes on."""
        self._rig.stop_coils()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Streams are told to end; else uvicorn would wait for them until its patience is over."""
        end_streams(self._application)
        await super().shutdown(sockets)

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.should_exit:
            self.failure = self._rig.failure or RuntimeError("start-up failed, see above")
            return
        set_aside()
        print(f"dashboard: {self._address}", flush=True)
        if self._open_browser:
            webbrowser.open(self._address)


def _prepare_data(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ServeError(
            f"cannot use the data folder {folder}: {error.strerror}; choose another with --data"
        ) from error


def _listen(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # Asyncio sends at once only on what is called TCP; else an answer waits 40 ms for its reader's receipt.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        listener.bind((host, port))
        listener.listen(128)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise ServeError(
                f"port {port} on {host} is in use; stop the other program or choose another with --port"
            ) from error
        raise ServeError(f"cannot listen on {host} port {port}: {error.strerror}") from error
    return listener


def _address(listener: socket.socket, opening: Opening) -> str:
    host, port = listener.getsockname()[:2]
    scheme = "https" if opening.is_secure else "http"
    return f"{scheme}://[{host}]:{port}" if ":" in host else f"{scheme}://{host}:{port}"
