"""The messages between host and board, in the integers that travel.

Binary angles have 65536 to the turn, phases 2^32; see `control.link.conversion` for SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, IntFlag

ALLOCATION_ONE = 1 << 14
"""Q14: this integer in an allocation stands for 1 mA/uT."""

SENSE_GAIN = 8929
"""mA per ADC count, Q8: 5 V / 1024 / (0.14 V/A) = 34.88 mA (VNH5019 with the UNO's 5 V reference)."""

SENSE_GAINS = (SENSE_GAIN // 2, SENSE_GAIN * 5 // 4)
"""Least and most that a board may be told: the sense is known to be off by up to 25 %, and beyond that the
regulator's products would leave 32 bits."""

Triple = tuple[int, int, int]
Six = tuple[int, int, int, int, int, int]
Nine = tuple[int, int, int, int, int, int, int, int, int]


class BoardCode(IntEnum):
    """State of the board; only DRIVING ever has a non-zero PWM."""

    BOOTED = 0
    READY = 1
    DRIVING = 2
    EXPIRED = 3
    STOPPED = 4
    FAULT = 5


class Flag(IntFlag):
    """Fault and condition bits in the telemetry."""

    OVER_CURRENT = 1
    DRIVER_FAULT = 2
    SUPPLY_LOW = 4
    SATURATED = 8
    SUPPLY_ASSUMED = 16


class Refusal(IntEnum):
    """Why the board refused a message last."""

    NONE = 0
    VERSION = 1
    BOOT_ID = 2
    SEQUENCE = 3
    STATE = 4
    FLAGS = 5
    PIVOT = 6
    RATE = 7
    TILT = 8
    FIELD = 9
    LIFETIME = 10
    CONFIGURATION = 11
    DIRECTION = 12


class ResetCause(IntEnum):
    """UNKNOWN: a bootloader has cleared the processor's flags and handed nothing over."""

    UNKNOWN = 0
    POWER_ON = 1
    EXTERNAL = 2
    BROWN_OUT = 3
    WATCHDOG = 4


ARM = 1
"""The arm edge, in Drive.flags."""


@dataclass(frozen=True, slots=True)
class Hello:
    """Asks for a Banner; zeroes the output and restarts the sequence at this message's number."""


@dataclass(frozen=True, slots=True)
class Banner:
    """Who the board is.  Sent at boot with sequence 0, and in answer to Hello and Configure with theirs."""

    firmware: Triple
    reset_cause: int
    configuration_hash: int


@dataclass(frozen=True, slots=True)
class Configure:
    """Limits and coil constants.

    current_limits: mA.  dead_man, ramp: ms.  field_slew: uT/256 per ms.  resistances: mOhm.
    inductances: 10 uH.  supply: mV.  max_field: uT.  max_rate: phase (2^32 = turn) per ms.
    max_tilt: binary angle (65536 = turn).  sense_gains: Q8 mA per ADC count, coil by coil, for positive and
    for negative current.  supply_scale: mV that read 1024 counts; 0: the supply is not sensed.
    """

    current_limits: Triple
    dead_man: int
    ramp: int
    field_slew: int
    resistances: Triple
    inductances: Triple
    supply: int
    max_field: int
    max_rate: int
    max_tilt: int
    sense_gains: Six
    supply_scale: int


@dataclass(frozen=True, slots=True)
class Drive:
    """One drive command.

    rate: phase (2^32 = turn) per ms.  heading_goal, start_heading: phase.  tilt: binary angle (65536 = turn).
    field: uT.  allocation: Q14 mA/uT, row by row, a row a coil.  time_to_live: ms.
    """

    flags: int
    pivot: int
    rate: int
    heading_goal: int
    start_heading: int
    tilt: int
    field: int
    allocation: Nine
    time_to_live: int


@dataclass(frozen=True, slots=True)
class Stop:
    """Zero now; obeyed whatever its sequence number and boot id."""


@dataclass(frozen=True, slots=True)
class Telemetry:
    """What the board is doing, every 10 ms once it has been greeted.

    time: ms since boot.  heading: phase.  elevation: binary angle, signed.  commanded, measured: mA.
    duty: Q15 of the supply.  supply: mV, 0 where it is not sensed.
    last_sequence: of the newest fresh message, obeyed or refused.  good: obeyed messages; bad: broken frames;
    refused and stale: whole messages that were not obeyed.
    """

    time: int
    heading: int
    elevation: int
    commanded: Triple
    measured: Triple
    duty: Triple
    supply: int
    state: int
    flags: int
    last_sequence: int
    good: int
    bad: int
    refused: int
    stale: int
    last_refusal: int
    configuration_hash: int


Message = Hello | Banner | Configure | Drive | Stop | Telemetry
