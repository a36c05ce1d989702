import asyncio

import httpx
import pytest
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from websockets.exceptions import ConnectionClosed, InvalidStatus

from server.door import Door, Limits

pytestmark = pytest.mark.anyio

OWN = "http://127.0.0.1:8000"
SMALL = Limits(body=1000, message=100, body_timeout=0.05)


async def echo(request):
    return PlainTextResponse(await request.body())


async def broken(_):
    raise RuntimeError("a secret of the program")


async def socket_echo(socket):
    await socket.accept()
    while True:
        await socket.send_text(await socket.receive_text())


def behind_door(**options):
    routes = [
        Route("/echo", echo, methods=["GET", "POST", "PUT", "PATCH", "DELETE"]),
        Route("/broken", broken),
        WebSocketRoute("/socket", socket_echo),
    ]
    return Starlette(routes=routes, middleware=[Middleware(Door, limits=SMALL, **options)])


async def request(method="GET", url=f"{OWN}/echo", door=None, **kwargs):
    transport = httpx.ASGITransport(door or behind_door(), client=("127.0.0.1", 5000))
    async with httpx.AsyncClient(transport=transport) as client:
        return await client.request(method, url, **kwargs)


def is_problem(response, status):
    document = response.json()
    assert response.headers["content-type"] == "application/problem+json"
    assert response.status_code == document["status"] == status
    return bool(document["title"] and document["detail"] and document["type"])


@pytest.mark.parametrize(
    "host", ["localhost", "127.0.0.1", "[::1]", "localhost:8000", "127.0.0.1:9", "[::1]:80", "LocalHost:8000"]
)
async def test_loopback_names_are_let_in_on_any_port(host):
    assert (await request(headers={"Host": host})).status_code == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "127.0.0.1.evil.example",
        "localhost.evil.example:8000",
        "127.0.0.2",
        "evil.example:127.0.0.1",
        "localhost:8000:evil",
        "",
        " localhost",
        "0x7f.1",
        "localhost@evil.example",
    ],
)
async def test_a_name_that_was_rebound_to_this_machine_is_refused(host):
    response = await request(headers={"Host": host})
    assert is_problem(response, 403)


async def test_two_host_headers_are_refused():
    response = await request(headers=[("Host", "localhost"), ("Host", "evil.example")])
    assert is_problem(response, 403)


async def test_further_names_can_be_allowed():
    door = behind_door(hosts=["rig.lab"])
    assert (await request(door=door, headers={"Host": "rig.lab:8000"})).status_code == 200
    assert (await request(door=door, headers={"Host": "xrig.lab:8000"})).status_code == 403


async def test_the_address_that_a_connection_arrived_at_is_let_in():
    scopes = []

    async def app(scope, receive, send):
        scopes.append(scope)
        await PlainTextResponse("in")(scope, receive, send)

    async def at(server, host):
        scope = {"type": "http", "method": "GET", "path": "/", "scheme": "http", "server": server}
        scope["headers"] = [(b"host", host)]
        sent = []

        async def send(message):
            sent.append(message)

        await Door(app)(scope, no_more, send)
        return sent[0]["status"]

    assert await at(("10.0.0.7", 8000), b"10.0.0.7:8000") == 200
    assert await at(("fd00::7", 8000), b"[fd00::7]:8000") == 200
    assert await at(("10.0.0.7", 8000), b"10.0.0.8:8000") == 403
    assert await at(("lab.example", 8000), b"lab.example:8000") == 403
    assert await at(None, b"10.0.0.7") == 403


async def no_more():
    return {"type": "http.disconnect"}


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "null",
        "https://127.0.0.1:8000",
        "http://127.0.0.1:3000",
        "http://localhost:8000",
        "",
    ],
)
async def test_another_origin_is_refused_for_reading_and_for_acting(origin):
    for method in ("GET", "POST"):
        assert is_problem(await request(method, headers={"Origin": origin}), 403)


async def test_the_own_origin_is_let_in():
    assert (await request("POST", headers={"Origin": OWN}, json={})).status_code == 200


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
async def test_another_site_may_look_but_not_act(site):
    headers = {"Sec-Fetch-Site": site}
    assert (await request("GET", headers=headers)).status_code == 200
    for method in ("POST", "PUT", "PATCH", "DELETE"):
        assert is_problem(await request(method, headers=headers), 403)


@pytest.mark.parametrize("site", ["same-origin", "none"])
async def test_the_own_page_may_act(site):
    assert (await request("POST", headers={"Sec-Fetch-Site": site}, json={})).status_code == 200


@pytest.mark.parametrize(
    "kind",
    [
        "text/plain",
        "application/x-www-form-urlencoded",
        "multipart/form-data",
        "text/json",
        "application/jsonx",
    ],
)
async def test_a_body_that_a_foreign_form_could_send_is_refused(kind):
    for method in ("POST", "PUT", "PATCH", "DELETE"):
        assert is_problem(await request(method, content=b"{}", headers={"Content-Type": kind}), 415)


async def test_a_body_without_a_type_is_refused_also_when_it_is_streamed():
    assert is_problem(await request("POST", content=b"{}"), 415)
    assert is_problem(await request("POST", content=in_pieces(b"{", b"}")), 415)


