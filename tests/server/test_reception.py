"""Connections, messages and bodies that are too many, too slow or too wide."""

import asyncio
import contextlib
import json
import socket
import time

import httpx
import pytest
import uvicorn
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from server.api.body import MOST_FIELDS
from server.api.problems import MOST_ERRORS
from server.door import Door
from server.reception import connections
from server.reception.bodies import BURST
from server.reception.connections import PatientProtocol

pytestmark = pytest.mark.anyio
LARGE = 16 << 20


async def greet(_):
    return PlainTextResponse("hello")


async def large(_):
    return PlainTextResponse("x" * LARGE)


async def listening(ws):
    await ws.accept()
    while (await ws.receive())["type"] != "websocket.disconnect":
        pass


@pytest.fixture
async def hall(monkeypatch):
    """An application behind the door and the patient protocol; with little patience and few places."""
    monkeypatch.setattr(connections, "HEADER_TIME", 0.4)
    monkeypatch.setattr(connections, "TAKEN_WITHIN", 0.3)
    monkeypatch.setattr(connections, "PLACES", 8)
    app = Starlette(routes=[Route("/", greet), Route("/large", large), WebSocketRoute("/listen", listening)])
    app.add_middleware(Door)
    config = uvicorn.Config(app, port=0, log_config=None, http=PatientProtocol, timeout_keep_alive=1)
    server = uvicorn.Server(config)
    task = asyncio.create_task(server.serve())
    while not server.started:
        await asyncio.sleep(0.01)
    yield server, server.servers[0].sockets[0].getsockname()[1]
    server.should_exit = True
    await task


async def opened(port, words=b""):
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(words)
    await writer.drain()
    return reader, writer


async def rest_of(reader, within=5.0):
    async with asyncio.timeout(within):
        return await reader.read()


async def until(holds):
    while not holds():
        await asyncio.sleep(0.01)


async def closed(*writers):
    for writer in writers:
        writer.close()
        with contextlib.suppress(ConnectionError):
            await writer.wait_closed()


async def test_who_says_nothing_or_speaks_a_letter_at_a_time_is_sent_away(hall):
    _, port = hall
    silent, first = await opened(port)
    slow, second = await opened(port, b"GET / HTTP/1.1\r\nHost: 127")
    began = time.monotonic()

    async def drip():
        with contextlib.suppress(ConnectionError):
            for letter in "0" * 50:
                second.write(letter.encode())
                await second.drain()
                await asyncio.sleep(0.05)

    dripping = asyncio.create_task(drip())
    assert await rest_of(silent) == b""
    assert await rest_of(slow) == b""
    assert time.monotonic() - began < 2.0
    await dripping
    await closed(first, second)


async def test_a_request_in_time_is_answered_and_the_next_one_has_its_own_time(hall):
    _, port = hall
    reader, writer = await opened(port)
    for _ in range(3):
        await asyncio.sleep(0.2)
        writer.write(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        head = await reader.readuntil(b"hello")
        assert head.startswith(b"HTTP/1.1 200")
    writer.write(b"GET / HT")
    assert await rest_of(reader) == b""
    await closed(writer)


async def test_one_too_many_is_told_so_and_places_are_free_again(hall):
    server, port = hall
    guests = [await opened(port, b"G") for _ in range(8)]
    reader, writer = await opened(port)
    assert (await rest_of(reader)).startswith(b"HTTP/1.1 503 ")
    await closed(writer, *(each for _, each in guests))
    while server.server_state.connections:
        await asyncio.sleep(0.02)
    async with httpx.AsyncClient() as client:
        assert (await client.get(f"http://127.0.0.1:{port}/")).text == "hello"


async def test_an_open_socket_keeps_its_place_and_is_not_hurried(hall):
    server, port = hall
    async with connect(f"ws://127.0.0.1:{port}/listen") as ws:
        await asyncio.sleep(1.0)
        await ws.ping()
        assert len(server.server_state.connections) == 1
    while server.server_state.connections:
        await asyncio.sleep(0.02)


@pytest.fixture
async def asked_for_much(hall):
    """A bare connection that has asked for more than the system's own buffers hold; and the server."""
    server, port = hall
    loop = asyncio.get_running_loop()
    with socket.socket() as own:
        own.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 << 10)
        own.setblocking(False)
        await loop.sock_connect(own, ("127.0.0.1", port))
        await loop.sock_sendall(own, b"GET /large HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
        yield server, own


async def test_who_asks_for_much_and_takes_nothing_is_let_go(asked_for_much):
    server, _ = asked_for_much
    async with asyncio.timeout(5.0):
        await until(lambda: server.server_state.connections)
        await until(lambda: not server.server_state.connections)


async def test_who_takes_slowly_is_given_all_of_it(asked_for_much):
    _, own = asked_for_much
    loop, taken, began = asyncio.get_running_loop(), 0, time.monotonic()
    while part := await loop.sock_recv(own, 1 << 20):
        taken += len(part)
        await asyncio.sleep(0.005)
    assert taken > LARGE
    assert time.monotonic() - began > 0.3


async def test_a_flood_of_messages_ends_with_its_socket(hall):
    _, port = hall
    async with connect(f"ws://127.0.0.1:{port}/listen") as ws:
        with contextlib.suppress(ConnectionClosed):
            for _ in range(int(4 * BURST)):
                await ws.send("x")
            await ws.wait_closed()
        assert ws.close_code == 1008


async def test_messages_as_a_person_makes_them_are_all_heard(hall):
    _, port = hall
    async with connect(f"ws://127.0.0.1:{port}/listen") as ws:
        for _ in range(int(BURST / 2)):
            await ws.send("x")
        await (await ws.ping())
        assert ws.close_code is None


def test_who_shares_an_address_has_a_share_of_the_places(monkeypatch):
    """The protocol is asked as uvicorn asks it, since this computer has one address only that is not its own."""
    monkeypatch.setattr(connections, "PLACES_OF_ONE", 3)

    class Guest:
        def __init__(self, address):
            self.client = (address, 5000)

    protocol = PatientProtocol.__new__(PatientProtocol)
    protocol.client = ("2001:db8::1", 5000)
    protocol.connections = {Guest(f"2001:db8::{n}") for n in range(2, 5)} | {Guest("2001:db8:0:9::1")}  # type: ignore[assignment]
    assert not protocol._is_one_too_many()
    protocol.connections |= {Guest("2001:db8::ffff")}  # type: ignore[operator]
    assert protocol._is_one_too_many()
    protocol.client = ("127.0.0.1", 5000)
    assert not protocol._is_one_too_many()


async def test_a_wide_body_is_refused_at_once_and_an_answer_lists_so_many_fields(api):
    wide = {f"x{number}": 1 for number in range(MOST_FIELDS + 1)}
    answer = await api.put("/selection", json=wide)
    assert answer.status_code == 422
    assert f"at most {MOST_FIELDS}" in answer.json()["detail"]
    many = json.dumps({f"x{number}": 1 for number in range(MOST_FIELDS)})
    answer = await api.put("/selection", content=many, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422
    assert len(answer.json()["errors"]) == MOST_ERRORS
    assert len(answer.content) < 50_000


def test_connections_inherit_what_the_system_keeps_for_them():
    from server.serving import SEND_BUFFER, _listen

    with _listen("127.0.0.1", 0) as listener, socket.create_connection(listener.getsockname()) as client:
        server, _ = listener.accept()
        with server:
            kept = server.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF)
            assert SEND_BUFFER <= kept <= 4 * SEND_BUFFER
        assert client.recv(1) == b""
