"""The rig file's [camera.lens], [camera.plane] and [camera.board]: what a calibration of the camera has found."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from server.section import Positive, Section

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
