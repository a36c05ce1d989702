"""The board's end of the lock-step port; the protocol is described in `control.simulation.lockstep`."""

from __future__ import annotations

import json
import selectors
import socket
from collections import deque
from collections.abc import Callable, Iterable
from typing import Protocol

from control.link.messages import BoardCode, Triple
from control.simulation.conditions import ConditionRefused
from control.simulation.lockstep import MOST_SAMPLES, MOST_STEPS
from control.snapshot import Vector

MOST_REQUEST = 256
"""Bytes of one request."""

MOST_UNREAD = 1 << 18
"""Bytes that a client may leave unread before it is dropped."""

MOST_CLIENTS = 8
MOST_CATCH_UP = 1000
"""Milliseconds that a free-running board makes up for after a stall of its process."""


class SteppedBoard(Protocol):
    """What the server drives."""

    firmware: str
    milliseconds: int

    def advance(self, milliseconds: int) -> Iterable[Vector]: ...
    def set_condition(self, name: str, value: int, coil: int | None = None) -> None: ...
    def reset(self) -> None: ...
    @property
    def currents(self) -> Vector: ...
    @property
    def duty(self) -> Triple: ...
    @property
    def state(self) -> BoardCode: ...
    @property
    def boot_id(self) -> int: ...


class _Client:
    """One connection: unread request bytes, unsent reply bytes, samples since its last take."""

    def __init__(self, connection: socket.socket) -> None:
        self.connection = connection
        self.request = b""
        self.reply = bytearray()
        self.samples: deque[str] = deque(maxlen=MOST_SAMPLES)


