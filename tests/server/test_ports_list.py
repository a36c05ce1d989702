"""What the server tells of serial ports, and that it leaves the rig's own alone."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

pytestmark = pytest.mark.anyio


async def test_the_list_of_ports_opens_none_of_them(api: httpx.AsyncClient) -> None:
    """Whatever is plugged in: nobody is asked, and a board keeps its boot."""
    answer = await api.get("/ports")
    assert answer.status_code == 200
    for port in answer.json():
        assert {"device", "usb_id", "serial_number", "by_id", "board", "state", "message"} <= port.keys()
        assert port["state"] == "unknown"
        assert port["identity"] is None


async def test_the_rigs_own_port_is_not_asked_who_it_is(api: httpx.AsyncClient, at: Any) -> None:
    before = at.rig.snapshot.link
    refused = await api.post("/ports/probe", json={"port": before.port})
    assert refused.status_code == 409
    assert "in use by this rig" in refused.json()["detail"]
    assert at.rig.snapshot.link.boot_id == before.boot_id


async def test_only_a_serial_port_on_usb_is_opened(api: httpx.AsyncClient) -> None:
    for name in ("/dev/null", "/etc/passwd", "../../dev/tty", "socket://example.org:80"):
        refused = await api.post("/ports/probe", json={"port": name})
        assert refused.status_code == 404
        assert "no serial port on USB" in refused.json()["detail"]


@pytest.mark.parametrize(
    "body", [{}, {"port": ""}, {"port": "a\x00b"}, {"port": 7}, {"port": "x", "speed": 1}]
)
async def test_a_bad_body_is_a_problem_document(api: httpx.AsyncClient, body: dict[str, Any]) -> None:
    refused = await api.post("/ports/probe", json=body)
    assert refused.status_code == 422
    assert refused.json()["errors"]


async def test_the_link_is_shown_with_its_counts_and_round_trips(api: httpx.AsyncClient, at: Any) -> None:
    link = (await api.get("/state")).json()["link"]
    assert {"round_trip_median_ms", "round_trip_p99_ms", "bad_share"} <= link.keys()
    counted = {"sent", "received", "broken", "resends", "reconnects", "board_bad", "refused", "stale"}
    assert link["counts"].keys() == counted
    assert link["counts"]["sent"] >= 2 or at.rig.snapshot.link.state != "ready"
