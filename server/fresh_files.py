"""Files that a browser keeps but asks about each time, so that an upgraded page is never a stale one."""

from __future__ import annotations

from typing import Any

from starlette.responses import Response
from starlette.staticfiles import StaticFiles

ALWAYS_ASK = {"Cache-Control": "no-cache"}


class FreshFiles(StaticFiles):
    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        response = super().file_response(*args, **kwargs)
        response.headers.update(ALWAYS_ASK)
        return response
