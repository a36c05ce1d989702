"""What section 6 says of the rig itself, beside the field of coils with the printed measures."""

from __future__ import annotations

import math

import numpy as np

from control.coils import CoilSet, command_field, currents_for
from server.reports.findings import Finding, Verdict

CORNER = 0.060
"""Of the paper's workspace of 12 cm x 12 cm, m."""
TILT, FIELD = math.radians(25.0), 0.010
UNIFORM = 0.05
"""A field is called uniform where its strength differs by less than this share over the workspace. A choice."""
HEADINGS = tuple(math.radians(heading) for heading in range(0, 360, 15))


def of_rig() -> list[Finding]:
    strength, tilt = nonuniformity(CoilSet())
    return [
        Finding(
            "6, rig", "the coils produce a uniform field; workspace 12 cm × 12 cm",
            f"with the currents for the centre, the field at the corners is off by up to {100 * strength:.0f} % in "
            f"strength, and a tilt of 25° becomes {math.degrees(tilt):.1f}°",
            Verdict.REPRODUCED if strength < UNIFORM else Verdict.NOT_REPRODUCED,
            "computed from the printed diameters and separations, which are not those of Helmholtz pairs; ours "
            "compensates by default",
        ),
        Finding(
            "6, rig", "8 A at most, a continuous field above 10 mT",
            "our coils have 314, 248 and 154 turns, chosen so that 8 A give 10 mT", Verdict.NOT_COMPARABLE,
            "the paper prints no number of turns and no resistance",
        ),
        Finding(
            "6, plate", "the plate's friction is not uniform, hence some inconsistencies in the errors",
            "our plants scatter by what is assumed for them", Verdict.NOT_COMPARABLE,
            "the paper measures no friction",
        ),
    ]  # fmt: skip


def nonuniformity(coils: CoilSet) -> tuple[float, float]:
    """Largest error of the strength (a share) and smallest tilt (rad) at the corners, over all headings."""
    corners = np.array([(x, y, 0.0) for x in (-CORNER, CORNER) for y in (-CORNER, CORNER)])
    off, least = 0.0, math.inf
    for heading in HEADINGS:
        currents = currents_for(coils.centre_allocation(), command_field(1, heading, TILT, FIELD))
        fields = coils.field_at(corners, currents)
        strengths = np.linalg.norm(fields, axis=1)
        off = max(off, float(np.max(np.abs(strengths / FIELD - 1.0))))
        tilts = np.arctan2(np.abs(fields[:, 2]), np.hypot(fields[:, 0], fields[:, 1]))
        least = min(least, float(tilts.min()))
    return off, least
