"""What a page of this server may load and do: a Content-Security-Policy for each kind of page.

Nothing that is not named is allowed. The dashboard runs its own modules alone: no script or style within a page,
no text that becomes script (Trusted Types), nothing from elsewhere. Pages that we do not write need more, each
only at its own address.
"""

from __future__ import annotations

from collections.abc import Mapping

Rules = Mapping[str, str]
"""Sources by directive."""

NOTHING: Rules = {"default-src": "'none'", "base-uri": "'none'", "form-action": "'none'"}

DASHBOARD: Rules = NOTHING | {
    "script-src": "'self'",
    "style-src": "'self'",
    "img-src": "'self'",
    "connect-src": "'self' {sockets}",
    "frame-src": "'self'",
    "frame-ancestors": "'none'",
    "require-trusted-types-for": "'script'",
    "trusted-types": "'none'",
}

SCENE: Rules = NOTHING | {
    "script-src": "'self' 'unsafe-inline' 'unsafe-eval' blob: data:",
    "style-src": "'self' 'unsafe-inline'",
    "img-src": "'self' data: blob:",
    "font-src": "'self' data:",
    "connect-src": "'self' {sockets} data: blob:",
    "worker-src": "'self' blob: data:",
    "frame-ancestors": "'self'",
}
"""Viser's 3D client is one file of inlined modules, WebAssembly and workers; the dashboard shows it in a frame."""

INTERFACE: Rules = NOTHING | {
    "script-src": "'self'",
    "style-src": "'self' 'unsafe-inline'",
    "img-src": "'self' data:",
    "connect-src": "'self'",
    "frame-ancestors": "'none'",
}
"""Swagger's description of the interface writes styles into its elements."""

DOCUMENT: Rules = NOTHING | {
    "style-src": "'unsafe-inline'",
    "img-src": "data:",
    "object-src": "'self'",
    "frame-ancestors": "'none'",
}
"""A report, figure or sheet that is opened by itself carries its own style and pictures and runs nothing. A browser's
own reader of PDF files counts as an object."""

DOCUMENT_ENDINGS = ("/report", ".svg", ".pdf")


def content_policy(path: str, host: str) -> str:
    """The header of a path's answer.

    host: as it was asked for; socket sources are named with it, because not every browser counts them as 'self'.
    """
    rules = _rules(path)
    sockets = f"ws://{host} wss://{host}"
    return "; ".join(f"{name} {sources.format(sockets=sockets)}" for name, sources in rules.items())


def _rules(path: str) -> Rules:
    if path == "/scene" or path.startswith("/scene/"):
        return SCENE
    if path == "/docs":
        return INTERFACE
    return DOCUMENT if path.endswith(DOCUMENT_ENDINGS) and path.startswith("/api/") else DASHBOARD
