"""Network cameras: real HTTP servers that are killed, frozen, slow, or want a login."""

from __future__ import annotations

import os
import signal
import socket
import statistics
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from urllib.parse import urlsplit

import pytest

from tests.processes import started
from tests.vision.camera_watch import Watch, watched
from vision.sources.live import CLOSING_TIME, OPENING_TIME
from vision.sources.opening import CameraError, CameraRequest, open_camera

SIZE = (80, 64)
SERVER = "tests.vision.mjpeg_server"


@contextmanager
def serving(
    port: int = 0, rate: float = 30.0, login: str = ""
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    with started(SERVER, str(port), str(rate), *([login] if login else [])) as (process, address):
        yield process, address


@contextmanager
def watching(address: str) -> Iterator[Watch]:
    with watched(address, *SIZE, 30) as watch:
        yield watch


def test_a_stream_that_breaks_off_is_taken_up_again_when_its_server_is_back() -> None:
    """As an unplugged cable would: the server dies, and another one starts on the same port."""
    with serving() as (first, address), watching(address) as watch:
        before = watch.frame()
        assert before["identity"] == address
        first.kill()
        watch.note("has broken off")
        watch.trouble("does not answer with a video stream")
        with serving(port=urlsplit(address).port or 0):
            watch.note("is there")
            assert watch.frame()["index"] > before["index"]


def test_a_server_that_freezes_keeps_nobody_waiting() -> None:
    """Every read comes back in its time, so that a dead camera is found within three of them (102 ms), and closing
    does, too; the stream goes on when the server does."""
    with serving() as (server, address), watching(address) as watch:
        watch.frame()
        server.send_signal(signal.SIGSTOP)
        waits = [watch.until(lambda line: "trouble" in line)["at"] for _ in range(20)]
        assert statistics.median(b - a for a, b in pairwise(waits)) < 0.1
        server.send_signal(signal.SIGCONT)
        watch.frame()
        server.send_signal(signal.SIGSTOP)
        assert watch.close() <= CLOSING_TIME + 0.5
        os.kill(server.pid, signal.SIGCONT)


def test_a_slow_stream_gives_each_frame_once_and_nothing_between() -> None:
    with serving(rate=5.0) as (_, address), watching(address) as watch:
        frames = watch.frames(5)
        assert len({frame["index"] for frame in frames}) == 5
        between = [line for line in watch.lines if line.get("trouble") == ""]
        assert len(between) >= 5
        assert all(0.0 <= frame["at"] - frame["captured_at"] < 0.1 for frame in frames[1:])


def test_a_camera_that_was_off_at_the_start_is_found_later() -> None:
    with serving() as (_, address):
        port = urlsplit(address).port or 0
    with watching(address) as watch:
        watch.trouble("does not answer with a video stream")
        with serving(port=port):
            watch.frame()


def test_a_login_opens_the_stream_and_is_told_nobody() -> None:
    with serving(login="lab:s3cret") as (_, address):
        with watching(address.replace("//", "//lab:s3cret@")) as watch:
            assert watch.frame()["identity"] == address
        wrong = open_camera(address.replace("//", "//lab:wr0ng@"), CameraRequest(SIZE))
        try:
            with pytest.raises(CameraError, match="check its address, user and password") as refusal:
                wrong.require()
            assert "lab" not in str(refusal.value)
            assert "wr0ng" not in str(refusal.value)
            assert "lab" not in "".join(note.message for note in wrong.take_notes())
        finally:
            wrong.close()


def test_an_address_that_takes_the_call_and_says_nothing_keeps_nobody_waiting() -> None:
    """A port that accepts and never answers: reads and closing come back in their time while it is being opened."""
    with socket.create_server(("127.0.0.1", 0)) as silent:
        camera = open_camera(f"http://127.0.0.1:{silent.getsockname()[1]}/video", CameraRequest(SIZE))
        begin = time.monotonic()
        assert camera.read(0.034) is None
        assert "is being opened" in camera.trouble
        assert time.monotonic() - begin < 1.0
        with pytest.raises(CameraError, match="does not answer"):
            camera.require()
        assert time.monotonic() - begin < OPENING_TIME + 1.0
        begin = time.monotonic()
        camera.close()
        assert time.monotonic() - begin < CLOSING_TIME + 0.5


def test_a_stream_of_another_size_than_asked_is_refused_by_name() -> None:
    with serving() as (_, address):
        camera = open_camera(address, CameraRequest((640, 480)))
        try:
            with pytest.raises(CameraError, match="gives 80x64 px where 640x480 px was asked"):
                camera.require()
            assert camera.read(0.05) is None
        finally:
            camera.close()


def test_the_latency_that_was_measured_is_taken_off_each_stamp() -> None:
    with serving() as (_, address):
        camera = open_camera(address, CameraRequest(SIZE, latency=0.080))
        try:
            camera.require()
            ages = []
            while len(ages) < 10:
                frame = camera.read(0.5)
                if frame is not None:
                    ages.append(camera.now() - frame.captured_at)
            assert 0.080 <= statistics.median(ages) <= 0.100
        finally:
            camera.close()
