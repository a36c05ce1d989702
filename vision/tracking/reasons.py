"""Why there is no measurement, in the operator's words."""

from __future__ import annotations

from vision.tracking.recognition import Found

NOT_THERE = "nothing in the picture has the robot's colour, size and shape"
COVERED = "the robot is partly covered, or something touches it"
ELSEWHERE = "the robot is not where it should be; if it was moved, it is taken up again after a moment"
OTHERS = "the robot is not seen; what is seen are others: if one of them is the robot, click it"
AGAIN = "seen; the next pictures must show it at the same place"
OTHER_SIZE = "the picture has another size than the camera's calibration"
PERHAPS = "what is seen may be the robot or another one: if it is the robot, click it"


def reason_for(found: Found, *, is_anywhere: bool) -> str:
    """Why a search has not told the robot. is_anywhere: it was looked for in the whole picture, without a place."""
    if len(found.doubtful) > 1:
        return f"{len(found.doubtful)} blobs look like the robot: click the right one"
    if found.doubtful:
        return PERHAPS
    if found.is_covered:
        return COVERED
    if not found.others:
        return NOT_THERE
    return OTHERS if is_anywhere else ELSEWHERE
