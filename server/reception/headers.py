"""What each answer tells the browser about itself, so that this page is not lent to others."""

from __future__ import annotations

from collections.abc import Mapping

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import Message, Scope, Send

from server.page_policy import content_policy

REFUSED_FEATURES = "camera=(), microphone=(), geolocation=(), payment=(), usb=(), serial=()"
"""What of the looking computer no page of ours ever asks for."""


def shown(text: str) -> str:
    """Foreign text, fit to be repeated in an answer."""
    return text.encode("ascii", "replace").decode()[:100]


def with_headers(scope: Scope, send: Send, more: Mapping[str, str]) -> Send:
    """A send that adds the headers which keep a browser from lending this page to others, and `more`."""
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
            headers.update(more)
        await send(message)

    return send_with_headers
