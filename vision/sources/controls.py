"""Exposure, gain and white balance of a V4L camera: asked for, read back, and told where the driver did otherwise."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from vision.sources import v4l_ioctl
from vision.sources.request import CameraRequest

# Control numbers of linux/v4l2-controls.h.
GAIN = 0x00980913
AUTO_GAIN = 0x00980912
AUTO_WHITE_BALANCE = 0x0098090C
WHITE_BALANCE_TEMPERATURE = 0x0098091A
AUTO_EXPOSURE = 0x009A0901
EXPOSURE = 0x009A0902
EXPOSURE_MAY_LOWER_RATE = 0x009A0903

EXPOSURE_UNIT = 100e-6
"""The exposure control counts in this unit, s (V4L2_CID_EXPOSURE_ABSOLUTE)."""
MANUAL_EXPOSURE = 1
APERTURE_PRIORITY = 3
"""What USB cameras call their automatic exposure: the exposure time is theirs, the aperture is fixed."""


@dataclass(frozen=True, slots=True)
class Setting:
    """One value that the operator may fix. name: with its unit's name in the rig file.  unit: of the control's steps
    in that unit.  automatic: the control that hands it back to the camera, with its values for manual and automatic."""

    name: str
    wanted: float | None
    unit: float
    control: int
    automatic: int
    manual_value: int
    automatic_value: int


def apply(descriptor: int, request: CameraRequest) -> tuple[str, ...]:
    """Set what is asked; returns in words what the camera does otherwise."""
    _set(descriptor, EXPOSURE_MAY_LOWER_RATE, 0)  # else many cameras halve the rate in the evening
    return tuple(words for setting in _settings(request) for words in _apply(descriptor, setting))


def _settings(request: CameraRequest) -> Iterator[Setting]:
    exposure = None if request.exposure is None else request.exposure * 1e3
    unit = EXPOSURE_UNIT * 1e3
    yield Setting("exposure_ms", exposure, unit, EXPOSURE, AUTO_EXPOSURE, MANUAL_EXPOSURE, APERTURE_PRIORITY)
    yield Setting("gain", request.gain, 1.0, GAIN, AUTO_GAIN, 0, 1)
    yield Setting(
        "white_balance_K", request.white_balance, 1.0, WHITE_BALANCE_TEMPERATURE, AUTO_WHITE_BALANCE, 0, 1
    )


def _apply(descriptor: int, setting: Setting) -> Iterator[str]:
    if setting.wanted is None:
        _set(descriptor, setting.automatic, setting.automatic_value)
        return
    _set(descriptor, setting.automatic, setting.manual_value)
    allowed = v4l_ioctl.control_range(descriptor, setting.control)
    asked = f"{setting.name} = {setting.wanted:g} was asked"
    if allowed is None:
        yield f"{asked}, and the camera has no such setting"
        return
    _set(
        descriptor, setting.control, round(min(max(setting.wanted / setting.unit, allowed.low), allowed.high))
    )
    got = _get(descriptor, setting.control) * setting.unit
    if not abs(got - setting.wanted) <= 0.5 * max(allowed.step, 1) * setting.unit + 1e-9:
        low, high = allowed.low * setting.unit, allowed.high * setting.unit
        taken = f"the camera has {got:g}" if math.isfinite(got) else "the camera does not tell what it has"
        yield f"{asked}, and {taken}; it offers {low:g} to {high:g}"


def _set(descriptor: int, control: int, value: int) -> bool:
    try:
        v4l_ioctl.set_control(descriptor, control, value)
    except OSError:
        return False
    return True


def _get(descriptor: int, control: int) -> float:
    try:
        return float(v4l_ioctl.get_control(descriptor, control))
    except OSError:
        return math.nan
