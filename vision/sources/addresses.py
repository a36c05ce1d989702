"""Camera URIs taken apart, and how they may be shown: without what must stay secret."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import SplitResult, parse_qsl, unquote, urlencode, urlsplit, urlunsplit

from vision.sources.request import ALLOWED, CameraError

SECRET = "***"
SECRET_KEYS = frozenset(
    {"password", "passwd", "pass", "pwd", "psw", "user", "usr", "username", "login", "token", "auth", "key"}
)
"""Fields that network cameras take a login from: of the query, and some of the path."""
_LOGIN_IN_PATH = re.compile(rf"(?<![a-z])({'|'.join(sorted(SECRET_KEYS))})=[^&;/]*", re.IGNORECASE)
NETWORK = frozenset({"rtsp", "rtsps", "http", "https"})

FASTEST_FOLDER = 1000.0
"""Pictures/s that a folder may be played at."""


@dataclass(frozen=True, slots=True)
class Playback:
    """How a recording is played. rate: frames/s, None as recorded.  fast: as fast as it is read.  loop: for ever."""

    path: Path
    rate: float | None
    fast: bool
    loop: bool


def split(uri: str) -> SplitResult:
    """The URI's parts; "#" belongs to the name of a file. Raises `CameraError`."""
    try:
        return urlsplit(uri, allow_fragments=False)
    except ValueError as error:
        raise CameraError(
            f"camera {shown(uri)!r} is not understood ({error}); allowed are {ALLOWED}"
        ) from error


def shown(uri: str) -> str:
    """The URI as it may be told: neither user nor password of a network camera.

    Examples: ``rtsp://me:pw@host/1`` -> ``rtsp://***@host/1``; ``http://host/v?pwd=x`` -> ``http://host/v?pwd=***``;
    ``rtsp://host/user=me&password=x&channel=1`` -> ``rtsp://host/user=***&password=***&channel=1``.
    """
    scheme, _, rest = uri.partition("://")
    if scheme.lower() not in NETWORK:
        return uri
    target, mark, query = rest.partition("?")
    if "/" not in target and "@" in query:  # a password with a question mark in it, which nobody has encoded
        target, mark, query = rest, "", ""
    login, at, address = target.rpartition("@")  # the last one: a password may have a slash in it
    fields = "&".join(map(_without_value, query.split("&")))
    return f"{scheme}://{SECRET if login else ''}{at}{_without_login(address)}{mark}{fields}"


def _without_login(path: str) -> str:
    """What follows a login up to the next separator goes with it: a password may have an underscore in it."""
    return _LOGIN_IN_PATH.sub(rf"\1={SECRET}", path)


def _without_value(field: str) -> str:
    name, equals, _ = field.partition("=")
    return f"{name}={SECRET}" if equals and unquote(name).lower() in SECRET_KEYS else field


def public(uri: str) -> str:
    """What tells this network camera from others: its address without any login."""
    scheme, netloc, path, query, _ = urlsplit(uri, allow_fragments=False)
    kept = [(name, value) for name, value in parse_qsl(query) if name.lower() not in SECRET_KEYS]
    return urlunsplit((scheme, netloc.rpartition("@")[2], _without_login(path), urlencode(kept), ""))


def device_of(uri: str) -> Path:
    """The device file behind v4l://0 or v4l:///dev/…; raises `CameraError`."""
    parts = split(uri)
    number, path = parts.netloc, unquote(parts.path)
    if number.isascii() and number.isdecimal() and not path:
        return Path(f"/dev/video{int(number)}")
    if not number and path.startswith("/dev/"):
        return Path(path)
    raise CameraError(f"camera {uri!r} names neither a number nor a path; allowed are {ALLOWED}")


def playback_of(uri: str) -> Playback:
    """What file:… or folder:… asks for; a path without a leading slash is relative. Raises `CameraError`."""
    parts = split(uri)
    host = "" if parts.netloc == "localhost" else parts.netloc
    path = unquote(host + parts.path)
    if not path:
        raise CameraError(f"camera {uri!r} names no path; allowed are {ALLOWED}")
    options = _options(
        uri, parts.query, {"pace", "loop", "rate"} if parts.scheme == "folder" else {"pace", "loop"}
    )
    return Playback(
        path=Path(path),
        rate=_rate(uri, options["rate"]) if "rate" in options else None,
        fast=_chosen(uri, "pace", options.get("pace", "own"), {"own": False, "fast": True}),
        loop=_chosen(uri, "loop", options.get("loop", "0"), {"0": False, "1": True}),
    )


def _options(uri: str, query: str, allowed: set[str]) -> dict[str, str]:
    options = dict(parse_qsl(query, keep_blank_values=True))
    unknown = sorted(options.keys() - allowed)
    if unknown:
        raise CameraError(
            f"camera {uri!r} has the option {unknown[0]!r}; allowed are {', '.join(sorted(allowed))} "
            "(a question mark in a file's name is written %3F)"
        )
    return options


def _chosen(uri: str, name: str, value: str, choices: dict[str, bool]) -> bool:
    if value not in choices:
        allowed = " or ".join(f"{name}={choice}" for choice in choices)
        raise CameraError(f"camera {uri!r} says {name}={value}; allowed is {allowed}")
    return choices[value]


def _rate(uri: str, text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0.0 < rate <= FASTEST_FOLDER:
        raise CameraError(
            f"camera {uri!r} says rate={text}; allowed are pictures/s above 0, up to {FASTEST_FOLDER:g}"
        )
    return rate
