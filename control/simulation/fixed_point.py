"""Integer arithmetic that the board and its twin share: the Q15 sine over a 16-bit binary angle.

A quarter wave of 257 entries (514 bytes of flash) with linear interpolation over the low 6 bits; its error
stays within 1.1 units of Q15.  The twin looks the same values up in a table of all 65536 angles.
"""

from __future__ import annotations

import math

ONE = 32767
"""Q15: what stands for 1."""

QUARTER_TURN = 1 << 14
ANGLE_MASK = 0xFFFF

QUARTER_WAVE = tuple(round(ONE * math.sin(0.5 * math.pi * k / 256)) for k in range(257))


def sine(angle: int) -> int:
    """sin of a binary angle (65536 = one turn) in Q15, step by step as the board computes it."""
    offset = angle & (QUARTER_TURN - 1)
    if angle & QUARTER_TURN:
        offset = QUARTER_TURN - offset
    index, fraction = offset >> 6, offset & 63
    value = QUARTER_WAVE[index]
    if fraction:
        value += ((QUARTER_WAVE[index + 1] - value) * fraction + 32) >> 6
    return -value if angle & 0x8000 else value


def _full_wave() -> tuple[int, ...]:
    rising = [sine(angle) for angle in range(QUARTER_TURN + 1)]
    half = rising + rising[-2:0:-1]
    return tuple(half + [-value for value in half])


SINE = _full_wave()
"""sine(angle) for every angle in 0..65535."""
