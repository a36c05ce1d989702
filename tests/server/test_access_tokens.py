"""The file of tokens, what a session is, and how often somebody may be wrong."""

import json
import stat

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.access import tokens
from server.access.addresses import site_of
from server.access.attempts import FROM_ALL, FROM_ONE, SITES, WINDOW, Attempts
from server.access.caller import Role
from server.access.policy import is_open, role_needed
from server.access.sessions import IDLE, SESSIONS, Sessions
from server.access.tokens import TokenFileError, Tokens, digest_of


class Clock:
    def __init__(self):
        self.now = 1000.0

    def __call__(self):
        return self.now


def test_a_token_opens_its_role_and_nothing_else_does(tmp_path):
    path = tmp_path / tokens.FILE
    made = {role: tokens.make(path, role) for role in Role}
    known = Tokens(path)
    assert {role: known.role_of(token) for role, token in made.items()} == {role: role for role in Role}
    for wrong in (
        "",
        "x",
        made[Role.ADMIN][:-1],
        made[Role.ADMIN] + "a",
        made[Role.ADMIN].swapcase(),
        "\ud800",
        "a" * 10**6,
    ):
        assert known.role_of(wrong) is None


def test_the_file_is_its_owners_alone_and_holds_no_token(tmp_path):
    path = tmp_path / tokens.FILE
    path.write_text("{}")
    path.chmod(0o644)
    made = tokens.make(path, Role.VIEWER)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert made not in path.read_text()
    assert json.loads(path.read_text()) == {"viewer": digest_of(made)}
    assert [each.name for each in tmp_path.iterdir()] == [tokens.FILE]


def test_a_running_server_hears_of_new_and_of_revoked_tokens(tmp_path):
    path = tmp_path / tokens.FILE
    known = Tokens(path)
    assert known.role_of("anything") is None
    first = tokens.make(path, Role.OPERATOR)
    assert known.role_of(first) is Role.OPERATOR
    second = tokens.make(path, Role.OPERATOR)
    assert (known.role_of(first), known.role_of(second)) == (None, Role.OPERATOR)
    assert tokens.revoke(path, Role.OPERATOR)
    assert not tokens.revoke(path, Role.OPERATOR)
    assert known.role_of(second) is None


@pytest.mark.parametrize(
    "text", ["", "[]", "{", '{"king": "a"}', '{"admin": 5}', '{"admin": "short"}', "\x00"]
)
def test_a_spoilt_file_lets_nobody_in_and_says_so(tmp_path, text):
    path = tmp_path / tokens.FILE
    token = tokens.make(path, Role.ADMIN)
    path.write_text(text)
    assert Tokens(path).role_of(token) is None
    with pytest.raises(TokenFileError, match=str(path)):
        tokens.load(path)


def test_a_file_that_is_gone_lets_nobody_in(tmp_path):
    path = tmp_path / tokens.FILE
    known, token = Tokens(path), tokens.make(path, Role.ADMIN)
    assert known.role_of(token) is Role.ADMIN
    path.unlink()
    assert known.role_of(token) is None


def role_of(sessions, cookie):
    session = sessions.find(cookie)
    return session and session.role


def test_a_session_ends_when_it_is_closed_or_not_used():
    clock = Clock()
    sessions = Sessions(clock)
    one, two = sessions.open(Role.VIEWER, "digest"), sessions.open(Role.ADMIN, "other")
    assert one != two
    assert role_of(sessions, one) is Role.VIEWER
    sessions.close(one)
    assert sessions.find(one) is None
    clock.now += IDLE
    assert role_of(sessions, two) is Role.ADMIN
    clock.now += IDLE
    assert sessions.find(two) is not None
    clock.now += IDLE + 1.0
    assert sessions.find(two) is None
    assert len(sessions) == 0


def test_sessions_do_not_grow_without_end():
    sessions = Sessions(Clock())
    first = sessions.open(Role.ADMIN, "digest")
    for _ in range(SESSIONS - 1):
        sessions.open(Role.VIEWER, "digest")
    assert sessions.find(first) is not None  # and has so been used later than all others
    last = [sessions.open(Role.VIEWER, "digest") for _ in range(SESSIONS - 1)]
    assert len(sessions) == SESSIONS
    assert sessions.find(first) is not None
    assert all(sessions.find(cookie) is not None for cookie in last)


def test_wrong_tokens_are_heard_ten_times_a_minute():
    clock = Clock()
    attempts = Attempts(clock)
    for _ in range(FROM_ONE):
        assert attempts.wait("1.2.3.4") == 0.0
        attempts.fail("1.2.3.4")
    assert attempts.wait("1.2.3.4") == WINDOW
    assert attempts.wait("1.2.3.5") == 0.0
    clock.now += WINDOW
    assert attempts.wait("1.2.3.4") == 0.0


def test_many_sites_together_are_slowed_down_and_remembered_within_bounds():
    clock = Clock()
    attempts = Attempts(clock)
    for number in range(FROM_ALL):
        attempts.fail(f"site {number}")
    assert attempts.wait("another") == WINDOW
    for number in range(3 * SITES):
        attempts.fail(f"site {number}")
    assert len(attempts._sites) == SITES


def test_a_network_of_ipv6_is_one_site():
    assert site_of("2001:db8::1") == site_of("2001:db8::ffff:1") != site_of("2001:db8:0:1::1")
    assert site_of("::ffff:10.0.0.1") == site_of("10.0.0.1") != site_of("10.0.0.2")
    assert site_of("fe80::1%eth0") == site_of("fe80::2")
    assert site_of("") == ""


@given(st.sampled_from(["GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "BREW"]), st.text(max_size=30))
def test_no_route_that_changes_something_is_a_viewers_unless_it_is_named(method, path):
    if not path.startswith("/api/v1/"):
        assert role_needed(method, path) == (Role.VIEWER if method in ("GET", "HEAD") else Role.OPERATOR)


@pytest.mark.parametrize(
    ("method", "path", "role"),
    [
        ("GET", "/api/v1/state", Role.VIEWER),
        ("POST", "/api/v1/estop", Role.VIEWER),
        ("POST", "/api/v1/runs/current/stop", Role.VIEWER),
        ("POST", "/api/v1/trajectories/preview", Role.VIEWER),
        ("POST", "/api/v1/arm", Role.OPERATOR),
        ("POST", "/api/v1/runs/current/stop/", Role.OPERATOR),
        ("PUT", "/api/v1/selection", Role.OPERATOR),
        ("DELETE", "/api/v1/runs/x", Role.OPERATOR),
        ("PATCH", "/api/v1/rig", Role.ADMIN),
        ("POST", "/api/v1/rig/import", Role.ADMIN),
        ("POST", "/api/v1/notifications/test", Role.ADMIN),
    ],
)
def test_each_role_may_do_its_part(method, path, role):
    assert role_needed(method, path) is role


def test_only_health_and_the_way_in_are_open():
    assert [
        each for each in ("/api/v1/health", "/api/v1/login", "/login", "/login/login.js") if not is_open(each)
    ] == []
    for closed in (
        "/",
        "/static/main.js",
        "/api/v1/health/",
        "/api/v1/healthy",
        "/loginx",
        "/api/v1/logout",
        "/scene",
        "/docs",
    ):
        assert not is_open(closed)
