"""What the rest of the program says to the board and hears from it, in SI, and the wire's integers for it.

The one place where SI meets the wire: the limits of the host are checked here, before a message exists.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from control.link import messages, wire
from control.link.board_limits import objections
from control.model import TURN, Pivot
from control.snapshot import Vector

MOST_TILT = math.radians(60.0)
"""Steepest field that the board accepts, rad."""

MOST_SUPPLY_SCALE = 65.0
"""Full scale of the supply's divider, V: the wire's 16 bits of mV."""

LONGEST_LIFETIME = 1.0
"""Longest time to live of one drive command, s."""

_PHASE = 2.0**32 / TURN
_ANGLE = 2.0**16 / TURN
_SLEW = 256.0 * 1e6 / 1e3
_ALLOCATION = messages.ALLOCATION_ONE * 1e3 / 1e6

Matrix = tuple[Vector, Vector, Vector]
Directions = tuple[float, float]
"""A value for positive and one for negative current."""

SENSE_GAIN = messages.SENSE_GAIN / 256e3
"""Current of one count of the board's ADC as the driver's data sheet has it, A."""

_DATA_SHEET = (SENSE_GAIN, SENSE_GAIN)


class LinkError(Exception):
    """The link cannot do what was asked; the text says why and what to do."""


class BoardState(StrEnum):
    BOOTED = "booted"
    READY = "ready"
    DRIVING = "driving"
    EXPIRED = "expired"
    STOPPED = "stopped"
    FAULT = "fault"


@dataclass(frozen=True, slots=True)
class Configuration:
    """What the board is told once: limits, and constants of the coils for its current regulator.

    current_limits: A.  dead_man: longest life of a drive command, s.  ramp: time of a full elevation swing
    at a pivot switch, s.  field_slew: rate of the field's strength, T/s.  resistances: ohm.
    inductances: H.  supply: nominal, V.  max_field: T.  max_rate: rad/s.  max_tilt: rad.
    sense_gains: A per ADC count, a coil each, for positive and for negative current.
    supply_scale: the supply that would read 1024 counts, V; 0: it is not sensed, and taken to be nominal.
    """

    current_limits: Vector
    dead_man: float
    ramp: float
    field_slew: float
    resistances: Vector
    inductances: Vector
    supply: float
    max_field: float
    max_rate: float
    max_tilt: float
    sense_gains: tuple[Directions, Directions, Directions] = (_DATA_SHEET, _DATA_SHEET, _DATA_SHEET)
    supply_scale: float = 55.0


@dataclass(frozen=True, slots=True)
class DriveCommand:
    """What the field is to do until the next command.

    rate: of the heading, rad/s.  heading_goal: where it stops, rad, at most half a turn ahead.
    tilt: elevation that presses the pivot down, rad.  field: strength, T.
    allocation: (3, 3) A/T, a row a coil, I = allocation @ B.  time_to_live: s.
    start_heading: the arm edge: drive from standstill, with the board's heading set to this, rad.
    """

    pivot: Pivot
    rate: float
    heading_goal: float
    tilt: float
    field: float
    allocation: Matrix
    time_to_live: float
    start_heading: float | None = None


@dataclass(frozen=True, slots=True)
class Telemetry:
    """What the board reports.

    received_at: rig clock, s.  board_time: since its boot, s.  heading: of the field, rad in [-pi, pi).
    elevation: of the field, rad, -pivot * tilt when settled.  currents, measured_currents: A.
    duty: -1..1 of the supply.  supply: V; 0 where it is not sensed but assumed to be nominal.
    good .. stale: the board's counters of received messages.
    """

    received_at: float
    board_time: float
    heading: float
    elevation: float
    currents: Vector
    measured_currents: Vector
    duty: Vector
    supply: float
    state: BoardState
    faults: tuple[str, ...]
    saturated: bool
    supply_assumed: bool
    good: int
    bad: int
    refused: int
    stale: int
    last_refusal: str
    last_sequence: int
    boot_id: int
    configuration_hash: int


def phase(heading: float) -> int:
    """A heading (rad, unwrapped) as uint32, 2^32 = one turn."""
    return round(heading * _PHASE) & 0xFFFFFFFF


def phase_rate(rate: float) -> int:
    """A rate (rad/s) in phase units per ms."""
    return round(rate * _PHASE / 1e3)


def heading_from(phase_: int) -> float:
    """A uint32 phase as a heading in [-pi, pi), rad."""
    return (((phase_ + 0x80000000) & 0xFFFFFFFF) - 0x80000000) / _PHASE


def binary_angle(angle: float) -> int:
    """An angle (rad) with 65536 = one turn."""
    return round(angle * _ANGLE)


def configure_message(configuration: Configuration) -> messages.Configure:
    """The message of a configuration; LinkError when the board would not accept it."""
    _check_configuration(configuration)
    message = messages.Configure(
        current_limits=_scaled(configuration.current_limits, 1e3),
        dead_man=_milliseconds(configuration.dead_man),
        ramp=_milliseconds(configuration.ramp),
        field_slew=round(configuration.field_slew * _SLEW),
        resistances=_scaled(configuration.resistances, 1e3),
        inductances=_scaled(configuration.inductances, 1e5),
        supply=round(configuration.supply * 1e3),
        max_field=round(configuration.max_field * 1e6),
        max_rate=phase_rate(configuration.max_rate),
        max_tilt=binary_angle(configuration.max_tilt),
        sense_gains=_gains(configuration.sense_gains),
        supply_scale=round(configuration.supply_scale * 1e3),
    )
    wrong = "; ".join(objections(message))
    if wrong:
        raise LinkError(f"board configuration: {wrong}")
    return message


def _check_configuration(configuration: Configuration) -> None:
    for name in configuration.__dataclass_fields__:
        value = getattr(configuration, name)
        if name == "sense_gains":
            _check_gains(configuration)
        elif name != "supply_scale":
            _refuse_unless_positive(name, value)
    _refuse_unless_within("max_tilt", configuration.max_tilt, 0.0, MOST_TILT, "rad")
    _refuse_unless_within("supply_scale", configuration.supply_scale, 0.0, MOST_SUPPLY_SCALE, "V")


def _check_gains(configuration: Configuration) -> None:
    low, high = (gain / 256e3 for gain in messages.SENSE_GAINS)
    for coil, gains in enumerate(configuration.sense_gains, start=1):
        for gain in gains:
            _refuse_unless_within(f"sense gain of coil {coil}", gain, low, high, "A per count")


def drive_message(command: DriveCommand, limits: Configuration) -> messages.Drive:
    """The message of a command; LinkError when a value is not finite or outside what the board was told."""
    _check_drive(command, limits)
    start = command.start_heading
    return messages.Drive(
        flags=0 if start is None else messages.ARM,
        pivot=command.pivot,
        rate=phase_rate(command.rate),
        heading_goal=phase(command.heading_goal),
        start_heading=0 if start is None else phase(start),
        tilt=binary_angle(command.tilt),
        field=round(command.field * 1e6),
        allocation=_allocation(command.allocation),
        time_to_live=_milliseconds(command.time_to_live),
    )


def _check_drive(command: DriveCommand, limits: Configuration) -> None:
    if command.pivot not in (1, -1):
        raise LinkError(f"pivot is {command.pivot!r}; it must be 1 (end A) or -1 (end B)")
    _refuse_unless_within("rate", command.rate, -limits.max_rate, limits.max_rate, "rad/s")
    _refuse_unless_within("tilt", command.tilt, 0.0, limits.max_tilt, "rad")
    _refuse_unless_within("field", command.field, 0.0, limits.max_field, "T")
    _refuse_unless_within("time_to_live", command.time_to_live, 1e-3, LONGEST_LIFETIME, "s")
    _refuse_unless_within("heading_goal", command.heading_goal, -1e6, 1e6, "rad")
    if command.start_heading is not None:
        _refuse_unless_within("start_heading", command.start_heading, -1e6, 1e6, "rad")


def _allocation(matrix: Matrix) -> messages.Nine:
    try:
        (a, b, c), (d, e, f), (g, h, i) = matrix
    except (TypeError, ValueError) as error:
        raise LinkError("allocation must have 3 rows of 3 numbers, A/T") from error
    entries = (a, b, c, d, e, f, g, h, i)
    for entry in entries:
        if not -1999.9 <= entry <= 1999.9:
            _refuse_unless_within("allocation entry", entry, -1999.9, 1999.9, "A/T")
    scale = _ALLOCATION
    return (
        *(round(a * scale), round(b * scale), round(c * scale)),
        *(round(d * scale), round(e * scale), round(f * scale)),
        *(round(g * scale), round(h * scale), round(i * scale)),
    )


def _refuse_unless_within(name: str, value: float, low: float, high: float, unit: str) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise LinkError(f"{name} is {value!r} {unit}; allowed is {low:.6g} to {high:.6g} {unit}")


def _refuse_unless_positive(name: str, value: float | Vector) -> None:
    for number in value if isinstance(value, tuple) else (value,):
        if not (math.isfinite(number) and number > 0.0):
            raise LinkError(
                f"board configuration: {name} is {number!r}; it must be a positive number in SI units"
            )


def _milliseconds(duration: float) -> int:
    return int(duration * 1e3 + 1e-6)


def _scaled(values: Vector, scale: float) -> messages.Triple:
    x, y, z = values
    return round(x * scale), round(y * scale), round(z * scale)


def _gains(gains: tuple[Directions, Directions, Directions]) -> messages.Six:
    (a, b), (c, d), (e, f) = ((round(up * 256e3), round(down * 256e3)) for up, down in gains)
    return a, b, c, d, e, f


def telemetry_from(packet: wire.Packet, message: messages.Telemetry, received_at: float) -> Telemetry:
    """The board's report in SI."""
    flags = message.flags
    return Telemetry(
        received_at=received_at,
        board_time=message.time * 1e-3,
        heading=heading_from(message.heading),
        elevation=message.elevation / _ANGLE,
        currents=_si(message.commanded, 1e-3),
        measured_currents=_si(message.measured, 1e-3),
        duty=_si(message.duty, 1.0 / 32768.0),
        supply=message.supply * 1e-3,
        state=_state_name(message.state),
        faults=_FAULTS[flags & 7],
        saturated=bool(flags & messages.Flag.SATURATED),
        supply_assumed=bool(flags & messages.Flag.SUPPLY_ASSUMED),
        good=message.good,
        bad=message.bad,
        refused=message.refused,
        stale=message.stale,
        last_refusal=_REFUSALS.get(message.last_refusal, "unknown"),
        last_sequence=message.last_sequence,
        boot_id=packet.boot_id,
        configuration_hash=message.configuration_hash,
    )


def _state_name(code: int) -> BoardState:
    """An unknown state of a board is one that must not be trusted with current."""
    return _STATES.get(code, BoardState.FAULT)


def _si(values: messages.Triple, scale: float) -> Vector:
    x, y, z = values
    return x * scale, y * scale, z * scale


_STATES: dict[int, BoardState] = {code.value: BoardState(code.name.lower()) for code in messages.BoardCode}
_REFUSALS: dict[int, str] = {code.value: code.name.lower() for code in messages.Refusal}
_FAULT_FLAGS = (messages.Flag.OVER_CURRENT, messages.Flag.DRIVER_FAULT, messages.Flag.SUPPLY_LOW)
_FAULTS = tuple(
    tuple(flag.name.lower() for flag in _FAULT_FLAGS if flag & bits and flag.name) for bits in range(8)
)
