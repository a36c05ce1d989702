"""Which role a request needs. One rule for everything, so that a new route is closed until somebody opens it."""

from __future__ import annotations

from server.access.caller import Role

PREFIX = "/api/v1"
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})

OPEN_PLACES = frozenset({f"{PREFIX}/health", f"{PREFIX}/login", "/login"})
"""For everybody, unasked: whether the server lives, and the way in."""
OPEN_FOLDER = "/login/"
"""The files of the login page."""

STOPS = frozenset(
    f"{PREFIX}/{action}"
    for action in ("estop", "disarm", "runs/current/stop", "runs/current/pause", "logout")
)
"""Everybody may stop: these only lessen what happens, or concern the caller alone."""

READS = frozenset(
    f"{PREFIX}/{question}" for question in ("trajectories/preview", "trajectories/points", "studies/preview")
)
"""Questions too long for an address: they change nothing."""

SETTINGS = (f"{PREFIX}/rig", f"{PREFIX}/notifications")
"""What the rig is; whoever changes it may be trusted with its coils, its disk and who is told."""


def is_open(path: str) -> bool:
    return path in OPEN_PLACES or path.startswith(OPEN_FOLDER)


def role_needed(method: str, path: str) -> Role:
    """Of an HTTP request; a WebSocket only shows, and needs a viewer."""
    if method in SAFE_METHODS or path in STOPS or path in READS:
        return Role.VIEWER
    if any(path == place or path.startswith(place + "/") for place in SETTINGS):
        return Role.ADMIN
    return Role.OPERATOR
