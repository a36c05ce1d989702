"""The lock-step port of a board in a process of its own: one line of text a request, over TCP on loopback.

    step N   run N milliseconds and stand still; answers N samples, then "done"
    run      run freely, in real time; answers "done"
    take     the samples since this client's last take, 2000 at most, then "done"
    state    one line of JSON
    set NAME [COIL] VALUE
             makes one of `control.simulation.conditions` hold, until it is set otherwise; answers "done"
    reset    presses the board's reset button; answers "done"

A sample is "t_ms ix_mA iy_mA iz_mA dx dy dz": the board's time, coil currents, signed PWM steps.
Anything else is answered by a line that begins with "error:".  When the client that stepped goes away the
board runs freely again, so that its dead-man acts.
"""

from __future__ import annotations

import json
import socket
from collections import deque
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from control.link.messages import Triple
from control.simulation.conditions import checked
from control.snapshot import ZERO, Vector

MOST_STEPS = 1000
MOST_SAMPLES = 2000
REPLY_TIMEOUT = 5.0
"""A board that does not answer for so long is gone, s."""

MOST_BACKLOG = 20
"""Milliseconds that the world may lag behind a board that runs in real time."""


@dataclass(frozen=True, slots=True)
class Sample:
    """The board at the end of one of its milliseconds: currents in A, signed PWM steps."""

    milliseconds: int
    currents: Vector
    duty: Triple


class RemoteBoard:
    """A board behind a lock-step port, as the world's board.

    realtime: the board keeps its own pace and `advance` hands out what it did, one sample a millisecond;
    else `advance` steps it.
    """

    def __init__(self, url: str, realtime: bool) -> None:
        address = urlsplit(url)
        if address.scheme != "tcp" or not address.hostname or not address.port:
            raise ValueError(f"the board's control port is {url!r}; it must look like tcp://127.0.0.1:5000")
        self.url = url
        self._realtime = realtime
        self._last = ZERO
        self._backlog: deque[Vector] = deque(maxlen=MOST_SAMPLES)
        self._connection = socket.create_connection((address.hostname, address.port), timeout=REPLY_TIMEOUT)
        self._connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._lines = self._connection.makefile("r", encoding="ascii", newline="\n")
        if realtime:
            self.ask("run")
            self.take()

    def advance(self, milliseconds: int) -> list[Vector]:
        """The coil currents (A) at the end of each millisecond."""
        if milliseconds <= 0:
            return []
        if self._realtime:
            return self._advance_in_real_time(milliseconds)
        return [sample.currents for sample in self.step(milliseconds)]

    def step(self, milliseconds: int) -> list[Sample]:
        """Runs on and stands still; what the board did in each millisecond."""
        samples: list[Sample] = []
        while len(samples) < milliseconds:
            count = min(MOST_STEPS, milliseconds - len(samples))
            samples += self._samples(f"step {count}")
        return samples

    def _advance_in_real_time(self, milliseconds: int) -> list[Vector]:
        """Two clocks, not in step: a short backlog is kept, and a missing sample repeats the last one."""
        self._backlog.extend(sample.currents for sample in self.take())
        while len(self._backlog) > milliseconds + MOST_BACKLOG:
            self._backlog.popleft()
        samples = []
        for _ in range(milliseconds):
            if self._backlog:
                self._last = self._backlog.popleft()
            samples.append(self._last)
        return samples

    def take(self) -> list[Sample]:
        """What the board did since this client's last take, 2000 ms at most."""
        return self._samples("take")

    def state(self) -> dict[str, object]:
        """What the board says of itself, for people and monitors."""
        return self.told("state")

    def set_condition(self, name: str, value: int, coil: int | None = None) -> None:
        """One of `control.simulation.conditions`, in force until it is set otherwise."""
        checked(name, value, coil)
        place = "" if coil is None else f"{coil} "
        self.ask(f"set {name} {place}{value}")

    def reset(self) -> None:
        """The board's reset button: it boots anew, with the next boot id."""
        self.ask("reset")

    def close(self) -> None:
        self._lines.close()
        self._connection.close()

    def ask(self, request: str) -> list[str]:
        """The lines of an answer that ends with "done"."""
        self._send(request)
        lines = []
        while (line := self._good_line()) != "done":
            lines.append(line)
        return lines

    def told(self, request: str) -> dict[str, Any]:
        """An answer that is one line of JSON."""
        self._send(request)
        return json.loads(self._good_line())

    def _samples(self, request: str) -> list[Sample]:
        return [_sample(line) for line in self.ask(request)]

    def _good_line(self) -> str:
        line = self._line()
        if line.startswith("error:"):
            raise ConnectionError(f"the board at {self.url} answered {line!r}")
        return line

    def _send(self, request: str) -> None:
        self._connection.sendall(request.encode("ascii") + b"\n")

    def _line(self) -> str:
        line = self._lines.readline()
        if not line.endswith("\n"):
            raise ConnectionError(f"the board at {self.url} closed its control port")
        return line.rstrip("\n")


def _sample(line: str) -> Sample:
    try:
        time, x, y, z, dx, dy, dz = line.split()
        currents = float(x) * 1e-3, float(y) * 1e-3, float(z) * 1e-3
        return Sample(int(time), currents, (int(dx), int(dy), int(dz)))
    except ValueError as error:
        due = "t_ms ix_mA iy_mA iz_mA dx dy dz"
        raise ConnectionError(f"the board sent {line!r} where '{due}' is due") from error
