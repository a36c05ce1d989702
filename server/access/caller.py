"""Who makes a request: a role that the door has found, and a name that the client gives itself."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated
from urllib.parse import parse_qs

from fastapi import Depends
from starlette.datastructures import Headers
from starlette.requests import HTTPConnection
from starlette.types import Scope

NAME_LENGTH = 60
"""Characters of a client's own name; more is cut."""

KEY = "pivotrig.caller"
"""Where the door leaves the caller in the ASGI scope."""


class Role(IntEnum):
    """Each may do what the one before it may, and more."""

    VIEWER = 1
    OPERATOR = 2
    ADMIN = 3


@dataclass(frozen=True, slots=True)
class Caller:
    """client: what it calls itself (header X-Client, on a WebSocket `?client=`), or "" when it does not.
    principal: by what it was let in, such as one session; two callers with different ones are never the same.
    from_page: a browser sent it.
    """

    role: Role
    principal: str
    address: str
    client: str
    from_page: bool

    @property
    def key(self) -> str:
        """Equal for two requests of one client, and for nobody else's as far as can be told."""
        return "\n".join((self.principal, self.address, self.client))


def caller_of(scope: Scope) -> Caller:
    """As the door left it."""
    return scope[KEY]


def introduced(scope: Scope, role: Role, principal: str) -> Caller:
    """The caller of a request that the door lets in as `role`."""
    headers = Headers(scope=scope)
    asked = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("client", [""])
    name = headers.get("x-client") or (asked[0] if scope["type"] == "websocket" else "")
    client = "".join(letter for letter in name if letter.isprintable()).strip()[:NAME_LENGTH]
    peer = scope.get("client")
    from_page = "sec-fetch-site" in headers or "origin" in headers
    return Caller(role, principal, peer[0] if peer else "", client, from_page)


async def the_caller(connection: HTTPConnection) -> Caller:
    return caller_of(connection.scope)


TheCaller = Annotated[Caller, Depends(the_caller)]
