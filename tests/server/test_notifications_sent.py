"""The postman and his calls on real sockets: soon, once more after a refusal, never waited for, never for ever."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator

import pytest

from server.postman import WAITING, Letter, Postman
from server.webhook import Call, NotDelivered
from tests.listening_ear import Ear, listening

AT_ONCE = (0.01, 0.01)


@pytest.fixture
def ear() -> Iterator[Ear]:
    with listening() as one:
        yield one


@pytest.fixture
def told() -> list[str]:
    return []


@pytest.fixture
def postman(told: list[str]) -> Iterator[Postman]:
    one = Postman(told.append, AT_ONCE)
    yield one
    one.close()


def until(holds) -> bool:
    deadline = time.monotonic() + 10.0
    while not holds() and time.monotonic() < deadline:
        time.sleep(0.01)
    return holds()


def test_a_letter_arrives_as_json_at_the_whole_address(postman, ear):
    postman.send(Letter(ear.url, 5.0, {"message": "the camera is lost"}))
    (heard,) = ear.wait_for(1)
    assert heard == {
        "message": "the camera is lost", "path": "/hooks/key-of-the-lab?room=7", "type": "application/json",
    }  # fmt: skip


def test_what_is_refused_for_a_moment_is_sent_again_and_nobody_is_bothered(postman, ear, told):
    ear.answers = [503, 500]
    postman.send(Letter(ear.url, 5.0, {"n": 1}))
    postman.send(Letter(ear.url, 5.0, {"n": 2}))
    assert [body["n"] for body in ear.wait_for(4)] == [1, 1, 1, 2]
    assert told == []


def test_what_stays_refused_is_given_up_and_told_once_until_one_arrives(postman, ear, told):
    ear.answers = [404] * 6
    for n in range(2):
        postman.send(Letter(ear.url, 5.0, {"n": n}))
    ear.wait_for(6)
    postman.send(Letter(ear.url, 5.0, {"n": 2}))
    ear.wait_for(7)
    assert len(told) == 1
    assert "3 times: the other side answered 404 Not Found" in told[0]
    assert "key-of-the-lab" not in told[0]
    assert until(lambda: not postman._failing)
    ear.answers = [404] * 3
    postman.send(Letter(ear.url, 5.0, {"n": 3}))
    assert until(lambda: len(told) == 2)


def test_a_side_that_does_not_answer_holds_up_nobody_but_the_postman_and_not_the_end(postman, ear, told):
    ear.mute.set()
    began = time.monotonic()
    for n in range(2 * WAITING):
        postman.send(Letter(ear.url, 30.0, {"n": n}))
    assert time.monotonic() - began < 0.5
    ear.wait_for(1)
    assert told == [f"more than {WAITING} notifications wait to be sent; the newest are lost"]
    began = time.monotonic()
    postman.close()
    assert time.monotonic() - began < 1.0
    assert len(ear.heard) == 1


def test_a_call_ends_after_its_time_even_where_the_other_side_drips():
    stop = threading.Event()

    def drip(listener: socket.socket) -> None:
        connection, _ = listener.accept()
        with connection:
            while not stop.wait(0.05):
                try:
                    connection.send(b"H")
                except OSError:
                    return

    with socket.create_server(("127.0.0.1", 0)) as listener:
        dripping = threading.Thread(target=drip, args=(listener,))
        dripping.start()
        began = time.monotonic()
        with pytest.raises(NotDelivered, match="has not answered within 0"):
            Call(f"http://127.0.0.1:{listener.getsockname()[1]}/", 0.5).post({})
        assert 0.4 < time.monotonic() - began < 3.0
        stop.set()
        dripping.join()


def test_a_call_whose_time_was_over_before_anybody_could_be_reached_sends_nothing(ear, monkeypatch):
    looked_up = socket.getaddrinfo

    def slowly(*where, **how):
        time.sleep(0.4)
        return looked_up(*where, **how)

    monkeypatch.setattr(socket, "getaddrinfo", slowly)
    with pytest.raises(NotDelivered, match="has not answered within 0"):
        Call(ear.url, 0.1).post({})
    assert ear.heard == []


@pytest.mark.parametrize(
    ("url", "why"),
    [
        ("http://127.0.0.1:1/", "nobody listens at its address"),
        ("http://no-such-host.invalid/", "its host's name is not known here"),
    ],
)
def test_what_cannot_be_reached_says_why_in_words(url, why):
    with pytest.raises(NotDelivered, match=why):
        Call(url, 5.0).post({})


def test_a_redirect_is_not_followed(ear):
    ear.answers = [302]
    with pytest.raises(NotDelivered, match="302 Found; it points elsewhere, which is not followed"):
        Call(ear.url, 5.0).post({})
    assert len(ear.heard) == 1


def test_another_protocol_than_the_one_expected_is_no_crash():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]

        def answer() -> None:
            connection, _ = listener.accept()
            with connection:
                connection.recv(1000)
                connection.send(b"220 mail.example ESMTP\r\n")

        speaking = threading.Thread(target=answer)
        speaking.start()
        with pytest.raises(NotDelivered, match="the connection failed"):
            Call(f"http://127.0.0.1:{port}/", 5.0).post({})
        speaking.join()
