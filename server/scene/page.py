"""Viser's page, with its own panel and notices hidden: the dashboard around it says what there is to say."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

import viser
from starlette.requests import Request
from starlette.responses import Response

from server.fresh_files import ALWAYS_ASK

PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"

HIDDEN = (
    "[data-floating-window]",
    "div:has(> div > [data-dock-root]) ~ .mantine-Paper-root",
    "#webgl-software-rendering",
)
"""The panel, the same on narrow screens, and a notice that covers half of a small picture."""

STYLE = f"<style>{', '.join(HIDDEN)} {{ display: none !important }}</style>"


@cache
def page() -> tuple[bytes, str]:
    """The page and its entity tag."""
    head, end, rest = PAGE.read_text(encoding="utf-8").partition("</head>")
    content = (head + STYLE + end + rest).encode()
    return content, f'"{hashlib.sha256(content).hexdigest()[:16]}"'


async def scene_page(request: Request) -> Response:
    content, tag = page()
    headers = {**ALWAYS_ASK, "ETag": tag}
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers=headers)
    return Response(content, media_type="text/html", headers=headers)
