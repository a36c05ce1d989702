"""The page that asks for a token: its own few files, which need none."""

from __future__ import annotations

from pathlib import Path

from fastapi import FastAPI
from starlette.requests import Request
from starlette.responses import FileResponse, RedirectResponse, Response

from server.access.guard import Guard
from server.fresh_files import ALWAYS_ASK


def add_login_page(app: FastAPI, web: Path) -> None:
    """web: the folder of the dashboard's files."""
    files = {
        "/login/login.js": web / "login" / "login.js",
        "/login/login.css": web / "login" / "login.css",
        "/login/tokens.css": web / "styles" / "tokens.css",
        "/login/icon.svg": web / "icon.svg",
    }

    async def page(request: Request) -> Response:
        guard: Guard = request.app.state.guard
        if not guard.demands_token:
            return RedirectResponse("/", 303)
        return FileResponse(web / "login" / "index.html", headers=ALWAYS_ASK)

    async def file(request: Request) -> Response:
        return FileResponse(files[request.url.path], headers=ALWAYS_ASK)

    app.add_api_route("/login", page, include_in_schema=False)
    for place in files:
        app.add_api_route(place, file, include_in_schema=False)
