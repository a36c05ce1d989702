"""Recordings shown again: `WS /api/v1/replay?run=ID`, or two with `&run=ID2`, is asked for any instant of them.

It begins with {"type": "ready", "session", "runs": [{"id", "duration_s"}]}; the scene of the session is at
/scene/?replay=SESSION. To {"at_s": 12.3, "frame": true} (s since the runs' start) it answers {"type": "replay",
"at_s", "ticks", "pictures"}: a tick for each run with the names of `GET /state`, or null before the first one, and
where pictures were wanted {"time_s", "captured_s", "new", "tick"} for each run, with the tick that was made of the
picture. Those that are new follow, each as 8 bytes (number of the run and 0, u32, little endian) and its JPEG. While
an answer is made only the newest request is kept. What cannot be understood or read is answered by
{"type": "problem", "detail"}.
"""

from __future__ import annotations

import asyncio
import math
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
from fastapi import APIRouter, Query, WebSocket

from server.api.access import TheArchive, TheReplays, TheRig
from server.api.problems import Rejected
from server.api.recorded import path_of, record_of
from server.api.sockets import Line, goodbye, serve
from server.recording.reading.recording import Unreadable
from server.replay.session import Film, ReplaySession, Shot
from server.replay.sessions import TooManyReplays
from server.scene.geometry import geometry_of
from server.streams import Mailbox, Publisher, StreamEnded

if TYPE_CHECKING:
    from server.archive import Archive

sockets = APIRouter()

NOT_FOUND, TOO_MANY, TOO_MANY_RUNS = 4404, 4429, 4422
"""Why a socket was closed: WebSocket codes of our own, by the HTTP status that says the same."""
REASON_LENGTH = 123
"""Bytes that the reason of a closed socket may have."""
LONGEST = 1e6
"""The latest instant that can be asked for, s: more than any recording has."""
PICTURE_HEAD = struct.Struct("<II")
"""Before each JPEG: which of the runs it belongs to, and nothing."""


class Request(msgspec.Struct, forbid_unknown_fields=True):
    """What a page asks for. at_s: since the runs' start.  frame: whether it wants the pictures, too."""

    at_s: float
    frame: bool = False


_decoder = msgspec.json.Decoder(Request)
_encoder = msgspec.json.Encoder()
"""Writes null for what JSON has no number for."""


class NotAsked(ValueError):
    """A message that is no request; the text says what is allowed."""


def request_in(message: str | bytes) -> Request:
    """Raises `NotAsked`."""
    try:
        request = _decoder.decode(message)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise NotAsked(f'{error}; send {{"at_s": 12.3, "frame": true}}') from None
    if not (math.isfinite(request.at_s) and 0.0 <= request.at_s <= LONGEST):
        raise NotAsked(f"at_s is {request.at_s:g}; it must be between 0 and {LONGEST:g} s")
    return request


class Refusal(Exception):
    """The socket is closed with this code and these words."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code


@sockets.websocket("/replay")
async def replay(
    socket: WebSocket,
    rig: TheRig,
    archive: TheArchive,
    replays: TheReplays,
    run: Annotated[list[str], Query(default_factory=list)],
) -> None:
    """The session ends with the socket. Without a run to show, it is closed with the reason in words."""
    await socket.accept()
    try:
        names, paths = await asyncio.to_thread(recordings, archive, run)
        fallback = geometry_of(rig.settings, rig.coils)
        async with replays.opened(names, paths, fallback) as session:
            await converse(socket, session, run, rig.updates)
    except Refusal as refusal:
        await close(socket, refusal.code, str(refusal))
    except TooManyReplays as error:
        await close(socket, TOO_MANY, str(error))
    except Unreadable as error:
        await close(socket, NOT_FOUND, str(error))


def recordings(archive: Archive, ids: Sequence[str]) -> tuple[list[str], list[Path]]:
    """What the runs are called and where their recordings are; raises `Refusal`."""
    if not 1 <= len(ids) <= 2:
        raise Refusal(TOO_MANY_RUNS, f"one run can be replayed, or two beside each other; not {len(ids)}")
    try:
        records = [record_of(archive, id) for id in ids]
        return [record.label or record.id for record in records], [path_of(archive, id) for id in ids]
    except Rejected as error:
        raise Refusal(NOT_FOUND, str(error)) from error


async def close(socket: WebSocket, code: int, reason: str) -> None:
    await goodbye(socket, code, reason.encode()[:REASON_LENGTH].decode(errors="ignore"))


async def converse(
    socket: WebSocket, session: ReplaySession, ids: Sequence[str], life: Publisher[Any]
) -> None:
    line, requests = Line(socket), Mailbox[str | bytes](depth=1)
    runs = [{"id": id, "duration_s": length} for id, length in zip(ids, session.durations, strict=True)]
    await line.send_text(_encoder.encode({"type": "ready", "session": session.id, "runs": runs}).decode())
    await serve(socket, collect(socket, requests), answer(line, session, requests), until_closed(life))


async def collect(socket: WebSocket, requests: Mailbox[str | bytes]) -> None:
    """Until the client goes; of what it asks while an answer is made only the newest counts."""
    while (event := await socket.receive())["type"] != "websocket.disconnect":
        requests.put(event.get("text") or event.get("bytes") or "")


async def until_closed(life: Publisher[Any]) -> None:
    """A replay ends with the server, too."""
    await life.wait_closed()
    raise StreamEnded


async def answer(line: Line, session: ReplaySession, requests: Mailbox[str | bytes]) -> None:
    last_pictures: dict[int, float] = {}
    while True:
        try:
            request = request_in(await requests.get())
            shot = await session.shot(request.at_s, pictures=request.frame)
        except (NotAsked, Unreadable) as error:
            await line.send_text(_encoder.encode({"type": "problem", "detail": str(error)}).decode())
            continue
        await send(line, shot, last_pictures)


async def send(line: Line, shot: Shot, last_pictures: dict[int, float]) -> None:
    """last_pictures: times of those that the client has, by run; they are not sent again."""
    new = {
        run: film
        for run, film in enumerate(shot.films or ())
        if film is not None and last_pictures.get(run) != film.picture.time_s
    }
    await line.send_text(_encoder.encode(shot_json(shot, new)).decode())
    for run, film in new.items():
        await line.send_bytes(PICTURE_HEAD.pack(run, 0) + film.picture.jpeg)
        last_pictures[run] = film.picture.time_s


def shot_json(shot: Shot, new: dict[int, Film]) -> dict[str, Any]:
    pictures = None
    if shot.films is not None:
        pictures = [film and film_json(film, run in new) for run, film in enumerate(shot.films)]
    return {"type": "replay", "at_s": shot.instant.at, "ticks": shot.instant.ticks, "pictures": pictures}


def film_json(film: Film, is_new: bool) -> dict[str, Any]:
    """time_s, captured_s: since the run's start.  tick: what was made of this picture.  new: it follows as JPEG."""
    picture = film.picture
    return {"time_s": picture.time_s, "captured_s": picture.captured_s, "new": is_new, "tick": film.tick}
