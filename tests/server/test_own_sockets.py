"""What of the program can be reached at all: one listener, however many scenes there are."""

import asyncio
import socket
import subprocess
import sys
from pathlib import Path

import pytest
import viser as viser_package
from websockets.asyncio.client import connect

from server.scene.private_viser import connect_to, peer_process, private_viser
from tests.processes import served

LISTENS = "0A"
"""A listening TCP socket in /proc/net/tcp (proc(5), state TCP_LISTEN)."""

PROTOCOL = f"viser-v{viser_package.__version__}"

STRANGER = """
import socket, sys
stranger = socket.socket(socket.AF_UNIX)
stranger.connect("\\0" + sys.argv[1])
stranger.sendall(b"GET / HTTP/1.1\\r\\nHost: localhost\\r\\nConnection: Upgrade\\r\\nUpgrade: websocket\\r\\n"
    b"Sec-WebSocket-Version: 13\\r\\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\\r\\n"
    b"Sec-WebSocket-Protocol: " + sys.argv[2].encode() + b"\\r\\n\\r\\n")
said = b""
while part := stranger.recv(65536):
    said += part
sys.stdout.buffer.write(said.partition(b"\\r\\n\\r\\n")[2])
"""


def inodes_of(process: int) -> set[str]:
    links = [each.readlink() for each in Path(f"/proc/{process}/fd").iterdir() if each.is_symlink()]
    return {str(link)[len("socket:[") : -1] for link in links if str(link).startswith("socket:[")}


def reachable(process: int) -> list[tuple[str, int]]:
    """Kind and port of each socket of a process that hears who was not asked: TCP that listens, UDP that is bound."""
    own, found = inodes_of(process), []
    for kind in ("tcp", "tcp6", "udp", "udp6"):
        for line in Path(f"/proc/{process}/net/{kind}").read_text().splitlines()[1:]:
            fields = line.split()
            if fields[9] in own and (kind.startswith("udp") or fields[3] == LISTENS):
                found.append((kind, int(fields[1].rpartition(":")[2], 16)))
    return found


def test_a_server_with_scenes_open_listens_at_its_own_address_and_nowhere_else(tmp_path):
    with served(tmp_path) as server:
        port = int(server.address.rpartition(":")[2])
        assert reachable(server.process.pid) == [("tcp", port)]

        async def look() -> None:
            address = f"ws://127.0.0.1:{port}/scene"
            async with connect(address, subprotocols=[PROTOCOL], max_size=None) as scene:  # type: ignore[list-item]
                await scene.recv()
                assert reachable(server.process.pid) == [("tcp", port)]

        asyncio.run(look())


def test_another_process_hears_nothing_of_the_scene():
    server = private_viser("rig")
    try:
        said = subprocess.run(
            [sys.executable, "-c", STRANGER, server.get_host(), PROTOCOL],
            capture_output=True, timeout=30, check=True,
        ).stdout  # fmt: skip
        assert said[:4] == bytes([0x88, len(said) - 2]) + (1008).to_bytes(
            2, "big"
        )  # a close frame and no more
        assert server.get_clients() == {}
    finally:
        server.stop()


def test_the_peer_of_a_socket_is_known():
    one, other = socket.socketpair()
    with one, other:
        assert peer_process(one) == peer_process(other) != 0


@pytest.mark.anyio
async def test_a_scene_that_has_ended_leaves_nothing_to_connect_to():
    server = private_viser("rig")
    async with connect_to(server, subprotocols=[PROTOCOL], max_size=None) as viewer:
        await viewer.recv()
    await asyncio.to_thread(server.stop)
    with pytest.raises(ConnectionRefusedError):
        await connect_to(server)
