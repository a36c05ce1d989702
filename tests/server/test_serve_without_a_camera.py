"""A real rig whose camera is off: its page opens, disarmed, says why, and finds the camera later (rows 1 and 4)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from typer.testing import CliRunner

from server.cli import app
from tests.processes import Server, ServerRefused, poll, served, started
from tests.real_rig import real_rig

CAMERA = "tests.vision.mjpeg_server"
LOGIN = "lab:s3cret"


@contextmanager
def camera_on(address: str = "http://127.0.0.1:0", rate: float = 30.0) -> Iterator[str]:
    """A network camera of 80x64 px that wants a login; gives its address."""
    with started(CAMERA, str(urlsplit(address).port), str(rate), LOGIN) as (_, where):
        yield where


@pytest.fixture(scope="module")
def address() -> str:
    """Of a camera that has been switched off again."""
    with camera_on() as where:
        return where


@pytest.fixture(scope="module")
def rig_file(tmp_path_factory: pytest.TempPathFactory, address: str) -> Iterator[Path]:
    """Of a rig with this camera."""
    with real_rig(tmp_path_factory.mktemp("rig")) as path:
        text = path.read_text().replace("size_px = [64, 64]", "size_px = [80, 64]")
        film = text.split('uri = "')[1].split('"')[0]
        path.write_text(text.replace(film, address.replace("//", f"//{LOGIN}@")))
        yield path


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory, rig_file: Path) -> Iterator[Server]:
    """Of that rig; started while the camera is off."""
    with served(tmp_path_factory.mktemp("data"), "--rig", str(rig_file)) as server:
        yield server


def camera_fault(server: Server, words: str) -> dict[str, Any]:
    """The state once it has a fault of the camera that says this."""
    return server.until(
        lambda state: words in "".join(f["message"] for f in state["faults"] if f["code"] == "camera")
    )


def told(server: Server, words: str) -> bool:
    return any(words in event["message"] for event in server.get("/events")["events"])


def test_a_headless_run_needs_its_camera(rig_file: Path) -> None:
    answer = CliRunner().invoke(app, ["run", "--rig", str(rig_file), "--yes"])
    assert answer.exit_code != 0
    assert "does not answer with a video stream" in answer.output
    assert "s3cret" not in answer.output


def test_a_camera_that_is_off_is_waited_for_and_arms_nothing(server: Server, address: str) -> None:
    """Off: the page opens and says so. On: pictures come. Off again: missed at once, and nothing arms by itself."""
    state = camera_fault(server, "does not answer with a video stream")
    assert state["rig"] == "disarmed"
    with pytest.raises(ServerRefused, match="409"):
        server.post("/arm", {"consent": True})
    with camera_on(address):
        state = server.until(lambda state: "camera" not in [fault["code"] for fault in state["faults"]])
        assert state["rig"] == "disarmed"
        assert server.get("/cameras")[0]["identity"] == address
    assert camera_fault(server, "does not answer")["rig"] == "disarmed"
    poll(lambda: told(server, "has broken off"), bool)
    assert told(server, "is there")


def test_nobody_is_shown_the_camera_s_login(server: Server, rig_file: Path) -> None:
    """Not in the values, the state, the list of cameras or the event log; and values that come back as they were
    shown change nothing."""
    camera_fault(server, "does not answer")
    seen = [server.get(path) for path in ("/rig", "/state", "/cameras", "/events")]
    assert "s3cret" not in str(seen)
    shown = server.get("/rig")["camera"]
    assert "***@" in shown["uri"]
    answer = server.send("PATCH", "/rig", {"camera": {"uri": shown["uri"]}, "name": "Bench 4"})
    assert answer["changed"] == ["name"]
    assert f"{LOGIN}@" in rig_file.read_text()
