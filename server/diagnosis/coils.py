"""The coils on paper: can they make every direction of field, and can bridges and supply drive them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from control.axes import AXES
from control.coil_heat import WARN_AT
from control.coils import WORST_CONDITION, CoilSet
from control.gait import Gait
from control.link.conversion import LinkError, configure_message
from server.diagnosis.check import Check, ok, problem, warning
from server.settings import RigFile
from server.settings_in_si import board_configuration, coil_set

GRID = 9
"""Places along each side of the workspace at which the field is looked at."""
USUAL = Gait()
"""Its field and tilt are what nearly everybody walks with."""
SHORTEST_WARMING, LONGEST_WARMING = 60.0, 20_000.0
"""Thermal time constants that a coil of this size may have, s: a kilogram of copper in still air takes 1000 to 3000."""
DROP = 0.9
"""Of the supply that reaches a coil at full duty: the bridge's 38 mohm, and the leads."""
LASTING_CURRENT = 12.0
"""What a VNH5019 carries for long without a heat sink, A (Pololu's data)."""


def examine(settings: RigFile) -> Iterator[Check]:
    try:
        coils = coil_set(settings)
    except ValueError as error:
        yield problem("coils", str(error), "correct [coils] in the rig file")
        return
    yield condition(coils)
    yield field(coils, settings)
    yield supply(settings)
    yield heat(coils, settings)
    yield board_ranges(settings)


def places(coils: CoilSet) -> list[tuple[float, float]]:
    steps = np.linspace(-coils.workspace, coils.workspace, GRID)
    return [(float(x), float(y)) for x in steps for y in steps]


def condition(coils: CoilSet) -> Check:
    worst = max(float(np.linalg.cond(np.array(coils.per_ampere(x, y)))) for x, y in places(coils))
    found = (
        f"worst condition number of the field per ampere {worst:.2f}, up to {WORST_CONDITION:g} is allowed"
    )
    if not worst <= 0.5 * WORST_CONDITION:
        return warning(
            "coils", found, "check diameters, separations and turns: one direction is hard to make"
        )
    return ok("coils", found)


def field(coils: CoilSet, settings: RigFile) -> Check:
    """The strongest field that may turn all the way round, tilted as usual, at every place."""
    strongest = min(strongest_at(coils, place, settings.limits.current_A) for place in places(coils))
    tilt = f"{math.degrees(USUAL.tilt):.0f}°"
    found = f"up to {strongest * 1e3:.1f} mT at a tilt of {tilt}, all the way round, everywhere"
    if not strongest >= USUAL.field:
        advice = f"the usual {USUAL.field * 1e3:.0f} mT will saturate: walk with less, or raise the limits"
        return warning("field", found, advice)
    return ok("field", found)


def strongest_at(coils: CoilSet, place: tuple[float, float], limits: Sequence[float]) -> float:
    """T. Of all headings the worst one counts, for each coil by itself."""
    level = math.cos(USUAL.tilt), math.cos(USUAL.tilt), 0.0
    upright = 0.0, 0.0, math.sin(USUAL.tilt)
    needs = [
        np.linalg.norm(np.multiply(row, level)) + abs(np.dot(row, upright))
        for row in coils.local_allocation(*place)
    ]
    return float(min(limit / need for limit, need in zip(limits, needs, strict=True)))


def supply(settings: RigFile) -> Check:
    """Ohm's law at the current limit, for each coil."""
    limits = settings.limits.current_A
    usable = DROP * settings.coils.supply_V
    resistances = [coil.resistance_ohm for coil in (settings.coils.x, settings.coils.y, settings.coils.z)]
    needs = {
        axis: limit * resistance for axis, limit, resistance in zip(AXES, limits, resistances, strict=True)
    }
    found = ", ".join(f"{axis} {volts:.1f} V" for axis, volts in needs.items())
    found = f"the current limits need {found}; the supply gives {usable:.1f} V at full duty"
    beyond = [axis for axis, volts in needs.items() if not volts <= usable]
    if beyond:
        return warning(
            "supply",
            found,
            f"a higher supply or lower limits.current_A for {', '.join(beyond)}: it will saturate",
        )
    if max(limits) > LASTING_CURRENT:
        return warning(
            "supply", found, f"a VNH5019 carries {LASTING_CURRENT:g} A for long: lower limits.current_A"
        )
    return ok("supply", found)


def heat(coils: CoilSet, settings: RigFile) -> Check:
    """What the usual walk, gone on for ever in all headings, makes of the coils' heat."""
    loads = [
        (current / bears) ** 2
        for current, bears in zip(usual_currents(coils), settings.limits.continuous_A, strict=True)
    ]
    found = ", ".join(f"{axis} {load:.0%}" for axis, load in zip(AXES, loads, strict=True))
    found = f"the usual walk, for ever: {found} of the heat that the coils bear"
    constants = settings.limits.heat_time_constant_s
    if not all(SHORTEST_WARMING <= constant <= LONGEST_WARMING for constant in constants):
        return warning(
            "coil heat", found, f"check limits.heat_time_constant_s: {constants} s is no such coil's"
        )
    if not max(loads) < WARN_AT:
        return warning("coil heat", found, "walk with less field or with pauses; the rig holds at 100 %")
    return ok("coil heat", found)


def usual_currents(coils: CoilSet) -> list[float]:
    """Root mean square of each coil's current over all headings at the centre, A."""
    level, upright = USUAL.field * math.cos(USUAL.tilt), USUAL.field * math.sin(USUAL.tilt)
    return [
        math.hypot(math.hypot(x, y) * level / math.sqrt(2.0), z * upright)
        for x, y, z in coils.local_allocation(0, 0)
    ]


def board_ranges(settings: RigFile) -> Check:
    """Whether the board's integers can hold this rig's limits and constants."""
    try:
        configure_message(board_configuration(settings))
    except LinkError as error:
        return problem("board settings", str(error), "correct [coils], [limits] or [link] in the rig file")
    return ok("board settings", "limits and coil constants can be told to the board")
