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

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.access.caller import KEY as CALLER
from server.access.ended import AccessEnded, closing_unless_still, while_still
from server.access.guard import Admitted, Guard
from server.access.policy import SAFE_METHODS, is_open
from server.api.problems import Problem, internal_error
from server.reception.bodies import capped, read_body, replaying
from server.reception.headers import shown, with_headers
from server.reception.other_sites import is_preflight, lent_to, preflight

log = logging.getLogger(__name__)

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]"})
OWN_SITES = frozenset({"same-origin", "none"})
"""Values of Sec-Fetch-Site that may change something; "same-site" includes other programs on this machine."""

BODY_LIMIT = 1 << 20
"""Largest request body, bytes; the longest honest one, a drawn path of some thousand points, has 100 kB."""

UNKNOWN_BODY_LIMIT = 4 << 10
"""The same before anybody is known, bytes; a login has 60."""

MESSAGE_LIMIT = 64 << 10
"""Largest WebSocket message from a client, bytes; the longest honest one, a scene camera, has 300."""

BODY_TIMEOUT = 10.0
"""Time in which a whole body must have come, s."""


@dataclass(frozen=True, slots=True)
class Limits:
    """unknown_body: of a request that nobody has been asked a token for."""

    body: int = BODY_LIMIT
    unknown_body: int = UNKNOWN_BODY_LIMIT
    message: int = MESSAGE_LIMIT
    body_timeout: float = BODY_TIMEOUT


class Door:
    """Refuses what does not come from the rig's own page or from a program on purpose, and who may not come in.

    hosts: further names under which the server may be asked, beside the loopback names and the address
    that the connection arrived at.  guard: knows who asks; without one, everybody is let in.
    origins: of other sites whose pages may use the rig, such as "https://lab.example".
    """

    def __init__(
        self,
        app: ASGIApp,
        hosts: Collection[str] = (),
        limits: Limits | None = None,
        guard: Guard | None = None,
        origins: Collection[str] = (),
    ) -> None:
        self._app = app
        self._hosts = LOOPBACK_NAMES | {host.lower() for host in hosts}
        self._limits = limits or Limits()
        self._guard = guard or Guard()
        self._origins = frozenset(origins)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            await self._http(scope, receive, send)
        elif scope["type"] == "websocket":
            await self._websocket(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    async def _http(self, scope: Scope, receive: Receive, send: Send) -> None:
        friend = self._friend(Headers(scope=scope))
        send = with_headers(scope, send, lent_to(friend))
        if friend and is_preflight(scope):
            await preflight()(scope, receive, send)
            return
        refused = self._refusal(scope)
        if refused is None:
            admitted = self._guard.admit(scope)
            if isinstance(admitted, Admitted):
                scope[CALLER] = admitted.caller
                await self._let_in(scope, receive, while_still(admitted, send))
                return
            refused = admitted
        await refused(scope, receive, send)

    async def _let_in(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["method"] not in SAFE_METHODS:
            body, problem = await self._body(scope, receive)
            if problem is not None:
                await problem.response()(scope, receive, send)
                return
            receive = replaying(body, receive)
        await self._served(scope, receive, send)

    def _refusal(self, scope: Scope) -> Response | None:
        problem = self._stranger(scope) or self._unsafe(scope)
        return None if problem is None else problem.response()

    async def _served(self, scope: Scope, receive: Receive, send: Send) -> None:
        """The application's answer, or a problem document in its place when it fails before it has begun."""
        started = False

        async def send_noting(message: Message) -> None:
            nonlocal started
            started = True
            await send(message)

        try:
            await self._app(scope, receive, send_noting)
        except AccessEnded:
            log.info("%s was ended: its token or session has ended", scope["path"])
        except Exception:
            log.exception("%s %s failed", scope["method"], scope["path"])
            if started:
                raise
            await internal_error().response()(scope, receive, send)

    async def _websocket(self, scope: Scope, receive: Receive, send: Send) -> None:
        if self._stranger(scope) is not None:
            await send({"type": "websocket.close", "code": 1008, "reason": "not from here"})
            return
        admitted = self._guard.admit(scope)
        if not isinstance(admitted, Admitted):
            await turn_away(receive, send)
            return
        scope[CALLER] = admitted.caller
        watched = closing_unless_still(admitted, send)
        try:
            await self._app(scope, capped(receive, send, self._limits.message), watched)
        except AccessEnded:
            log.info("%s was ended: its token or session has ended", scope["path"])

    def _stranger(self, scope: Scope) -> Problem | None:
        headers = Headers(scope=scope)
        hosts = headers.getlist("host")
        if len(hosts) != 1 or not self._is_own(hosts[0], scope):
            return wrong_host(hosts)
        origins = headers.getlist("origin")
        if origins and origins != [own_origin(scope, hosts[0])] and not self._friend(headers):
            return wrong_origin(origins)
        return None

    def _friend(self, headers: Headers) -> str:
        """The origin of another site that may use the rig, or ""."""
        origins = headers.getlist("origin")
        return origins[0] if len(origins) == 1 and origins[0] in self._origins else ""

    def _is_own(self, host: str, scope: Scope) -> bool:
        name = host_name(host)
        return name in self._hosts or name == arrival_address(scope)

    def _unsafe(self, scope: Scope) -> Problem | None:
        """What a request that changes something must satisfy beyond its origin."""
        if scope["method"] in SAFE_METHODS:
            return None
        headers = Headers(scope=scope)
        site = headers.get("sec-fetch-site")
        if site is not None and site not in OWN_SITES and not self._friend(headers):
            return Problem(
                403, "Not from here", f"Requests from another site ({site}) may not change anything."
            )
        if not is_json(headers) and ("content-type" in headers or has_body(headers)):
            return not_json(headers.get("content-type"))
        return self._announced_too_large(scope, headers)

    def _announced_too_large(self, scope: Scope, headers: Headers) -> Problem | None:
        length = headers.get("content-length", "0")
        if not (length.isascii() and length.isdigit()):
            return Problem(400, "Bad request", "Content-Length must be a number of bytes.")
        limit = self._limit(scope)
        return too_large(limit) if len(length) > 12 or int(length) > limit else None

    def _limit(self, scope: Scope) -> int:
        return self._limits.unknown_body if is_open(scope["path"]) else self._limits.body

    async def _body(self, scope: Scope, receive: Receive) -> tuple[bytes, Problem | None]:
        """The whole body, counted while it comes, since a stream need not announce its length."""
        try:
            async with asyncio.timeout(self._limits.body_timeout):
                body, complete = await read_body(receive, self._limit(scope))
        except TimeoutError:
            return b"", Problem(
                408, "Too slow", f"The body did not come within {self._limits.body_timeout:g} s."
            )
        if not complete:
            return b"", too_large(self._limit(scope))
        if body and not is_json(Headers(scope=scope)):
            return b"", not_json(Headers(scope=scope).get("content-type"))
        return body, None


async def turn_away(receive: Receive, send: Send) -> None:
    """Open a WebSocket only to say why it closes: of one that is never opened, a page cannot tell the reason."""
    await receive()
    await send({"type": "websocket.accept"})
    await send({"type": "websocket.close", "code": 1008, "reason": "token needed"})


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
