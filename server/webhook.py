"""One HTTP POST to an address outside, within a time that nobody on the other side can stretch."""

from __future__ import annotations

import http.client
import json
import socket
import ssl
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit, urlunsplit

REDIRECTS = range(300, 400)


class NotDelivered(Exception):
    """The other side has not taken it; the text says why, without the address."""


@dataclass(slots=True)
class Call:
    """One attempt. timeout: s, from the first byte to the last. It can be broken off from another thread."""

    url: str
    timeout: float
    _connection: http.client.HTTPConnection | None = None
    _one_at_a_time: threading.Lock = field(default_factory=threading.Lock)
    _broken_off: bool = False

    def post(self, body: Mapping[str, Any]) -> int:
        """Send it; the status that it was taken with. Raises `NotDelivered`."""
        alarm = threading.Timer(self.timeout, self.break_off)
        alarm.name, alarm.daemon = "webhook's time-out", True
        alarm.start()
        try:
            return self._post(body)
        except (OSError, http.client.HTTPException, ValueError) as error:
            raise NotDelivered(self._why(error)) from error
        finally:
            alarm.cancel()
            self._close()

    def _post(self, body: Mapping[str, Any]) -> int:
        connection, target = self._connect()
        content = json.dumps(body).encode()
        headers = {"Content-Type": "application/json", "User-Agent": "pivotrig", "Connection": "close"}
        connection.request("POST", target, content, headers)
        status = connection.getresponse().status
        if 200 <= status < 300:
            return status
        where = "; it points elsewhere, which is not followed" if status in REDIRECTS else ""
        raise NotDelivered(f"the other side answered {status} {http.client.responses.get(status, '')}{where}")

    def _connect(self) -> tuple[http.client.HTTPConnection, str]:
        """Without proxies and redirects: it goes where the rig file says, and nowhere else."""
        parts = urlsplit(self.url)
        kind = http.client.HTTPSConnection if parts.scheme == "https" else http.client.HTTPConnection
        connection = kind(parts.hostname or "", parts.port, timeout=self.timeout)
        with self._one_at_a_time:
            if self._broken_off:
                raise TimeoutError
            self._connection = connection
        connection.connect()
        if self._broken_off:  # while its name was looked up, or between two of its addresses
            raise TimeoutError
        return connection, urlunsplit(("", "", parts.path or "/", parts.query, ""))

    def break_off(self) -> None:
        """End it now."""
        with self._one_at_a_time:
            self._broken_off = True
            connection = self._connection
        if connection is not None and connection.sock is not None:
            try:
                connection.sock.shutdown(socket.SHUT_RDWR)
            except OSError:
                return  # it has ended by itself

    def _close(self) -> None:
        if self._connection is not None:
            self._connection.close()

    def _why(self, error: Exception) -> str:
        if self._broken_off or isinstance(error, TimeoutError):
            return f"the other side has not answered within {self.timeout:g} s"
        if isinstance(error, socket.gaierror):
            return "its host's name is not known here"
        if isinstance(error, ConnectionRefusedError):
            return "nobody listens at its address"
        if isinstance(error, ssl.SSLError):
            return f"no safe connection could be made ({error.reason or 'TLS'})"
        return f"the connection failed ({type(error).__name__})"
