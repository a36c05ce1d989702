"""Calibrations that let the robot walk: the star for the gait's figures, to and fro for the camera's latency."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import Field
from starlette.requests import HTTPConnection

from control.controllers.wiggle import WiggleParameters
from control.gait import Gait
from control.gait_settings import MM
from server.api.access import TheChanges, TheRig
from server.api.body import StrictRoute
from server.api.operator import TheHand
from server.api.rig_file import own_file, told
from server.api.schemas import Edge
from server.assembly import Machine
from server.calibration.gait import Star, StarWalk
from server.calibration.latency import LatencyWalk
from server.calibration.runs import Calibration, CalibrationRuns, Kind
from server.calibration.walk import CalibrationWalk
from server.lease.desk import Hand
from server.rig import Rig
from server.rig_file import merged
from server.settings import RigFile

router = APIRouter(prefix="/calibration", tags=["calibration"], route_class=StrictRoute)


class StarBody(Edge):
    """A star of legs, each walked out and back; the defaults take a minute."""

    legs: int = Field(default=5, ge=2, le=36, title="Legs", json_schema_extra={"unit": "1"})
    leg_mm: float = Field(
        default=20.0, ge=5.0, le=50.0, title="Length of a leg", json_schema_extra={"unit": "mm"}
    )
    rate_deg_s: float = Field(
        default=100.0, ge=5.0, lt=360.0, title="Rate", json_schema_extra={"unit": "°/s"}
    )
    sweep_deg: float = Field(default=30.0, ge=10.0, le=90.0, title="Sweep", json_schema_extra={"unit": "°"})


class LatencyBody(Edge):
    """To and fro on one end; the defaults take half a minute."""

    turns: int = Field(default=24, ge=4, le=200, title="Turns", json_schema_extra={"unit": "1"})


async def the_calibration_runs(connection: HTTPConnection) -> CalibrationRuns:
    return connection.app.state.calibration_runs


TheCalibrationRuns = Annotated[CalibrationRuns, Depends(the_calibration_runs)]


@router.post("/star", status_code=202)
async def walk_star(
    runs: TheCalibrationRuns, rig: TheRig, hand: TheHand, body: StarBody | None = None
) -> dict[str, Any]:
    """Walk a star on the armed rig, with the tilt and field of the selected gait."""
    body = body or StarBody()
    star = Star(body.legs, body.leg_mm * MM, math.radians(body.rate_deg_s))
    gait = replace(_still(rig.selection.gait), sweep=math.radians(body.sweep_deg), max_rate=star.rate)
    return await _begin(runs, rig, Kind.STAR, lambda machine: StarWalk(machine, gait, star), hand)


@router.post("/latency", status_code=202)
async def wiggle(
    runs: TheCalibrationRuns, rig: TheRig, hand: TheHand, body: LatencyBody | None = None
) -> dict[str, Any]:
    """Turn to and fro on the armed rig, and see how late the camera shows it."""
    body = body or LatencyBody()
    gait, parameters = _still(rig.selection.gait), WiggleParameters(turns=body.turns)
    return await _begin(runs, rig, Kind.LATENCY, lambda machine: LatencyWalk(machine, gait, parameters), hand)


@router.get("/star")
async def star_state(runs: TheCalibrationRuns, rig: TheRig) -> dict[str, Any]:
    """How far the star is, what it has found, and what the rig file has now."""
    return {**calibration_json(runs[Kind.STAR], rig.settings), "in_use": star_in_use(rig.settings)}


@router.get("/latency")
async def latency_state(runs: TheCalibrationRuns, rig: TheRig) -> dict[str, Any]:
    """How far it is, what it has found, and what the rig file has now."""
    return {**calibration_json(runs[Kind.LATENCY], rig.settings), "in_use": latency_in_use(rig.settings)}


@router.post("/star/save")
async def save_star(
    runs: TheCalibrationRuns, rig: TheRig, changes: TheChanges, hand: TheHand
) -> dict[str, Any]:
    """What the star has found goes into the rig file; needs a disarmed rig, which is then rebuilt."""
    await _save(runs, Kind.STAR, changes, hand)
    return await star_state(runs, rig)


@router.post("/latency/save")
async def save_latency(
    runs: TheCalibrationRuns, rig: TheRig, changes: TheChanges, hand: TheHand
) -> dict[str, Any]:
    """The latency goes into the rig file; needs a disarmed rig, which is then rebuilt."""
    await _save(runs, Kind.LATENCY, changes, hand)
    return await latency_state(runs, rig)


def _still(gait: Gait) -> Gait:
    """The gait without what belongs to a path: these walks follow none."""
    return replace(Gait(), tilt=gait.tilt, field=gait.field)


async def _begin(
    runs: CalibrationRuns, rig: Rig, kind: Kind, make: Callable[[Machine], CalibrationWalk], hand: Hand
) -> dict[str, Any]:
    return calibration_json(await runs.start(kind, make, hand.require), rig.settings)


async def _save(runs: CalibrationRuns, kind: Kind, changes: TheChanges, hand: Hand) -> None:
    with told():
        await own_file(changes).alter(lambda _: runs.to_save(kind), hand.require)


def calibration_json(value: Calibration, settings: RigFile) -> dict[str, Any]:
    """figures: with standard errors.  changes: what saving writes into the rig file.  saved: they are there."""
    findings = value.findings
    return {
        "stage": value.stage.value,
        "progress": round(value.progress, 3),
        "reason": value.reason,
        "run_id": value.run_id or None,
        "figures": None if findings is None else findings.figures,
        "changes": None if findings is None else findings.changes,
        "measured_at": value.at or None,
        "saved": findings is not None and _has(settings, findings.changes),
    }


def _has(settings: RigFile, changes: Mapping[str, Any]) -> bool:
    values = settings.model_dump(mode="json")
    return merged(values, changes) == values


def star_in_use(settings: RigFile) -> dict[str, Any]:
    return {
        "length_mm": settings.robot.length_mm,
        "backlash_deg": settings.estimator.backlash_deg,
        "heading_offset_deg": settings.vision.heading_offset_deg,
        "rotation_deg": settings.coils.registration.rotation_deg,
        **settings.gait.model_dump(),
    }


def latency_in_use(settings: RigFile) -> dict[str, Any]:
    return {"latency_ms": settings.camera.latency_ms, "source": settings.camera.latency_source}
