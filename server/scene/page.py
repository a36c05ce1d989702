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

GROUND = """
:root, body { background: #f5f7f9 !important; color-scheme: light dark !important }
@media (prefers-color-scheme: dark) { :root, body { background: #1f262d !important } }
#root div:has(canvas) { background-color: transparent !important }
"""
"""The page's own ground behind the scene, light or dark as the system's choice is, which may change meanwhile."""

STYLE = f"<style>{', '.join(HIDDEN)} {{ display: none !important }}{GROUND}</style>"


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
