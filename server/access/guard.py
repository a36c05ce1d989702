"""Who is let in, and as whom: the one guard of everything that the server answers.

On loopback, without tokens, everybody is the person at the computer. Anywhere else each request shows a token, as
`Authorization: Bearer` or by the cookie of a session that was opened with one.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from urllib.parse import quote

from starlette.datastructures import Headers
from starlette.responses import RedirectResponse, Response
from starlette.types import Scope

from server.access.addresses import site_of
from server.access.attempts import Attempts
from server.access.caller import Caller, introduced
from server.access.policy import is_open, role_needed
from server.access.roles import Role
from server.access.sessions import Session, Sessions
from server.access.tokens import Tokens, digest_of
from server.api.problems import Problem

COOKIE = "pivotrig_session"
NOBODY = "nobody"
"""The principal of who has shown nothing; only open places are answered."""
FORWARDED = ("x-forwarded-for", "x-forwarded-host", "x-forwarded-proto", "forwarded", "x-real-ip")

CHALLENGE = {"WWW-Authenticate": 'Bearer realm="pivotrig"'}

Clock = Callable[[], float]


@dataclass(frozen=True, slots=True)
class Admitted:
    """still: asked again while a stream goes on; False once the token or the session has ended."""

    caller: Caller
    still: Callable[[], bool] = field(default=lambda: True)


class Guard:
    """tokens: None where nobody needs one."""

    def __init__(self, tokens: Tokens | None = None, clock: Clock = time.monotonic) -> None:
        self._tokens = tokens
        self._attempts = Attempts(clock)
        self.sessions = Sessions(clock)

    @property
    def demands_token(self) -> bool:
        return self._tokens is not None

    def admit(self, scope: Scope) -> Admitted | Response:
        """Who this is, or the answer that they get instead of what they asked for."""
        headers = Headers(scope=scope)
        if self._tokens is None:
            if found := [name for name in FORWARDED if name in headers]:
                return unnamed_proxy(found).response()
            return Admitted(introduced(scope, Role.ADMIN, "here"))
        if is_open(scope["path"]) and scope["type"] == "http":
            return Admitted(introduced(scope, Role.VIEWER, NOBODY))
        found = self._known(scope, headers)
        if not isinstance(found, Admitted):
            return found
        needed = role_needed(scope["method"], scope["path"]) if scope["type"] == "http" else Role.VIEWER
        return found if found.caller.role >= needed else too_low(found.caller.role, needed).response()

    def _known(self, scope: Scope, headers: Headers) -> Admitted | Response:
        tokens = headers.getlist("authorization")
        if tokens:
            return self._bearer(scope, tokens)
        cookie = session_cookie(headers)
        session = self._session(cookie)
        if session is not None:
            caller = introduced(scope, session.role, "session " + digest_of(cookie)[:16])
            return Admitted(caller, lambda: self._session(cookie) is not None)
        if wants_page(scope, headers):
            return RedirectResponse(f"/login?next={quote(scope['path'], safe='/')}", 303)
        return no_token().response()

    def _bearer(self, scope: Scope, values: Collection[str]) -> Admitted | Response:
        role = self._role_shown(values)
        if role is not None:
            [value] = values
            caller = introduced(scope, role, "token " + role.name.lower())
            return Admitted(caller, lambda: self._role_shown([value]) is role)
        site = site_of(caller_address(scope))
        wait = self._attempts.wait(site)
        if wait > 0.0:
            return too_often(wait).response()
        self._attempts.fail(site)
        return wrong_token().response()

    def _role_shown(self, values: Collection[str]) -> Role | None:
        if len(values) != 1 or self._tokens is None:
            return None
        scheme, _, token = next(iter(values)).partition(" ")
        return self._tokens.role_of(token.strip()) if scheme.lower() == "bearer" else None

    def _session(self, cookie: str) -> Session | None:
        """An open session whose token is still good."""
        session = self.sessions.find(cookie) if cookie else None
        if session is None or self._tokens is None:
            return None
        if self._tokens.digests.get(session.role) != session.token:
            self.sessions.close(cookie)
            return None
        return session

    def log_in(self, token: str, address: str) -> tuple[str, Role] | Problem:
        """The cookie of a new session and its role."""
        if self._tokens is None:
            return Problem(409, "No login", "This server asks nobody for a token; open its page.")
        site = site_of(address)
        wait = self._attempts.wait(site)
        if wait > 0.0:
            return too_often(wait)
        role = self._tokens.role_of(token.strip())
        if role is None:
            self._attempts.fail(site)
            return wrong_token()
        return self.sessions.open(role, self._tokens.digests[role]), role

    def log_out(self, headers: Headers) -> None:
        self.sessions.close(session_cookie(headers))


def caller_address(scope: Scope) -> str:
    peer = scope.get("client")
    return peer[0] if peer else ""


def session_cookie(headers: Headers) -> str:
    """The session's cookie, or ""."""
    try:
        found = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return found.value if found is not None else ""


def wants_page(scope: Scope, headers: Headers) -> bool:
    return scope["type"] == "http" and scope["method"] == "GET" and "text/html" in headers.get("accept", "")


def no_token() -> Problem:
    return Problem(
        401,
        "Token needed",
        "This rig asks for a token: send it as Authorization: Bearer TOKEN, or log in at /login.",
        headers=CHALLENGE,
    )


def wrong_token() -> Problem:
    return Problem(
        401,
        "Wrong token",
        "This is no token of this rig, or not any more; `pivotrig token new` on its computer makes a new one.",
        headers=CHALLENGE,
    )


def too_often(wait: float) -> Problem:
    seconds = str(int(wait) + 1)
    detail = f"Too many wrong tokens have come from here; try again in {seconds} s."
    return Problem(429, "Too many attempts", detail, headers={"Retry-After": seconds})


def too_low(role: Role, needed: Role) -> Problem:
    return Problem(
        403,
        "Not your role",
        f"This needs the {needed.name.lower()} token, and you came as {role.name.lower()}; log in with the other one.",
    )


def unnamed_proxy(headers: Collection[str]) -> Problem:
    return Problem(
        403,
        "Unnamed proxy",
        f"This request came through a proxy ({', '.join(headers)}), behind which anybody could stand, and this server "
        "asks nobody for a token. Start pivotrig with --proxy ADDRESS, which names the proxy and demands tokens.",
    )
