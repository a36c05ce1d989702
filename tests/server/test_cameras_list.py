"""What the server tells of cameras, and that it shows nobody a login."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

from server.settings import CameraSection, LinkSection, RigFile

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


def test_the_values_that_go_outside_hold_no_login() -> None:
    rig = RigFile(camera=CameraSection(uri=LOGIN), link=LinkSection(port="auto"))
    assert rig.to_public()["camera"]["uri"] == "rtsp://***@10.0.0.2:554/live"
    assert rig.camera.uri == LOGIN
