"""The chunks of a recording, decompressed when they are asked for; the last few stay at hand."""

from __future__ import annotations

from collections import OrderedDict

from server.recording import mcap_format as mcap
from server.recording.mcap_format import ChunkPlace, Message, Opcode
from server.recording.reading.byte_source import ByteSource, Damaged
from server.recording.reading.contents import Contents, record_at

CHUNKS_KEPT = 8
"""Two seconds of recording."""
BYTES_KEPT = 32 << 20
"""Of decompressed chunks; one is kept however large it is."""


class ChunkShelf:
    """Messages by chunk. damaged: where the chunks stand that could not be read.  read: how many were unpacked."""

    def __init__(self, source: ByteSource, contents: Contents) -> None:
        self._source = source
        self._contents = contents
        self._kept: OrderedDict[int, tuple[list[Message], int]] = OrderedDict()
        self.damaged: set[int] = set()
        self.read = 0

    def messages(self, place: ChunkPlace) -> list[Message]:
        """In the order of the chunk; none from a chunk that is damaged."""
        if place.offset in self.damaged:
            return []
        if place.offset not in self._kept:
            try:
                self._kept[place.offset] = self._read(place)
            except Damaged:
                self.damaged.add(place.offset)
                return []
            self._clear()
        self._kept.move_to_end(place.offset)
        return self._kept[place.offset][0]

    def _read(self, place: ChunkPlace) -> tuple[list[Message], int]:
        data = mcap.chunk(record_at(self._source, place, Opcode.CHUNK, mcap.CHUNK_LIMIT))
        self.read += 1
        messages, others = mcap.in_chunk(data)
        for opcode, content in others:
            self._contents.add_name(opcode, content)
        return messages, len(data)

    def _clear(self) -> None:
        while len(self._kept) > 1 and (len(self._kept) > CHUNKS_KEPT or self._size() > BYTES_KEPT):
            self._kept.popitem(last=False)

    def _size(self) -> int:
        return sum(size for _, size in self._kept.values())