@pytest.mark.parametrize("kind", ["application/json", "Application/JSON; charset=utf-8"])
async def test_json_passes_whole(kind):
    response = await request("POST", content=in_pieces(b'{"a"', b":1}"), headers={"Content-Type": kind})
    assert response.content == b'{"a":1}'


async def test_a_post_without_a_body_needs_no_type():
    assert (await request("POST")).status_code == 200


async def in_pieces(*pieces):
    for piece in pieces:
        yield piece


@pytest.mark.parametrize(("size", "status"), [(1000, 200), (1001, 413)])
async def test_a_body_has_a_limit_announced_or_streamed(size, status):
    headers = {"Content-Type": "application/json"}
    for content in (b"x" * size, in_pieces(*[b"x"] * size)):
        assert (await request("POST", content=content, headers=headers)).status_code == status


@pytest.mark.parametrize("length", ["-1", "1e3", "0x10", "٣", "", " "])
async def test_a_length_that_is_no_number_is_refused(length):
    headers = [("Content-Type", "application/json"), ("Content-Length", length.encode())]
    response = await request("POST", content=in_pieces(b"{}"), headers=headers)
    assert is_problem(response, 400)


async def test_an_absurd_length_is_refused_without_reading():
    headers = {"Content-Type": "application/json", "Content-Length": "9" * 5000}
    assert is_problem(await request("POST", content=in_pieces(b"{}"), headers=headers), 413)


async def test_a_body_that_does_not_come_is_given_up():
    async def never():
        await asyncio.Event().wait()
        return {"type": "http.disconnect"}

    sent = []

    async def send(message):
        sent.append(message)

    headers = [(b"host", b"localhost"), (b"content-type", b"application/json"), (b"content-length", b"5")]
    scope = {"type": "http", "method": "POST", "path": "/echo", "scheme": "http", "server": None}
    await behind_door()({**scope, "headers": headers}, never, send)
    assert sent[0]["status"] == 408


async def test_a_failing_route_answers_with_a_problem_and_tells_nothing(caplog):
    response = await request(url=f"{OWN}/broken")
    assert is_problem(response, 500)
    assert "secret" not in response.text
    assert "secret" in caplog.text


async def test_every_answer_carries_the_headers_that_keep_a_browser_careful():
    for response in (
        await request(),
        await request(headers={"Host": "evil.example"}),
        await request(url=f"{OWN}/broken"),
    ):
        assert response.headers["x-content-type-options"] == "nosniff"
        assert response.headers["referrer-policy"] == "no-referrer"
        assert response.headers["cross-origin-resource-policy"] == "same-origin"
        policy = response.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy


async def test_a_host_header_cannot_write_into_the_policy():
    response = await request(headers={"Host": "localhost; script-src *:80"})
    assert response.status_code == 403
    policy = response.headers["content-security-policy"]
    assert [rule.split()[0] for rule in policy.split(";")].count("script-src") == 1
    assert "*" not in policy


async def test_only_the_scene_may_evaluate():
    for path, evaluates in (
        ("/scene/", True),
        ("/scene/abc/", True),
        ("/", False),
        ("/docs", False),
        ("/static/scene.js", False),
        ("/scenery", False),
    ):
        response = await request(url=OWN + path)
        assert ("unsafe-eval" in response.headers["content-security-policy"]) is evaluates


async def test_a_document_that_is_opened_by_itself_runs_nothing():
    for path in ("/api/v1/studies/one/report", "/api/v1/runs/one/plot.svg", "/api/v1/calibration/board.pdf"):
        policy = (await request(url=OWN + path)).headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "script-src" not in policy
        assert "connect-src" not in policy


async def test_only_the_scene_may_stand_in_a_frame_and_only_in_our_own():
    for path, ancestors in (
        ("/scene/", "'self'"),
        ("/", "'none'"),
        ("/docs", "'none'"),
        ("/report", "'none'"),
    ):
        policy = (await request(url=OWN + path)).headers["content-security-policy"]
        assert f"frame-ancestors {ancestors}" in policy


@pytest.fixture
async def socket(serve):
    async with serve(behind_door()) as at:
        yield at


async def test_a_socket_of_the_own_page_or_of_a_script_opens(socket):
    for origin in (None, socket.url):
        async with socket.socket("/socket", origin=origin) as opened:
            await opened.send("hello")
            assert await opened.recv() == "hello"


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        (None, "http://evil.example"),
        (None, "null"),
        (None, "http://127.0.0.1:3000"),
        ("evil.example", None),
        ("evil.example", "http://evil.example"),
    ],
)
async def test_a_socket_from_elsewhere_is_refused_before_it_opens(socket, host, origin):
    with pytest.raises(InvalidStatus) as refused:
        await socket.socket("/socket", name=host, origin=origin)
    assert refused.value.response.status_code == 403


async def test_a_message_beyond_the_limit_ends_the_socket(socket):
    async with socket.socket("/socket") as opened:
        await opened.send("x" * 100)
        assert await opened.recv() == "x" * 100
        await opened.send("x" * 101)
        with pytest.raises(ConnectionClosed) as closed:
            await opened.recv()
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1009
