"""Pages of other sites that the operator has named: what a browser must be told so that they may use the rig."""

from __future__ import annotations

from collections.abc import Mapping

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import Scope

METHODS = "GET, POST, PUT, PATCH, DELETE"
HEADERS = "Authorization, Content-Type, X-Client"
REMEMBERED = "600"
"""How long a browser may keep the answer, s."""


def lent_to(origin: str) -> Mapping[str, str]:
    """Headers of an answer to a page from there; none for "". No cookies: such a page shows a token of its own."""
    if not origin:
        return {}
    return {
        "Access-Control-Allow-Origin": origin,
        "Vary": "Origin",
        "Cross-Origin-Resource-Policy": "cross-origin",
    }


def is_preflight(scope: Scope) -> bool:
    """A browser's question before a request, which carries nothing and does nothing."""
    return scope["method"] == "OPTIONS" and "access-control-request-method" in Headers(scope=scope)


def preflight() -> Response:
    return Response(
        status_code=204,
        headers={
            "Access-Control-Allow-Methods": METHODS,
            "Access-Control-Allow-Headers": HEADERS,
            "Access-Control-Max-Age": REMEMBERED,
        },
    )
