"""What Viser sends to a browser that looks at the scene."""

import asyncio
import struct

import msgspec
import zstandard


def messages_in(data):
    """Viser's messages in one frame: sizes, compressed msgpack, then raw arrays."""
    whole, compressed = struct.unpack_from("<QQ", data)
    payload = zstandard.ZstdDecompressor().decompress(data[16 : 16 + compressed], max_output_size=whole)
    return msgspec.msgpack.decode(payload)["messages"]


async def seen(viewer, wanted):
    """All messages of the scene up to the first one that `wanted` accepts."""
    found = []
    async with asyncio.timeout(10.0):
        while not any(map(wanted, found)):
            found += messages_in(await viewer.recv())
    return found
