"""The tokens of a rig, one a role: only their digests are kept, in a file that its owner alone may read."""

from __future__ import annotations

import hashlib
import hmac
import json
import re
import secrets
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from server.access.roles import Role
from server.atomic_save import replace_file

FILE = "tokens.json"
"""In the data folder."""
BYTES = 32
"""Of randomness in a token; none can be found by trying."""
OWNER_ONLY = 0o600
LONGEST = 200
"""Characters of what may be a token at all; ours have 43."""

DIGEST = re.compile("[0-9a-f]{64}")
"""SHA-256, as it is kept."""

Digests = Mapping[Role, str]


class TokenFileError(Exception):
    """The file cannot be read or written; the text says why and what to do."""


def digest_of(token: str) -> str:
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).hexdigest()


def load(path: Path) -> dict[Role, str]:
    """Digests by role; raises `TokenFileError`. A file that is not there holds none."""
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise TokenFileError(
            f"cannot read the tokens in {path}: {error}; remove it and make new ones with: pivotrig token new"
        ) from error
    if not isinstance(kept, dict) or not all(_is_entry(name, digest) for name, digest in kept.items()):
        raise TokenFileError(f"{path} does not hold tokens of pivotrig; remove it and make new ones")
    return {Role[name.upper()]: digest for name, digest in kept.items()}


def _is_entry(name: str, digest: Any) -> bool:
    return (
        name.upper() in Role.__members__ and isinstance(digest, str) and DIGEST.fullmatch(digest) is not None
    )


def save(path: Path, digests: Digests) -> None:
    """Raises `TokenFileError`."""
    text = (
        json.dumps({role.name.lower(): digest for role, digest in sorted(digests.items())}, indent=2) + "\n"
    )
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, text, OWNER_ONLY)
    except OSError as error:
        raise TokenFileError(f"cannot write the tokens to {path}: {error.strerror}") from error


def make(path: Path, role: Role) -> str:
    """A new token of the role in place of the one it had; this is the only time that it is known."""
    token = secrets.token_urlsafe(BYTES)
    save(path, {**load(path), role: digest_of(token)})
    return token


def revoke(path: Path, role: Role) -> bool:
    """Whether there was one."""
    digests = load(path)
    if role not in digests:
        return False
    del digests[role]
    save(path, digests)
    return True


class Tokens:
    """The file as a running server sees it: looked at again whenever it has changed.

    A file that cannot be read lets nobody in.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._stamp: tuple[int, ...] | None = None
        self._digests: dict[Role, str] = {}

    def role_of(self, token: str) -> Role | None:
        """The role that it opens. Each digest is compared, in a time that tells nothing."""
        if len(token) > LONGEST:
            return None
        asked, found = digest_of(token), None
        for role, digest in self.digests.items():
            if hmac.compare_digest(digest, asked):
                found = role
        return found

    @property
    def digests(self) -> dict[Role, str]:
        stamp = self._read_stamp()
        if stamp != self._stamp or stamp is None:
            self._stamp = stamp
            self._digests = self._read()
        return self._digests

    def _read(self) -> dict[Role, str]:
        try:
            return load(self._path)
        except TokenFileError:
            return {}

    def _read_stamp(self) -> tuple[int, ...] | None:
        try:
            found = self._path.stat()
        except OSError:
            return None
        return found.st_mtime_ns, found.st_ctime_ns, found.st_size, found.st_ino
