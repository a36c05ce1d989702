"""The twin board as a process of its own: its UART on a pseudo-terminal, its time on a lock-step port.

    python -m control.simulation.board_process --control-port 0

prints one line, `board: serial=/dev/pts/N control=tcp://127.0.0.1:PORT`, and ends some seconds after its last
client has gone, or on SIGTERM.
"""

from __future__ import annotations

import argparse
import os
import pty
import signal
import time
import tty
from types import FrameType

from control.simulation.board import RECEIVE_BUFFER, TwinBoard, Winding
from control.simulation.lockstep_server import LockstepServer

PATIENCE = 60.0
"""How long to wait for a first client, s."""

PACE = 2e-3
"""Longest sleep of a free-running board, s; it makes up the milliseconds that it slept."""


class PseudoTerminal:
    """A raw terminal pair; the host opens `name` as its serial port.

    The host's end is kept open here too, so that the port outlives a host that closes it.
    """

    def __init__(self) -> None:
        self._board_end, self._host_end = pty.openpty()
        tty.setraw(self._host_end)
        os.set_blocking(self._board_end, False)
        self.name = os.ttyname(self._host_end)
        self._unsent = b""

    def exchange(self, board: TwinBoard) -> None:
        """Carries the bytes that wait on either side."""
        room = board.room
        if room > 0:
            board.write(self._read(room))
        self._unsent += board.read(RECEIVE_BUFFER - len(self._unsent))
        if self._unsent:
            self._unsent = self._unsent[self._write(self._unsent) :]

    def _read(self, most: int) -> bytes:
        try:
            return os.read(self._board_end, most)
        except BlockingIOError:
            return b""

    def _write(self, data: bytes) -> int:
        """As much as the terminal takes; a host that does not read loses what comes after."""
        try:
            return os.write(self._board_end, data)
        except BlockingIOError:
            return 0

    def close(self) -> None:
        os.close(self._board_end)
        os.close(self._host_end)


class BoardProcess:
    """Board, terminal and server together until nobody wants them."""

    def __init__(self, board: TwinBoard, control_port: int, linger: float) -> None:
        self._board = board
        self._linger = linger
        self._terminal = PseudoTerminal()
        self._server = LockstepServer(board, control_port, time.monotonic, self._exchange)
        self._waited_since = time.monotonic()
        self._is_ending = False

    def _exchange(self) -> None:
        self._terminal.exchange(self._board)

    @property
    def greeting(self) -> str:
        return f"board: serial={self._terminal.name} control={self._server.url}"

    def end(self, _signal: int, _frame: FrameType | None) -> None:
        self._is_ending = True

    def run(self) -> None:
        try:
            while not self._is_ending and not self._is_forgotten():
                self._server.serve(PACE if self._server.is_running else 0.05)
        finally:
            self._server.close()
            self._terminal.close()

    def _is_forgotten(self) -> bool:
        now = time.monotonic()
        if self._server.left_at is not None:
            return now - self._server.left_at > self._linger
        return not self._server.was_visited and now - self._waited_since > max(PATIENCE, self._linger)


def main() -> None:
    options = _options()
    x, y, z = (
        Winding(r, mh * 1e-3) for r, mh in zip(options.resistance_ohm, options.inductance_mH, strict=True)
    )
    board = TwinBoard("", (x, y, z), options.supply_V, options.boot_id)
    process = BoardProcess(board, options.control_port, options.linger)
    signal.signal(signal.SIGTERM, process.end)
    signal.signal(signal.SIGINT, process.end)
    print(process.greeting, flush=True)
    process.run()


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="The simulated board on a pseudo-terminal.")
    parser.add_argument(
        "--control-port", type=int, default=0, help="TCP port on loopback; 0 picks a free one"
    )
    parser.add_argument("--linger", type=float, default=10.0, help="seconds to live after the last client")
    parser.add_argument("--boot-id", type=int, default=1)
    parser.add_argument("--supply-V", dest="supply_V", type=float, default=24.0)
    parser.add_argument("--resistance-ohm", type=float, nargs=3, default=[2.5, 2.0, 1.5])
    parser.add_argument(
        "--inductance-mH", dest="inductance_mH", type=float, nargs=3, default=[125.0, 55.0, 14.0]
    )
    return parser.parse_args()


if __name__ == "__main__":
    main()
