"""`pivotrig serve` as a process that others can reach: by its other address, with a token, under TLS."""

import json
import re
import socket
import ssl
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from server.access.attempts import FROM_ONE
from server.access.opening import HANDSHAKE
from server.access.roles import Role
from server.access.tokens import FILE, Tokens
from tests.processes import started

TOKEN = re.compile(r"admin token \(shown this once\): (\S+)")
OTHER_ADDRESS = "127.0.0.2"
"""An address of this machine on which a server that is bound to 127.0.0.1 does not listen."""


def asked(url, token="", context=None, headers=None):
    shown = {"Authorization": f"Bearer {token}"} if token else {}
    request = urllib.request.Request(url, headers=shown | (headers or {}))
    try:
        with urllib.request.urlopen(request, timeout=10, context=context) as answer:
            return answer.status, json.load(answer)
    except urllib.error.HTTPError as refusal:
        with refusal:
            return refusal.code, json.load(refusal)


def first_token(process):
    return next(found[1] for line in process.stderr if (found := TOKEN.search(line)))


def test_an_address_that_others_can_reach_asks_for_the_token_that_was_told_once(tmp_path: Path):
    options = ("serve", "--sim", "--host", "0.0.0.0", "--port", "0", "--data", str(tmp_path))
    with started("server", *options) as (process, line):
        token, port = first_token(process), line.rsplit(":", 1)[1]
        assert line == f"dashboard: http://0.0.0.0:{port}"
        for address in ("127.0.0.1", OTHER_ADDRESS):
            state = f"http://{address}:{port}/api/v1/state"
            assert asked(state)[0] == 401
            assert asked(state, "wrong")[0] == 401
            assert asked(state, token)[0] == 200
    with started("server", *options) as (process, _):
        process.terminate()
        assert process.stderr is not None
        assert "admin token" not in process.stderr.read()
    assert token not in "".join(path.read_text(errors="replace") for path in tmp_path.glob("tokens*"))


def made_certificate(folder: Path):
    certificate, key = folder / "rig.pem", folder / "rig.key"
    command = (
        "openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=rig -addext subjectAltName=IP:127.0.0.1"
    )
    subprocess.run([*command.split(), "-out", certificate, "-keyout", key], check=True, capture_output=True)
    return certificate, key


def test_with_a_certificate_the_rig_speaks_tls(tmp_path: Path):
    certificate, key = made_certificate(tmp_path)
    tls = ("--demand-token", "--tls-cert", str(certificate), "--tls-key", str(key))
    with started("server", "serve", "--sim", "--port", "0", "--data", str(tmp_path), *tls) as (process, line):
        address = line.removeprefix("dashboard: ")
        assert address.startswith("https://127.0.0.1:")
        context = ssl.create_default_context(cafile=certificate)
        assert asked(f"{address}/api/v1/state", context=context)[0] == 401
        assert asked(f"{address}/api/v1/state", first_token(process), context)[0] == 200


def test_a_named_proxy_speaks_for_others_and_everybody_shows_a_token(tmp_path: Path):
    options = (
        "serve",
        "--sim",
        "--port",
        "0",
        "--data",
        str(tmp_path),
        "--proxy",
        "127.0.0.1",
        "--allow-host",
        "rig.lab",
    )
    with started("server", *options) as (process, line):
        token, state = first_token(process), line.removeprefix("dashboard: ") + "/api/v1/state"
        forwarded = {"X-Forwarded-For": "203.0.113.9", "X-Forwarded-Proto": "https", "Host": "rig.lab"}
        assert asked(state, headers=forwarded)[0] == 401
        assert asked(state, token, headers=forwarded)[0] == 200
        assert asked(state, token, headers={"Host": "other.lab"})[0] == 403
        for _ in range(FROM_ONE):
            assert asked(state, "wrong", headers=forwarded)[0] == 401
        assert asked(state, "wrong", headers=forwarded)[0] == 429
        another = {**forwarded, "X-Forwarded-For": "203.0.113.10"}
        assert asked(state, "wrong", headers=another)[0] == 401  # whom the proxy speaks for is who is counted


def test_a_handshake_that_does_not_come_ends(tmp_path: Path):
    certificate, key = made_certificate(tmp_path)
    tls = ("--tls-cert", str(certificate), "--tls-key", str(key))
    with started("server", "serve", "--sim", "--port", "0", "--data", str(tmp_path), *tls) as (_, line):
        port = int(line.rsplit(":", 1)[1])
        with socket.create_connection(("127.0.0.1", port), timeout=3 * HANDSHAKE) as silent:
            assert silent.recv(1) == b""


def token_command(data: Path, *words: str):
    command = [sys.executable, "-m", "server", "token", *words, "--data", str(data)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def test_tokens_are_made_listed_and_revoked_by_a_command(tmp_path: Path):
    made = token_command(tmp_path, "new", "viewer")
    assert made.returncode == 0
    token = made.stdout.strip()
    assert token not in made.stderr
    assert Tokens(tmp_path / FILE).role_of(token) is Role.VIEWER
    token_command(tmp_path, "new")
    assert token_command(tmp_path, "list").stdout.split() == ["viewer", "admin"]
    assert "is revoked" in token_command(tmp_path, "revoke", "viewer").stderr
    assert "There was no viewer token" in token_command(tmp_path, "revoke", "viewer").stderr
    assert Tokens(tmp_path / FILE).role_of(token) is None
    (tmp_path / FILE).write_text("spoilt")
    spoilt = token_command(tmp_path, "list")
    assert spoilt.returncode == 1
    assert "cannot read the tokens" in spoilt.stderr


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--tls-cert", "no.pem"], "--tls-cert and --tls-key come together"),
        (["--tls-cert", "no.pem", "--tls-key", "no.key"], "cannot read no.pem: No such file"),
        (["--allow-origin", "lab.example"], "--allow-origin takes scheme and host"),
    ],
)
def test_options_that_cannot_be_are_refused_in_words(tmp_path: Path, options, complaint):
    command = [
        sys.executable,
        "-m",
        "server",
        "serve",
        "--sim",
        "--port",
        "0",
        "--data",
        str(tmp_path),
        *options,
    ]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert answer.returncode == 1
    assert complaint in answer.stderr
