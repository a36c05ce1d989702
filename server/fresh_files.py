"""Files that a browser keeps: those of the page for good, under the name of their version; others it asks about."""

from __future__ import annotations

import asyncio
import os
import re
from pathlib import Path
from typing import Any

from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from server.page_imports import NotUnderstood
from server.page_version import STAMP_LENGTH, PageFile, PageVersion, stamp_of, version_of

ALWAYS_ASK = {"Cache-Control": "no-cache"}
KEEP = {"Cache-Control": "public, max-age=31536000, immutable", "Vary": "Accept-Encoding"}
"""The name changes with the content."""

STAMPED = re.compile(rf"([0-9a-f]{{{STAMP_LENGTH}}})/(.+)")
ANOTHER_VERSION = "This page is of another version of pivotrig than the server; reload it."


class FreshFiles(StaticFiles):
    """The folder of the page: `/name` is asked about each time, `/STAMP/name` is kept.

    Of the page there is one version at a time, the one that was last asked for as a whole (`page`).
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(directory=folder)
        self._folder = folder
        self._version: PageVersion | None = None

    async def version(self) -> PageVersion:
        """The version that is in the folder now; the one before it while somebody writes on a module."""
        try:
            return await self._newest()
        except NotUnderstood:
            if self._version is None:
                raise
            return self._version

    async def _newest(self) -> PageVersion:
        stamp = await asyncio.to_thread(stamp_of, self._folder)
        if self._version is None or self._version.stamp != stamp:
            self._version = await asyncio.to_thread(version_of, self._folder, stamp)
        return self._version

    async def page(self, request: Request) -> Response:
        try:
            version = await self._newest()
        except NotUnderstood as error:
            return PlainTextResponse(str(error), 500, {"Cache-Control": "no-store"})
        headers = {**ALWAYS_ASK, "ETag": f'"{version.stamp}"'}
        if request.headers.get("if-none-match") == headers["ETag"]:
            return Response(status_code=304, headers=headers)
        return Response(version.index, media_type="text/html", headers=headers)

    async def get_response(self, path: str, scope: Scope) -> Response:
        if (stamped := STAMPED.fullmatch(path.replace(os.sep, "/"))) is None:
            return await super().get_response(path, scope)
        version = self._version or await self.version()
        file = await asyncio.to_thread(version.file, stamped[2]) if version.stamp == stamped[1] else None
        if file is None:
            return PlainTextResponse(ANOTHER_VERSION, 404, {"Cache-Control": "no-store"})
        return file_response(file, scope)

    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        response = super().file_response(*args, **kwargs)
        response.headers.update(ALWAYS_ASK)
        return response


def file_response(file: PageFile, scope: Scope) -> Response:
    if "gzip" in Headers(scope=scope).get("accept-encoding", ""):
        return Response(
            file.compressed, headers={**KEEP, "Content-Encoding": "gzip"}, media_type=file.media_type
        )
    return Response(file.content, headers=KEEP, media_type=file.media_type)
