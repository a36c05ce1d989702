"""How a server is opened to others: under which names, by which proxies, with which certificate and tokens."""

from __future__ import annotations

import ssl
import sys
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

from server.access import tokens
from server.access.addresses import is_loopback
from server.access.guard import Guard
from server.access.roles import Role

HANDSHAKE = 5.0
"""Time for a TLS handshake, s; whoever takes longer takes a place that others need."""


class OpeningError(Exception):
    """The server cannot be opened like this; the text says why and what to do."""


@dataclass(frozen=True, slots=True)
class Opening:
    """hosts: further names it is asked by.  origins: other sites whose pages may use it.
    proxies: addresses of what may speak for others.  certificate, key: PEM files for TLS, both or neither.
    """

    hosts: tuple[str, ...] = ()
    origins: tuple[str, ...] = ()
    proxies: tuple[str, ...] = ()
    certificate: Path | None = None
    key: Path | None = None
    demand_token: bool = False

    def check(self) -> None:
        """Raises `OpeningError`."""
        if (self.certificate is None) != (self.key is None):
            raise OpeningError("--tls-cert and --tls-key come together: give both, or neither")
        for origin in self.origins:
            if not is_origin(origin):
                raise OpeningError(
                    f"--allow-origin takes scheme and host, such as https://lab.example, not {origin}"
                )
        if self.certificate is not None and self.key is not None:
            check_certificate(self.certificate, self.key)

    @property
    def is_secure(self) -> bool:
        return self.certificate is not None


def is_origin(text: str) -> bool:
    parts = urlsplit(text)
    return (
        parts.scheme in ("http", "https")
        and parts.netloc != ""
        and f"{parts.scheme}://{parts.netloc}" == text
    )


def check_certificate(certificate: Path, key: Path) -> None:
    """Raises `OpeningError` for files that cannot serve."""
    for path in (certificate, key):
        try:
            path.read_bytes()
        except OSError as error:
            raise OpeningError(f"cannot read {path}: {error.strerror}") from error
    try:
        ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(certificate, key)
    except (ssl.SSLError, ValueError) as error:
        raise OpeningError(
            f"{certificate} and {key} are not a certificate and its key, in PEM and without a password: {error}"
        ) from error


def guard_for(host: str, opening: Opening, data: Path) -> Guard:
    """The guard of a server that listens on `host`; raises `OpeningError`.

    Away from loopback, and behind a proxy, tokens are demanded. The first start makes the admin's and tells it once,
    on stderr.
    """
    if is_loopback(host) and not opening.demand_token and not opening.proxies:
        return Guard()
    path = data / tokens.FILE
    try:
        if Role.ADMIN not in tokens.load(path):
            tell_first_token(tokens.make(path, Role.ADMIN))
    except tokens.TokenFileError as error:
        raise OpeningError(str(error)) from error
    return Guard(tokens.Tokens(path))


def tell_first_token(token: str) -> None:
    print(
        f"admin token (shown this once): {token}\n"
        "Log in with it, or make others with: pivotrig token new viewer | operator | admin",
        file=sys.stderr,
        flush=True,
    )
