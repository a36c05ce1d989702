"""Figures for Prometheus."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from server.watching.exposition import CONTENT_TYPE, Exposition

router = APIRouter(tags=["watching"])


@router.get("/metrics", response_class=Response, responses={200: {"content": {"text/plain": {}}}})
async def metrics(request: Request) -> Response:
    """Loop, tracking, link, coils, clients, recorder and process, as Prometheus reads them."""
    exposition: Exposition = request.app.state.exposition
    return Response(exposition.text(), headers={"Content-Type": CONTENT_TYPE})
