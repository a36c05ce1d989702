"""Viser's messages as bytes, in the format of its own server: for what only one viewer is to see.

A frame is the size of its msgpack, that of the same compressed (u64, little endian), the compressed msgpack, and then
the raw arrays that the messages point to, each at a multiple of 8 bytes.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Sequence

import msgspec
import zstandard
from viser._messages import Message

HEAD = struct.Struct("<QQ")
ALIGNMENT = 8

_encoder = msgspec.msgpack.Encoder()


def frame_of(messages: Sequence[Message]) -> bytes:
    arrays: list[memoryview] = []
    content = _encoder.encode(
        {
            "messages": [message.as_serializable_dict(arrays) for message in messages],
            "timestampSec": time.perf_counter(),
            "binaryBufferLengths": [array.nbytes for array in arrays],
        }
    )
    compressed = zstandard.ZstdCompressor(level=1).compress(content)
    frame = bytearray(HEAD.pack(len(content), len(compressed)) + compressed)
    for array in arrays:
        frame += bytes(-len(frame) % ALIGNMENT)
        frame += array.tobytes()
    return bytes(frame)
