"""What the server tells of cameras, and that it shows nobody a login."""

from __future__ import annotations

import threading
from typing import Any

import httpx
import pytest

from server.api import cameras
from server.camera_sections import CameraSection
from server.settings import LinkSection, RigFile
from vision.sources.listing import FoundCamera
from vision.sources.search import CameraSearch

LOGIN = "rtsp://lab:s3cret@10.0.0.2:554/live"
FIELDS = {"uri", "name", "identity", "path", "in_use", "sizes", "rates_Hz"}


@pytest.mark.anyio
async def test_the_rig_s_own_camera_is_listed_first_and_in_use(api: httpx.AsyncClient, at: Any) -> None:
    answer = await api.get("/cameras")
    assert answer.status_code == 200
    own, *others = answer.json()
    camera = at.rig.machine.camera
    assert own == {
        "uri": "sim://",
        "name": "simulated camera",
        "identity": "simulated camera",
        "path": None,
        "in_use": True,
        "sizes": [list(camera.size)],
        "rates_Hz": [camera.rate],
    }
    assert all(other.keys() == FIELDS for other in others)


@pytest.mark.anyio
async def test_a_driver_that_hangs_keeps_one_thread_and_nobody_waiting(
    api: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However often the list is asked for; when the driver is back, so is the list."""
    answers, searches = threading.Event(), []

    def find() -> list[FoundCamera]:
        searches.append(threading.current_thread())
        answers.wait(30.0)
        return []

    monkeypatch.setattr(cameras, "search", CameraSearch(find))
    monkeypatch.setattr(cameras, "SEARCH_TIME", 0.1)
    for _ in range(5):
        answer = await api.get("/cameras")
        assert answer.status_code == 503
        assert "driver has not answered" in answer.json()["detail"]
    assert len(searches) == 1
    answers.set()
    searches[0].join()
    assert (await api.get("/cameras")).status_code == 200


def test_the_values_that_go_outside_hold_no_login() -> None:
    rig = RigFile(camera=CameraSection(uri=LOGIN), link=LinkSection(port="auto"))
    assert rig.to_public()["camera"]["uri"] == "rtsp://***@10.0.0.2:554/live"
    assert rig.camera.uri == LOGIN
