"""The whole server as it stands open to a lab: every way in asks for a token, and each role may do its part."""

import asyncio
import contextlib
import re

import httpx
import pytest
from starlette.routing import Mount, WebSocketRoute
from websockets.exceptions import ConnectionClosed, InvalidStatus

from server.access import tokens
from server.access.attempts import FROM_ONE
from server.access.caller import Role
from server.access.guard import COOKIE, Guard
from server.access.opening import Opening
from server.access.tokens import Tokens
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.settings import RigFile

pytestmark = pytest.mark.anyio

OTHER_SITE = "https://lab.example"
OPEN = {
    "/login",
    "/login/login.js",
    "/login/login.css",
    "/login/tokens.css",
    "/login/icon.svg",
    "/api/v1/login",
    "/api/v1/health",
}
SOCKETS = {
    "/api/v1/telemetry",
    "/api/v1/camera",
    "/api/v1/replay",
    "/scene",
}
"""Some that must be among those found, so that a changed framework cannot make the list empty."""

HOSTILE_HOSTS = [
    "evil.example",
    "127.0.0.1.evil.example",
    "localhost.evil.example",
    "127.0.0.2",
    "",
    "0x7f.1",
]
HOSTILE_ORIGINS = [
    "http://evil.example",
    "null",
    "https://127.0.0.1:1",
    "http://localhost:1",
    "file://",
    "http://lab.example",
]


@pytest.fixture(scope="module")
async def lab(serve, tmp_path_factory):
    """tokens: of each role.  file: where they are kept."""
    folder = tmp_path_factory.mktemp("data")
    file = folder / tokens.FILE
    made = {role: tokens.make(file, role) for role in Role}
    archive = Archive.open(folder)
    rig = Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder)
    app = create_app(rig, archive, guard=Guard(Tokens(file)), opening=Opening(origins=(OTHER_SITE,)))
    async with serve(app) as at:
        at.app, at.tokens, at.file = app, made, file
        yield at


@pytest.fixture
async def stranger(lab):
    async with httpx.AsyncClient(base_url=lab.url, timeout=20.0) as client:
        yield client


def bearer(lab, role):
    return {"Authorization": f"Bearer {lab.tokens[role]}"}


@contextlib.asynccontextmanager
async def coming_as(lab, role):
    async with httpx.AsyncClient(base_url=lab.url, timeout=20.0, headers=bearer(lab, role)) as client:
        yield client


def leaves(app):
    """Everything that can be asked for: (path, methods), a WebSocket's methods being None."""
    for route in app.routes:
        contexts = getattr(route, "effective_route_contexts", None)
        for each in contexts() if contexts else [route]:
            original = getattr(each, "original_route", None) or each
            if isinstance(original, WebSocketRoute):
                yield filled((getattr(each, "starlette_route", None) or each).path), None
            elif isinstance(each, Mount):
                yield each.path + "/main.js", {"GET"}
            else:
                yield filled(each.path), each.methods or {"GET"}


def filled(path):
    return re.sub(r"\{[^}]*\}", "x", path)


def requests_of(app):
    return [(method, path) for path, methods in leaves(app) if methods for method in sorted(methods)]


def sockets_of(app):
    return [path for path, methods in leaves(app) if methods is None]


async def test_every_request_without_a_token_is_turned_away(lab, stranger):
    asked = requests_of(lab.app)
    documented = {
        (method.upper(), filled(path)) for path, one in lab.app.openapi()["paths"].items() for method in one
    }
    assert len(documented) > 80
    assert documented <= set(asked)
    assert {"/static/main.js", "/docs", "/openapi.json", "/", "/scene/"} <= {path for _, path in asked}
    for method, path in [
        *asked,
        ("GET", "/nowhere"),
        ("POST", "/nowhere"),
        ("OPTIONS", "/api/v1/arm"),
        ("TRACE", "/"),
    ]:
        answer = await stranger.request(method, path)
        if path in OPEN:
            assert answer.status_code != 401, (method, path)
        else:
            assert answer.status_code == 401, (method, path)
            assert answer.headers["www-authenticate"].startswith("Bearer")
            assert method == "HEAD" or answer.json()["status"] == 401


