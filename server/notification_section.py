"""The rig file's [notifications]: who outside the lab's network is told of a fault or of the end of a study."""

from __future__ import annotations

from typing import Annotated, Literal
from urllib.parse import urlsplit

from pydantic import AfterValidator, Field

from server.section import Section
from vision.sources.addresses import SECRET

Occasion = Literal["fault", "study", "run"]
"""run: the end of a run that nobody watches; one of a campaign belongs to its study."""


def _allowed(url: str) -> str:
    """Raises ValueError with what is allowed."""
    if not url:
        return url
    if SECRET in url:
        raise ValueError(f"has a hidden part ({SECRET}); write the whole address")
    if not (url.isascii() and url.isprintable()) or " " in url:
        raise ValueError("may have printable ASCII characters and no spaces; write others as %XX")
    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not parts.hostname:
        raise ValueError("must be an address that begins with http:// or https:// and names a host")
    if parts.username is not None or parts.fragment:
        raise ValueError("may have no login and nothing behind a #; a key belongs into its path or its query")
    try:
        _ = parts.port
    except ValueError as error:
        raise ValueError("must have a port from 1 to 65535, if any") from error
    return url


class NotificationsSection(Section):
    """Off as long as no address is given: then nothing leaves the lab's network."""

    webhook_url: Annotated[str, Field(max_length=2000), AfterValidator(_allowed)] = ""
    """Told by an HTTP POST with a JSON body. Empty: nobody is told. The address may hold a key and is never shown
    whole again."""
    on: Annotated[tuple[Occasion, ...], Field(max_length=3)] = ("fault", "study")
    """What is told. A run is unattended when it was started so."""
    timeout_s: Annotated[float, Field(ge=0.5, le=30.0)] = 5.0
    """The other side must have answered within this time, or it is tried again later."""


def shown_webhook(url: str) -> str:
    """The address as it may be told: its host, without what may be a key."""
    if not url:
        return ""
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}/{SECRET}"