class LockstepServer:
    """Serves a board to its clients from whoever calls `serve`; `clock` paces the free run, s.

    exchange: called around every stretch of board time, to carry the bytes of the serial line.
    """

    def __init__(
        self, board: SteppedBoard, port: int, clock: Callable[[], float], exchange: Callable[[], None]
    ) -> None:
        self._board = board
        self._clock = clock
        self._exchange = exchange
        self._listener = socket.create_server(("127.0.0.1", port))
        self._listener.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._clients: dict[socket.socket, _Client] = {}
        self._stepper: _Client | None = None
        self._run_until = clock()
        self.left_at: float | None = None
        self.was_visited = False

    @property
    def url(self) -> str:
        host, port = self._listener.getsockname()
        return f"tcp://{host}:{port}"

    @property
    def is_running(self) -> bool:
        """Free-running in real time, not stepped."""
        return self._stepper is None

    def close(self) -> None:
        for client in list(self._clients.values()):
            self._drop(client)
        self._selector.close()
        self._listener.close()

    def serve(self, timeout: float) -> None:
        """Waits for requests up to `timeout` (s), answers them, and runs the board on if it is free."""
        for key, events in self._selector.select(timeout):
            if key.fileobj is self._listener:
                self._welcome()
            elif (client := self._clients.get(key.data)) is not None:
                if events & selectors.EVENT_READ:
                    self._read(client)
                if events & selectors.EVENT_WRITE:
                    self._flush(client)
        if self.is_running:
            self._run_freely()

    # ---- board time

    def _run_freely(self) -> None:
        due = int((self._clock() - self._run_until) * 1e3)
        if due > MOST_CATCH_UP:
            self._run_until += (due - MOST_CATCH_UP) * 1e-3
            due = MOST_CATCH_UP
        self._advance(due)
        self._run_until += due * 1e-3

    def _advance(self, milliseconds: int) -> list[str]:
        self._exchange()
        samples = []
        for _ in range(milliseconds):
            self._board.advance(1)
            samples.append(self._sample())
        self._exchange()
        for client in self._clients.values():
            client.samples.extend(samples)
        return samples

    def _sample(self) -> str:
        board = self._board
        x, y, z = board.currents
        dx, dy, dz = board.duty
        return f"{board.milliseconds} {x * 1e3:.3f} {y * 1e3:.3f} {z * 1e3:.3f} {dx} {dy} {dz}"

    # ---- clients

    def _welcome(self) -> None:
        connection, _ = self._listener.accept()
        if len(self._clients) >= MOST_CLIENTS:
            connection.close()
            return
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._clients[connection] = _Client(connection)
        self._selector.register(connection, selectors.EVENT_READ, connection)
        self.left_at = None
        self.was_visited = True

    def _drop(self, client: _Client) -> None:
        if self._clients.pop(client.connection, None) is None:
            return
        self._selector.unregister(client.connection)
        client.connection.close()
        if client is self._stepper:
            self._release()
        if not self._clients:
            self.left_at = self._clock()

    def _release(self) -> None:
        self._stepper = None
        self._run_until = self._clock()

    def _read(self, client: _Client) -> None:
        try:
            data = client.connection.recv(4096)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._drop(client)
            return
        *requests, client.request = (client.request + data).split(b"\n")
        for request in requests:
            self._answer(client, request.decode("ascii", "replace").split())
        if len(client.request) > MOST_REQUEST:
            self._drop(client)
            return
        self._flush(client)

    def _flush(self, client: _Client) -> None:
        try:
            while client.reply:
                del client.reply[: client.connection.send(client.reply)]
        except BlockingIOError:
            pass  # the rest goes when the socket is writable again
        except OSError:
            self._drop(client)
            return
        if len(client.reply) > MOST_UNREAD:
            self._drop(client)
        elif client.connection in self._clients:
            events = selectors.EVENT_READ | (selectors.EVENT_WRITE if client.reply else 0)
            self._selector.modify(client.connection, events, client.connection)

    def _answer(self, client: _Client, words: list[str]) -> None:
        match words:
            case ["step", count] if count.isascii() and count.isdigit() and 1 <= int(count) <= MOST_STEPS:
                lines = [*self._step(client, int(count)), "done"]
            case ["run"]:
                self._release()
                lines = ["done"]
            case ["take"]:
                lines = [*client.samples, "done"]
                client.samples.clear()
            case ["state"]:
                lines = [self._state()]
            case ["set", *condition]:
                lines = [self._set(condition)]
            case ["reset"]:
                self._reset()
                lines = ["done"]
            case _:
                lines = [f"error: {_quoted(words)}: say step 1..{MOST_STEPS}, run, take, state, set or reset"]
        client.reply += "".join(line + "\n" for line in lines).encode("ascii", "replace")

    def _step(self, client: _Client, count: int) -> list[str]:
        self._stepper = client
        samples = self._advance(count)
        client.samples.clear()
        return samples

    def _set(self, words: list[str]) -> str:
        try:
            self._board.set_condition(*_condition(words))
        except ConditionRefused as error:
            return f"error: {error}"
        return "done"

    def _reset(self) -> None:
        """After what is on its way to the board, as a button that is pressed now."""
        self._exchange()
        self._board.reset()

    def _state(self) -> str:
        board = self._board
        return json.dumps(
            {
                "time_ms": board.milliseconds,
                "firmware": board.firmware,
                "boot_id": board.boot_id,
                "mode": "run" if self.is_running else "step",
                "state": board.state.name.lower(),
                "duty": board.duty,
                "drive_is_zero": board.duty == (0, 0, 0),
                "currents_mA": [round(current * 1e3, 3) for current in board.currents],
            }
        )


def _condition(words: list[str]) -> tuple[str, int, int | None]:
    """name, value and coil of `NAME VALUE` or `NAME COIL VALUE`."""
    match words:
        case [name, value] if _is_number(value):
            return name, int(value), None
        case [name, coil, value] if _is_number(coil) and _is_number(value):
            return name, int(value), int(coil)
        case _:
            raise ConditionRefused(f"{_quoted(words)}: say set NAME VALUE or set NAME COIL VALUE")


def _is_number(word: str) -> bool:
    """Of so few digits that it is cheap to read."""
    return word.isascii() and word.isdigit() and len(word) <= 9


def _quoted(words: list[str]) -> str:
    return repr(" ".join(words)[:60])