async def test_every_socket_without_a_token_is_closed_with_1008(lab):
    found = sockets_of(lab.app)
    assert set(found) >= SOCKETS
    for path in found:
        async with lab.socket(path) as socket:
            with pytest.raises(ConnectionClosed):
                await socket.recv()
            assert socket.close_code == 1008, path


async def test_no_way_of_showing_a_token_in_an_address_works(lab, stranger):
    token = lab.tokens[Role.ADMIN]
    for query in (f"token={token}", f"access_token={token}", f"bearer={token}"):
        assert (await stranger.get(f"/api/v1/state?{query}")).status_code == 401
    for value in (token, f"Basic {token}", f"Bearer{token}", "Bearer", f"Bearer {token} {token}"):
        answer = await stranger.get("/api/v1/state", headers={"Authorization": value})
        assert answer.status_code in (401, 429), value
    two = [("Authorization", "Bearer x"), ("Authorization", f"Bearer {token}")]
    assert (await stranger.get("/api/v1/state", headers=two)).status_code in (401, 429)


async def test_a_viewer_sees_everything_may_stop_and_changes_nothing(lab):
    async with coming_as(lab, Role.VIEWER) as viewer:
        for path in (
            "/",
            "/static/main.js",
            "/docs",
            "/openapi.json",
            "/scene/",
            "/api/v1/state",
            "/api/v1/rig",
        ):
            assert (await viewer.get(path)).status_code == 200, path
        assert (await viewer.post("/api/v1/trajectories/preview", json={"name": "eight"})).status_code == 200
        for path in ("estop", "reset", "disarm", "arm", "runs", "manual"):
            answer = await viewer.post(f"/api/v1/{path}")
            assert (answer.status_code == 403) == (path in ("reset", "arm", "runs", "manual")), path
        answer = await viewer.patch("/api/v1/rig", json={})
        assert answer.status_code == 403
        assert "admin" in answer.json()["detail"]
    async with coming_as(lab, Role.OPERATOR) as operator:
        assert (await operator.post("/api/v1/reset")).status_code == 200
        assert (await operator.patch("/api/v1/rig", json={})).status_code == 403
    async with coming_as(lab, Role.ADMIN) as admin:
        answer = await admin.patch("/api/v1/rig", json={"name": "Open rig"})
        assert answer.status_code == 409  # this rig has no file, which is said only to who may change it


async def test_a_browser_logs_in_and_out(lab, stranger):
    asked = await stranger.get("/", headers={"Accept": "text/html,*/*"})
    assert (asked.status_code, asked.headers["location"]) == (303, "/login?next=/")
    assert (await stranger.get("/login")).status_code == 200
    answer = await stranger.post("/api/v1/login", json={"token": lab.tokens[Role.OPERATOR]})
    assert answer.json() == {"role": "operator"}
    cookie = answer.headers["set-cookie"]
    assert {"HttpOnly", "SameSite=strict", "Path=/"} <= {part.strip() for part in cookie.split(";")}
    assert lab.tokens[Role.OPERATOR] not in cookie
    assert (await stranger.get("/api/v1/state")).status_code == 200
    assert (await stranger.post("/api/v1/logout")).status_code == 204
    stranger.cookies.set(COOKIE, cookie.split("=")[1].split(";")[0])
    assert (await stranger.get("/api/v1/state")).status_code == 401


@pytest.mark.parametrize(
    "body", [{}, {"token": ""}, {"token": 5}, {"token": "x" * 201}, {"token": "x", "more": 1}, []]
)
async def test_a_login_that_is_none_is_refused_and_repeats_no_token(stranger, body):
    answer = await stranger.post("/api/v1/login", json=body)
    assert answer.status_code == 422
    assert "xx" not in answer.text


