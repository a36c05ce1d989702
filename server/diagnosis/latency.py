"""Whether anybody has measured how late the camera is; a walk that does not know it loses the robot."""

from __future__ import annotations

from server.diagnosis.check import Check, ok, warning
from server.section import NOT_MEASURED
from server.settings import RigFile


def examine(settings: RigFile) -> Check:
    camera = settings.camera
    if camera.latency_ms > 0.0 or camera.latency_source != NOT_MEASURED:
        return ok("camera latency", f"{camera.latency_ms:g} ms ({camera.latency_source})")
    if settings.latency_is_known:
        return ok("camera latency", "none: the frames bear their own time")
    return warning(
        "camera latency",
        "never measured, and taken as 0 ms; cameras are 20 to 60 ms late, and at 35 ms a fast swing already "
        "leaves the robot where it is not expected",
        "run `pivotrig calibrate latency --save`",
    )
