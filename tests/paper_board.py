"""The board of the paper's rig as the tests of link and twin configure it."""

import math

from control.link.conversion import Configuration

CONFIGURATION = Configuration(
    current_limits=(8.0, 8.0, 8.0),
    dead_man=0.2,
    ramp=0.05,
    field_slew=0.010 / 0.3,
    resistances=(2.5, 2.0, 1.5),
    inductances=(0.125, 0.055, 0.014),
    supply=24.0,
    max_field=0.02,
    max_rate=2.0,
    max_tilt=math.radians(60.0),
)
