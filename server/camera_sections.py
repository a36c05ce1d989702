"""The rig file's [camera]: where pictures come from, and the lens, plane and board of a calibration."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from server.section import NOT_MEASURED, Positive, Section
from vision.sources.addresses import NETWORK

SIMULATED_CAMERA = "simulated camera"
"""The identity of the camera that is none."""
LIVE = NETWORK | {"v4l"}
"""Schemes of cameras whose frames bear the time of their arrival; a recording has its own."""

Pixels = Annotated[int, Field(ge=64, le=8192)]
Identity = Annotated[str, Field(max_length=200)]
Date = Annotated[str, Field(max_length=40)]
Residual = Annotated[float, Field(ge=0.0, le=1000.0)]
Coefficient = Annotated[float, Field(ge=-1e4, le=1e4)]
Degrees = Annotated[float, Field(ge=-360.0, le=360.0)]
Distance = Annotated[float, Field(ge=-20_000.0, le=20_000.0)]


class LensSection(Section):
    """The lens, from `pivotrig calibrate lens`."""

    identity: Identity
    """Of the camera that it holds for."""
    date: Date
    size_px: tuple[Pixels, Pixels]
    """Of the pictures that it holds for."""
    fx: Positive
    fy: Positive
    cx: Annotated[float, Field(ge=-1e5, le=1e5)]
    cy: Annotated[float, Field(ge=-1e5, le=1e5)]
    distortion: tuple[Coefficient, Coefficient, Coefficient, Coefficient, Coefficient]
    """k1, k2, p1, p2, k3 (Brown-Conrady)."""
    residual_px: Residual
    """Of the board's corners."""
    error_px: Residual = 0.0
    """How far off the lens leaves a place in the middle of the picture."""
    views: Annotated[int, Field(ge=0, le=10_000)] = 0


class PlaneSection(Section):
    """Where the camera is over the plate, from `pivotrig calibrate plane`."""

    source: Literal["board", "corners", "marks"]
    identity: Identity
    """Of the camera that it holds for."""
    date: Date
    size_px: tuple[Pixels, Pixels]
    lens_date: Date = ""
    """Of the lens that it was found with; "" for one that was assumed."""
    focal_px: Positive
    """Of that lens: a plane belongs to its lens."""
    rotation_deg: tuple[Degrees, Degrees, Degrees]
    """Rotation vector, workspace to camera."""
    translation_mm: tuple[Distance, Distance, Annotated[float, Field(gt=0.0, le=20_000.0)]]
    """The workspace's origin as the camera sees it: x right, y down, z ahead."""
    residual_mm: Residual
    """Estimated error of positions over the workspace."""
    residual_px: Residual
    scale_px_mm: Positive


class BoardSection(Section):
    """The printed board, as it was printed: measure a row of its squares."""

    columns: Annotated[int, Field(ge=4, le=40)] = 14
    rows: Annotated[int, Field(ge=4, le=40)] = 12
    square_mm: Annotated[float, Field(ge=3.0, le=100.0)] = 12.0
    thickness_mm: Annotated[float, Field(ge=0.0, le=50.0)] = 0.0
    """Its print lies so far above the plate."""


class CameraSection(Section):
    """Where the pictures come from, and a camera that looks straight down until it is calibrated."""

    uri: str = "sim://"
    size_px: tuple[Annotated[int, Field(ge=64, le=8192)], Annotated[int, Field(ge=64, le=8192)]] = (640, 480)
    rate_Hz: Annotated[float, Field(ge=1.0, le=500.0)] = 60.0
    exposure_ms: Annotated[float, Field(ge=0.05, le=1000.0)] | None = None
    """Of a real camera, like the next two; without it, it is the camera's own automatic."""
    gain: Annotated[float, Field(ge=0.0, le=100_000.0)] | None = None
    """In the steps of the camera's driver."""
    white_balance_K: Annotated[float, Field(ge=1000.0, le=20_000.0)] | None = None
    height_mm: Annotated[float, Field(gt=0.0, le=10_000.0)] = 350.0
    picture_height_mm: Annotated[float, Field(gt=0.0, le=10_000.0)] = 130.0
    """Length on the plate that fills the picture's height."""
    tilt_deg: tuple[Annotated[float, Field(ge=-30, le=30)], Annotated[float, Field(ge=-30, le=30)]] = (
        1.5,
        0.0,
    )
    distortion: tuple[float, float, float, float, float] = (-0.12, 0.02, 0.0, 0.0, 0.0)
    latency_ms: Annotated[float, Field(ge=0.0, le=200.0)] = 0.0
    """From mid-exposure to the time that a frame is stamped with; subtracted from the stamps."""
    latency_source: Annotated[str, Field(max_length=120)] = NOT_MEASURED
    """Where the latency comes from: the date and the standard error of a measurement."""
    lens: LensSection | None = None
    """Without it, as assumed above."""
    plane: PlaneSection | None = None
    """Without it, the camera hangs as assumed above."""
    board: BoardSection = BoardSection()
