"""Who may speak to the rig's computer at all, and how: one ASGI layer in front of HTTP and WebSocket alike.

A web page from anywhere can make the operator's browser send requests to this machine. So the Host must be
a name of this machine (a page that rebinds its own name to 127.0.0.1 still says its own name), the Origin
must be the one that is asked, and a body must be JSON, which a foreign page cannot send unasked.
"""

from __future__ import annotations

import asyncio
import ipaddress
import logging
from collections.abc import Collection
from dataclasses import dataclass

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.access.caller import KEY as CALLER
from server.access.caller import Role, introduced
from server.api.problems import Problem, internal_error
from server.page_policy import content_policy

log = logging.getLogger(__name__)

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]"})
OWN_SITES = frozenset({"same-origin", "none"})
"""Values of Sec-Fetch-Site that may change something; "same-site" includes other programs on this machine."""

REFUSED_FEATURES = "camera=(), microphone=(), geolocation=(), payment=(), usb=(), serial=()"
"""What of the looking computer no page of ours ever asks for."""

BODY_LIMIT = 1 << 20
"""Largest request body, bytes; the longest honest one, a drawn path of some thousand points, has 100 kB."""

MESSAGE_LIMIT = 64 << 10
"""Largest WebSocket message from a client, bytes; the longest honest one, a scene camera, has 300."""

BODY_TIMEOUT = 10.0
"""Time in which a whole body must have come, s."""


@dataclass(frozen=True, slots=True)
class Limits:
    body: int = BODY_LIMIT
    message: int = MESSAGE_LIMIT
    body_timeout: float = BODY_TIMEOUT


