"""The serial link to the board: a pyserial port around a `Session`.

It has no thread: `poll` is called once a tick.  Only `stop` may come from another thread.
"""

from __future__ import annotations

import termios
import threading
import time
from collections.abc import Callable

import serial
from serial.serialutil import SerialTimeoutException

from control.link.conversion import Configuration, DriveCommand, LinkError, Telemetry
from control.link.session import LinkState, Session
from control.snapshot import LinkStatus

WRITE_TIMEOUT = 0.03
"""A port that takes no bytes for so long is jammed, s: two frames, once. Shorter, and pyserial, which looks at the
clock only after it has written, would call a port jammed when the computer was busy for that long."""

LAST_WORDS = 0.02
"""How long a closing port may take to send what it was given, the stop above all, s."""

FIRST_RETRY = 0.5
LAST_RETRY = 5.0
"""Back-off between attempts to open a lost port, s; doubled each time."""

PORT_ERRORS = (OSError, termios.error)
"""What a port that fails raises: pyserial lets the terminal's own error through, which is no OSError."""

MOST_BYTES = 4096
"""Read at one poll at most: 70 reports."""


class Link:
    """One board on one port; `clock` is the rig's clock, s."""

    def __init__(
        self, port: str, baud: int, configuration: Configuration, clock: Callable[[], float]
    ) -> None:
        self.port = port
        self._baud = baud
        self._clock = clock
        self._session = Session(configuration)
        self._serial: serial.Serial | None = None
        self._writing = threading.Lock()
        self._stop_is_due = False
        self._wanted = False
        self._retry_after = FIRST_RETRY
        self._retry_at = 0.0

    # ---- opening, losing, closing

    def open(self) -> None:
        """Opens the port and begins to greet the board; LinkError says what is wrong with the port."""
        if self._serial is not None:
            return
        self._wanted = True
        try:
            self._serial = _open_port(self.port, self._baud)
        except LinkError as error:
            self._wanted = False
            self._session.lose(str(error))
            raise
        self._retry_after = FIRST_RETRY
        self._session.open()

    def close(self) -> None:
        """Zero, then close."""
        self.stop()
        self._wanted = False
        self._release()
        self._session.lose("closed")

    def _release(self) -> None:
        with self._writing:
            port, self._serial = self._serial, None
            if port is None:
                return
            try:
                _drain(port)
            except PORT_ERRORS as error:
                self._session.reason = f"{self.port} is gone: {error}"
            port.close()

    def _lose(self, reason: str) -> None:
        """The port failed: let go of it and try again later; the board zeroes itself meanwhile."""
        self._release()
        self._session.lose(reason)
        self._retry_at = self._clock() + self._retry_after
        self._retry_after = min(2.0 * self._retry_after, LAST_RETRY)

    def _reopen(self) -> None:
        if not self._wanted or self._clock() < self._retry_at:
            return
        try:
            self._serial = _open_port(self.port, self._baud)
        except LinkError as error:
            self._lose(str(error))
            return
        self._session.open()

    def greet(self) -> None:
        """Greet the board anew, which zeroes its coils and clears a fault that it has latched."""
        if self._serial is not None:
            self._session.open()

    # ---- the tick

    def poll(self) -> Telemetry | None:
        """Reads what is there and advances the handshake; the newest report of a ready board."""
        if self._serial is None:
            self._reopen()
        if self._serial is None:
            return None
        now = self._clock()
        try:
            telemetry = self._session.receive(self._read(self._serial), now)
        except PORT_ERRORS as error:
            self._lose(f"lost {self.port}: {error}")
            return None
        if telemetry is not None:
            self._retry_after = FIRST_RETRY
        elif not self.is_ready:
            self._ask(now)
        self._send_due_stop()
        return telemetry

    def _ask(self, now: float) -> None:
        try:
            self._write(lambda: self._session.due(now))
        except LinkError as error:
            self._session.reason = str(error)

    @staticmethod
    def _read(port: serial.Serial) -> bytes:
        waiting = min(port.in_waiting, MOST_BYTES)
        return port.read(waiting) if waiting else b""

    def drive(self, command: DriveCommand) -> None:
        """Sends a command; LinkError when the board is not ready or the command is not allowed."""
        now = self._clock()
        self._write(lambda: self._session.drive(command, now))

    def stop(self) -> None:
        """Zero now, from any thread, in any state; never waits for a write that is going on.

        Who holds the line sends the stop when its own write is done.
        """
        self._stop_is_due = True
        self._send_due_stop()

    def _send_due_stop(self) -> None:
        while self._stop_is_due and self._writing.acquire(blocking=False):
            try:
                self._stop_is_due = False
                if self._serial is not None:
                    self._serial.write(self._session.stop())
            except PORT_ERRORS:
                self._session.reason = f"{self.port} did not take the stop; the board's dead-man acts"
            finally:
                self._writing.release()

    def _write(self, compose: Callable[[], bytes]) -> None:
        """Numbers and sends a message, one at a time; a port that fails is let go of."""
        try:
            with self._writing:
                self._put(compose)
        except SerialTimeoutException as error:
            self._lose(f"{self.port} is jammed: it took no bytes for {WRITE_TIMEOUT} s")
            raise LinkError(self._session.reason) from error
        except PORT_ERRORS as error:
            self._lose(f"lost {self.port}: {error}")
            raise LinkError(self._session.reason) from error
        finally:
            self._send_due_stop()

    def _put(self, compose: Callable[[], bytes]) -> None:
        if self._serial is None:
            raise LinkError(f"the link to {self.port} is closed: {self._session.reason}")
        frame = compose()
        if frame:
            self._serial.write(frame)

    # ---- what it is like

    @property
    def reason(self) -> str:
        """Why the link is not ready, for people; empty when it is."""
        return self._session.reason

    @property
    def incident(self) -> str:
        """Why the conversation with the board broke last; empty again after the next arm edge."""
        return self._session.incident

    @property
    def is_ready(self) -> bool:
        return self._session.state is LinkState.READY

    @property
    def status(self) -> LinkStatus:
        session = self._session
        telemetry = session.telemetry
        return LinkStatus(
            state=session.state.value,
            port=self.port,
            firmware=session.firmware,
            boot_id=session.boot_id,
            round_trip=session.round_trip,
            bad_frames=session.broken_frames,
            board_state="" if telemetry is None else telemetry.state.value,
            board_faults=() if telemetry is None else telemetry.faults,
            supply=0.0 if telemetry is None else telemetry.supply,
        )


def _open_port(port: str, baud: int) -> serial.Serial:
    """The open port; nothing blocks on it for longer than WRITE_TIMEOUT."""
    try:
        opened = serial.serial_for_url(
            port, baudrate=baud, timeout=0, write_timeout=WRITE_TIMEOUT, exclusive=True
        )
    except (*PORT_ERRORS, ValueError) as error:
        raise LinkError(
            f"cannot open {port} at {baud} baud: {error}. Check that it is connected, that no other program "
            "has it open, and that you may use it (group dialout)"
        ) from error
    return opened


def _drain(port: serial.Serial) -> None:
    """Lets the last bytes out; what a jammed line keeps is thrown away, since closing would wait for it."""
    until = time.monotonic() + LAST_WORDS
    while port.out_waiting > 0:
        if time.monotonic() > until:
            port.reset_output_buffer()
            return
        time.sleep(1e-3)
