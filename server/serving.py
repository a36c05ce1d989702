"""From a rig file to a running server: the socket first, the rig behind it, zero coils at the first signal."""

from __future__ import annotations

import errno
import ipaddress
import os
import signal
import socket
import sys
import webbrowser
from pathlib import Path
from types import FrameType
from typing import NoReturn

import platformdirs
import uvicorn

from control.link.conversion import LinkError
from server.app import create_app, end_streams
from server.assembly import Machine, build_machine
from server.door import MESSAGE_LIMIT
from server.rig import Rig
from server.settings import RigFile
from vision.cameras import CameraError

GRACE = 2
"""Seconds that open streams get at shutdown; the coils are zero long before."""


TURN = 0.0002
"""How long another thread may keep the interpreter while the rig's thread waits for it, s. Python's own 5 ms would
be longer than the whole way from a frame to its command."""


class ServeError(Exception):
    """The server cannot start; the text says why and what to do."""


def serve_rig(settings: RigFile, host: str, port: int, data: Path | None, open_browser: bool) -> None:
    """Serve until a signal comes; raises `ServeError`."""
    _prepare_data(data)
    listener = _listen(host, port)
    sys.setswitchinterval(TURN)
    try:
        machine = build_machine(settings, realtime=True)
    except (ValueError, LinkError, CameraError, OSError) as error:
        listener.close()
        raise ServeError(str(error)) from error
    address = _address(listener)
    server = _Server(machine, address, open_browser)
    with listener:
        server.run(sockets=[listener])
    if server.failure is not None:
        raise ServeError(f"the rig could not be opened: {server.failure}")
    if server.hangs:
        _leave("the control loop never came back")


def _leave(reason: str) -> NoReturn:
    """End at once: the interpreter would wait for the thread that hangs."""
    print(f"pivotrig: {reason}", file=sys.stderr, flush=True)
    os._exit(1)


class _Server(uvicorn.Server):
    """uvicorn, but a signal zeroes the coils before anything else, and readiness is announced."""

    def __init__(self, machine: Machine, address: str, open_browser: bool) -> None:
        self._rig = Rig(machine)
        self._address = address
        self._open_browser = open_browser
        self.failure: BaseException | None = None
        self._application = create_app(self._rig)
        config = uvicorn.Config(
            self._application,
            log_level="warning",
            access_log=False,
            ws_per_message_deflate=False,
            ws_max_size=MESSAGE_LIMIT,
            timeout_graceful_shutdown=GRACE,
            server_header=False,
        )
        super().__init__(config)

    @property
    def hangs(self) -> bool:
        return self._rig.hangs

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002 (uvicorn's signature)
        """Zero current first. The exit is then an orderly one, and the status 0; a second Ctrl-C cuts it short."""
        self._rig.stop_coils()
        self.force_exit = self.should_exit and sig == signal.SIGINT
        self.should_exit = True

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Streams are told to end; else uvicorn would wait for them until its patience is over."""
        end_streams(self._application)
        await super().shutdown(sockets)

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.should_exit:
            self.failure = self._rig.failure or RuntimeError("start-up failed, see above")
            return
        print(f"dashboard: {self._address}", flush=True)
        if self._open_browser:
            webbrowser.open(self._address)


def _prepare_data(data: Path | None) -> Path:
    folder = data or Path(platformdirs.user_data_dir("pivotrig"))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ServeError(
            f"cannot use the data folder {folder}: {error.strerror}; choose another with --data"
        ) from error
    return folder


def _listen(host: str, port: int) -> socket.socket:
    if not _is_loopback(host):
        raise ServeError(
            f"{host} can be reached from outside, which needs a login that this version does not have; use 127.0.0.1"
        )
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
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


def _is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _address(listener: socket.socket) -> str:
    host, port = listener.getsockname()[:2]
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"
