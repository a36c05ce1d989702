"""Viser without a port: it listens on a socket that has no address on any network, and hears this process alone.

Viser itself only knows how to listen on TCP, where every program and every user of the computer could reach it and
nobody is asked who they are. Its listening is one call to the package websockets, which is answered here in its place.
"""

from __future__ import annotations

import os
import socket
import struct
from collections.abc import Awaitable, Callable
from types import SimpleNamespace
from typing import Any

import viser
import websockets.asyncio.server
import websockets.datastructures
import websockets.exceptions
from viser.infra import _infra
from websockets.asyncio.client import connect, unix_connect
from websockets.asyncio.server import ServerConnection, unix_serve

CREDENTIALS = struct.Struct("3i")
"""Process, user and group of whoever has connected (unix(7), SO_PEERCRED)."""

Handler = Callable[[ServerConnection], Awaitable[None]]

_listeners: dict[str, socket.socket] = {}


def private_viser(label: str) -> viser.ViserServer:
    """Raises `OSError` where this computer has no such sockets."""
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        listener.bind("")  # Linux makes up a name that is in no folder, and gone with the socket
    except OSError:
        listener.close()
        raise
    address = address_of(listener)
    _listeners[address] = listener
    try:
        return viser.ViserServer(host=address, port=0, label=label, verbose=False)
    finally:
        _listeners.pop(address, None)


def connect_to(server: viser.ViserServer, **options: Any) -> connect:
    """A client's connection to it; options as those of `websockets.connect`."""
    return unix_connect("\0" + server.get_host(), "ws://localhost/", **options)


def address_of(listener: socket.socket) -> str:
    """The made-up name, without the zero byte before it."""
    return listener.getsockname()[1:].decode("ascii")


def serve_privately(handler: Handler, host: str, _port: int, **options: Any) -> Any:
    """What Viser calls in place of `websockets.asyncio.server.serve`; host: an address from `private_viser`."""
    return unix_serve(only_ours(handler), sock=_listeners[host], **options)


def only_ours(handler: Handler) -> Handler:
    async def handle(connection: ServerConnection) -> None:
        if peer_process(connection.transport.get_extra_info("socket")) != os.getpid():
            await connection.close(1008, "not from here")
            return
        await handler(connection)

    return handle


def peer_process(connection: socket.socket) -> int:
    process, _user, _group = CREDENTIALS.unpack(
        connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size)
    )
    return process


_infra.websockets = SimpleNamespace(  # pyright: ignore[reportAttributeAccessIssue, reportPrivateImportUsage]
    asyncio=SimpleNamespace(server=SimpleNamespace(serve=serve_privately, ServerConnection=ServerConnection)),
    exceptions=websockets.exceptions,
    datastructures=websockets.datastructures,
)
