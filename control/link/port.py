"""The serial link to the board: a pyserial port around a `Session`.

It has no thread: `poll` is called once a tick.  Only `stop` may come from another thread.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

from serial.serialutil import SerialTimeoutException

from control.link.conversion import Configuration, DriveCommand, LinkError, Telemetry
from control.link.discovery import locator
from control.link.line import SerialLine, Wrap
from control.link.opening import PORT_ERRORS, WRITE_TIMEOUT, PortError, open_serial, trouble_of
from control.link.session import LinkState, Session
from control.snapshot import LinkCounts, LinkStatus

log = logging.getLogger(__name__)

LAST_WORDS = 0.02
"""How long a closing port may take to send what it was given, the stop above all, s."""

FIRST_RETRY = 0.5
LAST_RETRY = 5.0
"""Back-off between attempts to open a lost port, s; doubled each time."""

MOST_BYTES = 4096
"""Read at one poll at most: 70 reports."""


class Link:
    """One board on one port; `clock` is the rig's clock, s.

    port: a name, a pyserial URL, or "auto" for the one board that is plugged in; once open, where it is.
    wrap: put before the port each time it is opened; `put_before` adds another.
    """

    def __init__(
        self,
        port: str,
        baud: int,
        configuration: Configuration,
        clock: Callable[[], float],
        wrap: Wrap | None = None,
    ) -> None:
        self.port = port
        self._locate = locator(port)
        self._baud = baud
        self._clock = clock
        self._wraps: list[Wrap] = [] if wrap is None else [wrap]
        self._session = Session(configuration)
        self._serial: SerialLine | None = None
        self._writing = threading.Lock()
        self._stop_is_due = False
        self._wanted = False
        self._retry_after = FIRST_RETRY
        self._retry_at = 0.0
        self._sent = 0
        self._reconnects = 0

    # ---- opening, losing, closing

    def open(self, *, patiently: bool = False) -> None:
        """Opens the port and begins to greet the board; LinkError says what is wrong with the port.

        patiently: a port that cannot be opened is tried again later, like one that was lost.
        """
        if self._serial is not None:
            return
        self._wanted = True
        try:
            self._serial = self._open_port()
        except LinkError as error:
            self._lose(str(error))
            if patiently:
                log.warning("%s; trying again", error)
                return
            self._wanted = False
            raise
        self._retry_after = FIRST_RETRY
        self._session.open()

    def close(self) -> None:
        """Zero, then close."""
        self.stop()
        self._wanted = False
        with self._writing:
            # who was writing just now may find the port gone, and the stop with it
            self._send_stop()
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
            _let_go(port)

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
            self._serial = self._open_port()
        except LinkError as error:
            self._lose(str(error))
            return
        self._reconnects += 1
        self._session.open()

    def _open_port(self) -> SerialLine:
        """Where the port is now, open; it may have come back under another name."""
        self.port = self._locate()
        line = open_serial(self.port, self._baud)
        try:
            for wrap in self._wraps:
                line = wrap(line)
        except OSError as error:
            line.close()
            raise PortError(f"cannot use {self.port}: {error}", trouble_of(error)) from error
        return line

    def put_before(self, wrap: Wrap) -> None:
        """Also put this before the port, outermost, from the next opening on."""
        self._wraps.append(wrap)

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
    def _read(port: SerialLine) -> bytes:
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
                self._send_stop()
            finally:
                self._writing.release()

    def _send_stop(self) -> None:
        """The stop that is due, if one is; the line is the caller's."""
        if not self._stop_is_due:
            return
        self._stop_is_due = False
        try:
            if self._serial is not None:
                self._serial.write(self._session.stop())
                self._sent += 1
        except PORT_ERRORS:
            self._session.reason = f"{self.port} did not take the stop; the board's dead-man acts"

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
            self._sent += 1

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
    def bad_share(self) -> float:
        """0..1 of the last second's frames that arrived broken, in the worse direction."""
        return self._session.bad_share(self._clock())

    @property
    def lateness(self) -> float:
        """How long a command and its echo certainly take since the arm edge, s."""
        return self._session.echoes.lateness

    @property
    def status(self) -> LinkStatus:
        session = self._session
        telemetry = session.telemetry
        round_trips = session.echoes.round_trips
        median, p99 = round_trips.figures or (None, None)
        return LinkStatus(
            state=session.state.value,
            port=self.port,
            firmware=session.firmware,
            boot_id=session.boot_id,
            round_trip=round_trips.newest,
            round_trip_median=median,
            round_trip_p99=p99,
            bad_frames=session.broken_frames,
            bad_share=self.bad_share,
            counts=self._counts(telemetry),
            board_state="" if telemetry is None else telemetry.state.value,
            board_faults=() if telemetry is None else telemetry.faults,
            supply=0.0 if telemetry is None else telemetry.supply,
        )

    def _counts(self, telemetry: Telemetry | None) -> LinkCounts:
        session = self._session
        return LinkCounts(
            sent=self._sent,
            received=session.received,
            broken=session.broken_by_kind,
            resends=session.resends,
            reconnects=self._reconnects,
            board_bad=0 if telemetry is None else telemetry.bad,
            refused=0 if telemetry is None else telemetry.refused,
            stale=0 if telemetry is None else telemetry.stale,
        )


def _drain(port: SerialLine) -> None:
    """Lets the last bytes out; what a jammed line keeps is thrown away, since closing would wait for it."""
    until = time.monotonic() + LAST_WORDS
    while port.out_waiting > 0:
        if time.monotonic() > until:
            port.reset_output_buffer()
            return
        time.sleep(1e-3)


def _let_go(port: SerialLine) -> None:
    try:
        port.close()
    except PORT_ERRORS:
        log.debug("a port that is gone complained when it was closed", exc_info=True)
