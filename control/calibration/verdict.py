"""From how the robot turns to what is wrong with the coils' wiring, the magnet or the camera. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from control.calibration.turning import Evidence
from control.model import wrap

HALF_TURN = math.pi
UPRIGHT = math.radians(45.0)
"""Offsets are sorted into quarters, each this far either way, rad."""
UNTURNED = math.radians(3.0)
"""An offset of the heading that is not worth a registration, rad: the play of the body."""


class Cause(StrEnum):
    """What is wrong, by one name each."""

    NONE = "none"
    TURNED = "turned"
    MAGNET_REVERSED = "magnet_reversed"
    X_SWAPPED = "x_leads_swapped"
    Y_SWAPPED = "y_leads_swapped"
    Z_SWAPPED = "z_leads_swapped"
    XY_EXCHANGED = "x_and_y_exchanged"
    MIRRORED = "picture_mirrored"
    MIXED = "mixed"


@dataclass(frozen=True, slots=True)
class Verdict:
    """causes: one, or those that look alike.  message: for the operator, with what to do.

    is_sure: the ends could be told apart; else a magnet that lies the other way round looks like one that does not.
    """

    causes: tuple[Cause, ...]
    message: str
    is_sure: bool = True

    @property
    def is_usable(self) -> bool:
        """The registration can take care of it."""
        return self.is_sure and set(self.causes) <= {Cause.NONE, Cause.TURNED, Cause.MAGNET_REVERSED}


def diagnose(evidence: Evidence, picture_is_mirrored: bool | None = None) -> Verdict:
    """What is wrong. picture_is_mirrored: what a person saw who held a text under the camera, if anybody did.

    To the robot a mirrored picture and swapped leads of one coil are the same, so without that answer both
    are named.
    """
    verdict = _with_the_field(evidence) if evidence.sense > 0 else _against_it(evidence, picture_is_mirrored)
    if evidence.names_are_sure or verdict.causes == (Cause.XY_EXCHANGED,):
        return verdict
    return Verdict(
        verdict.causes,
        f"{verdict.message}. The robot spun out of sight when the field came up, so its ends may have "
        "changed names: put it down with end A as the rig file's heading_hint_deg says and try again",
        is_sure=False,
    )


def _with_the_field(evidence: Evidence) -> Verdict:
    offset, right = evidence.offset, evidence.presses_right_end
    degrees = f"{math.degrees(offset):+.1f} degrees"
    if abs(offset) <= UPRIGHT and not right:
        message = "the wrong end is pressed down: the z coils' leads are swapped; exchange them"
        return Verdict((Cause.Z_SWAPPED,), message)
    if abs(offset) <= UPRIGHT:
        if abs(offset) <= UNTURNED:
            return Verdict((Cause.NONE,), "coils, magnet and camera agree")
        return Verdict((Cause.TURNED,), f"the camera is turned against the coils by {degrees}: register them")
    if abs(offset) >= HALF_TURN - UPRIGHT and not right:
        return Verdict(
            (Cause.MAGNET_REVERSED,),
            "the robot's magnet is the other way round (or it was put down the other way round): "
            "registration sets magnet_reversed, or turn it by half a turn",
        )
    if right:
        return Verdict((Cause.TURNED,), f"the camera is turned against the coils by {degrees}: register them")
    return Verdict(
        (Cause.MIXED,), f"the robot stands {degrees} off and on the wrong end: check the z coils' leads first"
    )


_QUARTERS = (
    (0.0, Cause.X_SWAPPED, "the x coils' leads are swapped", "left and right"),
    (HALF_TURN, Cause.Y_SWAPPED, "the y coils' leads are swapped", "top and bottom"),
    (
        -0.5 * HALF_TURN,
        Cause.XY_EXCHANGED,
        "the x and y coils are exchanged at the drivers",
        "across a diagonal",
    ),
)
"""Against the field: offset (rad) with the ends' names right, cause, in words, and the mirror that looks alike."""


def _against_it(evidence: Evidence, picture_is_mirrored: bool | None) -> Verdict:
    if picture_is_mirrored:
        return Verdict(
            (Cause.MIRRORED,), "the picture is mirrored: turn that off in the camera or its driver"
        )
    for quarter, cause, words, mirror in _QUARTERS:
        if evidence.presses_right_end and abs(wrap(evidence.offset - quarter)) <= UPRIGHT:
            if picture_is_mirrored is None:
                return Verdict(
                    (cause, Cause.MIRRORED),
                    f"the robot turns against the field: {words}, or the picture is mirrored ({mirror}); "
                    "hold a text under the camera to tell",
                )
            return Verdict((cause,), f"the robot turns against the field: {words}; exchange them")
    if picture_is_mirrored is None and not evidence.presses_right_end:
        return Verdict(
            (Cause.MIRRORED, Cause.MIXED),
            "the robot turns against the field and stands on the wrong end: the picture is mirrored, or more than "
            "one thing is wrong; hold a text under the camera to tell",
        )
    return Verdict(
        (Cause.MIXED,),
        "the robot turns against the field and more than one thing is wrong: check the leads of each pair with "
        "`pivotrig calibrate coils`, the magnetometer tells their signs",
    )