async def test_what_nobody_is_asked_for_may_only_be_short(stranger):
    body = b'{"token": "' + b"x" * 5000 + b'"}'
    answer = await stranger.post("/api/v1/login", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == 413


async def test_who_guesses_is_asked_to_wait_and_who_knows_is_not(serve, tmp_path):
    file = tmp_path / tokens.FILE
    right = tokens.make(file, Role.VIEWER)
    archive = Archive.open(tmp_path)
    rig = Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder)
    async with (
        serve(create_app(rig, archive, guard=Guard(Tokens(file)))) as at,
        httpx.AsyncClient(base_url=at.url + "/api/v1") as client,
    ):
        for number in range(FROM_ONE):
            wrong = {"Authorization": f"Bearer {number}"}
            if number % 2:
                assert (await client.get("/state", headers=wrong)).status_code == 401
            else:
                assert (await client.post("/login", json={"token": str(number)})).status_code == 401
        for answer in (
            await client.get("/state", headers={"Authorization": "Bearer x"}),
            await client.post("/login", json={"token": right}),
        ):
            assert answer.status_code == 429
            assert 0 < int(answer.headers["retry-after"]) <= 61
        assert (await client.get("/state", headers={"Authorization": f"Bearer {right}"})).status_code == 200


async def test_a_replaced_token_ends_its_sessions_sockets_and_streams(lab):
    viewer = bearer(lab, Role.VIEWER)
    async with (
        coming_as(lab, Role.VIEWER) as client,
        httpx.AsyncClient(base_url=lab.url) as page,
        lab.socket("/api/v1/telemetry", additional_headers=viewer) as socket,
        client.stream("GET", "/api/v1/camera/stream.mjpg") as pictures,
    ):
        await page.post("/api/v1/login", json={"token": lab.tokens[Role.VIEWER]})
        assert (await page.get("/api/v1/state")).status_code == 200
        await socket.recv()
        lab.tokens[Role.VIEWER] = tokens.make(lab.file, Role.VIEWER)
        assert (await page.get("/api/v1/state")).status_code == 401
        async with asyncio.timeout(10.0):
            with contextlib.suppress(ConnectionClosed):
                async for _ in socket:
                    pass  # what was on its way
            assert socket.close_code == 1008
            async for _ in pictures.aiter_bytes():
                pass


async def test_hostile_names_and_origins_are_refused_with_a_token_too(lab):
    token = bearer(lab, Role.ADMIN)
    async with coming_as(lab, Role.ADMIN) as admin:
        for host in HOSTILE_HOSTS:
            assert (await admin.get("/api/v1/state", headers={"Host": host})).status_code == 403, host
        for origin in HOSTILE_ORIGINS:
            for method, path in (
                ("GET", "/api/v1/state"),
                ("POST", "/api/v1/arm"),
                ("GET", "/static/main.js"),
                ("GET", "/scene/"),
            ):
                assert (await admin.request(method, path, headers={"Origin": origin})).status_code == 403, (
                    origin
                )
    for path in sorted(SOCKETS):
        for origin in HOSTILE_ORIGINS:
            with pytest.raises(InvalidStatus) as refused:
                await lab.socket(path, origin=origin, additional_headers=token)
            assert refused.value.response.status_code == 403


async def test_another_site_may_use_the_rig_where_it_is_named(lab, stranger):
    question = {"Origin": OTHER_SITE, "Access-Control-Request-Method": "POST"}
    answer = await stranger.options("/api/v1/estop", headers=question)
    assert answer.status_code == 204
    assert answer.headers["access-control-allow-origin"] == OTHER_SITE
    assert "Authorization" in answer.headers["access-control-allow-headers"]
    there = {"Origin": OTHER_SITE, "Sec-Fetch-Site": "cross-site"}
    assert (await stranger.post("/api/v1/estop", headers=there)).status_code == 401
    async with coming_as(lab, Role.OPERATOR) as operator:
        answer = await operator.post("/api/v1/estop", headers=there)
        assert (answer.status_code, answer.headers["access-control-allow-origin"]) == (200, OTHER_SITE)
        assert "access-control-allow-credentials" not in answer.headers
        answer = await operator.get("/api/v1/state")
        assert "access-control-allow-origin" not in answer.headers
        await operator.post("/api/v1/reset")


@pytest.mark.parametrize("header", ["X-Forwarded-For", "X-Forwarded-Host", "Forwarded", "X-Real-IP"])
async def test_a_proxy_that_nobody_named_does_not_open_a_rig_without_tokens(api, header):
    answer = await api.get("/state", headers={header: "203.0.113.9"})
    assert answer.status_code == 403
    assert "--proxy" in answer.json()["detail"]
