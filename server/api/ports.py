"""What can be connected: the serial ports on USB, and who answers there."""

from __future__ import annotations

import asyncio
from dataclasses import asdict
from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import Field

from control.link.discovery import FoundPort, find_boards, same_device
from control.link.probe import Findings, Identity, probe
from control.safety import Refused
from server.api import ticks
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.problems import not_found
from server.api.schemas import Edge

router = APIRouter(tags=["ports"], route_class=StrictRoute)


class ProbeBody(Edge):
    """Asking opens the port, which resets an UNO."""

    port: Annotated[str, Field(max_length=255, pattern=r"^[^\x00-\x1f]+$")] = Field(
        title="Port", description="One of those that GET /ports lists, by its device or its lasting name."
    )


@router.get("/ports")
async def ports(rig: TheRig) -> list[dict[str, Any]]:
    """Every serial port on USB, known boards first. Nothing is opened, the rig's own port least of all."""
    found = await asyncio.to_thread(find_boards, leave=(rig.snapshot.link.port,))
    return [_port_json(one) for one in found]


@router.post("/ports/probe")
async def probe_port(body: ProbeBody, rig: TheRig) -> dict[str, Any]:
    """Ask who answers on a port; takes up to 3 s, and leaves the board that is there reset and at zero."""
    if same_device(body.port, rig.snapshot.link.port):
        raise Refused(f"{body.port} is in use by this rig; what it says is in GET /state")
    listed = await asyncio.to_thread(find_boards)
    named = next((one for one in listed if same_device(one.port.device, body.port)), None)
    if named is None:
        there = ", ".join(one.port.device for one in listed) or "none"
        raise not_found(f"{body.port} is no serial port on USB; there are: {there}")
    findings = await asyncio.to_thread(probe, named.port.device)
    return _port_json(FoundPort(named.port, findings))


def _port_json(found: FoundPort) -> dict[str, Any]:
    return {**asdict(found.port), "board": found.port.board, **findings_json(found.findings)}


def findings_json(findings: Findings) -> dict[str, Any]:
    return {
        "state": findings.state.value,
        "message": findings.message,
        "identity": None if findings.identity is None else identity_json(findings.identity),
    }


def identity_json(identity: Identity) -> dict[str, Any]:
    return {
        "firmware": identity.firmware,
        "protocol": identity.protocol,
        "boot_id": identity.boot_id,
        "reset_cause": identity.reset_cause,
        "configuration_hash": identity.configuration_hash,
        "round_trip_ms": ticks.scaled(identity.round_trip, ticks.MILLI, 3),
    }