class Door:
    """Refuses what does not come from the rig's own page or from a program on purpose.

    hosts: further names under which the server may be asked, beside the loopback names and the address
    that the connection arrived at.
    """

    def __init__(self, app: ASGIApp, hosts: Collection[str] = (), limits: Limits | None = None) -> None:
        self._app = app
        self._hosts = LOOPBACK_NAMES | {host.lower() for host in hosts}
        self._limits = limits or Limits()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            await self._http(scope, receive, send)
        elif scope["type"] == "websocket":
            await self._websocket(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    async def _http(self, scope: Scope, receive: Receive, send: Send) -> None:
        send = with_headers(scope, send)
        problem = self._stranger(scope) or self._unsafe(scope)
        scope[CALLER] = introduced(scope, Role.ADMIN, "")
        if problem is None and scope["method"] not in SAFE_METHODS:
            body, problem = await self._body(scope, receive)
            receive = replaying(body, receive)
        if problem is not None:
            await problem.response()(scope, receive, send)
        else:
            await self._served(scope, receive, send)

    async def _served(self, scope: Scope, receive: Receive, send: Send) -> None:
        """The application's answer, or a problem document in its place when it fails before it has begun."""
        started = False

        async def send_noting(message: Message) -> None:
            nonlocal started
            started = True
            await send(message)

        try:
            await self._app(scope, receive, send_noting)
        except Exception:
            log.exception("%s %s failed", scope["method"], scope["path"])
            if started:
                raise
            await internal_error().response()(scope, receive, send)

    async def _websocket(self, scope: Scope, receive: Receive, send: Send) -> None:
        if self._stranger(scope) is not None:
            await send({"type": "websocket.close", "code": 1008, "reason": "not from here"})
            return
        scope[CALLER] = introduced(scope, Role.ADMIN, "")
        await self._app(scope, capped(receive, send, self._limits.message), send)

    def _stranger(self, scope: Scope) -> Problem | None:
        headers = Headers(scope=scope)
        hosts = headers.getlist("host")
        if len(hosts) != 1 or not self._is_own(hosts[0], scope):
            return wrong_host(hosts)
        origins = headers.getlist("origin")
        if origins and origins != [own_origin(scope, hosts[0])]:
            return wrong_origin(origins)
        return None

    def _is_own(self, host: str, scope: Scope) -> bool:
        name = host_name(host)
        return name in self._hosts or name == arrival_address(scope)

    def _unsafe(self, scope: Scope) -> Problem | None:
        """What a request that changes something must satisfy beyond its origin."""
        if scope["method"] in SAFE_METHODS:
            return None
        headers = Headers(scope=scope)
        site = headers.get("sec-fetch-site")
        if site is not None and site not in OWN_SITES:
            return Problem(
                403, "Not from here", f"Requests from another site ({site}) may not change anything."
            )
        if not is_json(headers) and ("content-type" in headers or has_body(headers)):
            return not_json(headers.get("content-type"))
        return self._announced_too_large(headers)

    def _announced_too_large(self, headers: Headers) -> Problem | None:
        length = headers.get("content-length", "0")
        if not (length.isascii() and length.isdigit()):
            return Problem(400, "Bad request", "Content-Length must be a number of bytes.")
        return too_large(self._limits.body) if len(length) > 12 or int(length) > self._limits.body else None

    async def _body(self, scope: Scope, receive: Receive) -> tuple[bytes, Problem | None]:
        """The whole body, counted while it comes, since a stream need not announce its length."""
        try:
            async with asyncio.timeout(self._limits.body_timeout):
                body, complete = await read_body(receive, self._limits.body)
        except TimeoutError:
            return b"", Problem(
                408, "Too slow", f"The body did not come within {self._limits.body_timeout:g} s."
            )
        if not complete:
            return b"", too_large(self._limits.body)
        if body and not is_json(Headers(scope=scope)):
            return b"", not_json(Headers(scope=scope).get("content-type"))
        return body, None


def host_name(host: str) -> str:
    """The name in a Host header without its port; a port is not checked, so that a tunnel may use another."""
    name, colon, port = host.lower().rpartition(":")
    return name if colon and port.isdigit() and port.isascii() else host.lower()


def arrival_address(scope: Scope) -> str | None:
    """The address that this connection arrived at, as a Host header spells it; no rebound name is one."""
    server = scope.get("server")
    if not server:
        return None
    try:
        address = ipaddress.ip_address(server[0])
    except ValueError:
        return None
    return f"[{address}]" if address.version == 6 else str(address)


def own_origin(scope: Scope, host: str) -> str:
    scheme = {"ws": "http", "wss": "https"}.get(scope["scheme"], scope["scheme"])
    return f"{scheme}://{host}"


def is_json(headers: Headers) -> bool:
    return headers.get("content-type", "").partition(";")[0].strip().lower() == "application/json"


def has_body(headers: Headers) -> bool:
    return "transfer-encoding" in headers or headers.get("content-length", "0") != "0"


def wrong_host(hosts: list[str]) -> Problem:
    asked = ", ".join(hosts) or "nothing"
    return Problem(
        403,
        "Unknown host",
        f"This rig is not called {shown(asked)}. Open it as localhost or 127.0.0.1, or by its own address.",
    )


def wrong_origin(origins: list[str]) -> Problem:
    return Problem(
        403,
        "Not from here",
        f"A page from {shown(', '.join(origins))} may not use this rig; open the rig's own page.",
    )


def not_json(received: str | None) -> Problem:
    return Problem(
        415,
        "JSON only",
        f"The body is {shown(received or 'of no stated type')}; send it as Content-Type: application/json.",
    )


def too_large(limit: int) -> Problem:
    return Problem(413, "Too large", f"A body may have at most {limit} bytes.")


def shown(text: str) -> str:
    """Foreign text, fit to be repeated in an answer."""
    return text.encode("ascii", "replace").decode()[:100]


async def read_body(receive: Receive, limit: int) -> tuple[bytes, bool]:
    """The body as far as `limit` bytes, and whether that is all of it."""
    chunks: list[bytes] = []
    size = 0
    while True:
        message = await receive()
        chunk = message.get("body", b"")
        size += len(chunk)
        if size > limit:
            return b"", False
        chunks.append(chunk)
        if message["type"] != "http.request" or not message.get("more_body", False):
            return b"".join(chunks), True


def replaying(body: bytes, receive: Receive) -> Receive:
    """A receive that gives the body that has been read, then whatever comes after it."""
    first: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def replay() -> Message:
        return first.pop() if first else await receive()

    return replay


def capped(receive: Receive, send: Send, limit: int) -> Receive:
    """A receive that ends the connection with 1009 when a message is longer than `limit` bytes."""

    async def receive_capped() -> Message:
        message = await receive()
        text, data = message.get("text") or "", message.get("bytes") or b""
        if message["type"] != "websocket.receive" or max(len(text), len(data)) <= limit:
            return message
        await send({"type": "websocket.close", "code": 1009, "reason": f"at most {limit} bytes a message"})
        return {"type": "websocket.disconnect", "code": 1009}

    return receive_capped


def with_headers(scope: Scope, send: Send) -> Send:
    """A send that adds the headers which keep a browser from lending this page to others."""
    host = shown(Headers(scope=scope).get("host", ""))
    safe_host = "".join(c for c in host if c.isalnum() or c in ".-:[]")

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers["Content-Security-Policy"] = content_policy(scope["path"], safe_host)
            headers["X-Content-Type-Options"] = "nosniff"
            headers["Referrer-Policy"] = "no-referrer"
            headers["Cross-Origin-Resource-Policy"] = "same-origin"
            headers["Cross-Origin-Opener-Policy"] = "same-origin"
            headers["Permissions-Policy"] = REFUSED_FEATURES
            headers.setdefault("Cache-Control", "no-store")
        await send(message)

    return send_with_headers
