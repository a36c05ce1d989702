"""What the board accepts as its configuration: for the host, which asks first, and for the board, which refuses."""

from __future__ import annotations

from collections.abc import Iterator

from control.link.messages import SENSE_GAINS, Configure

CONFIGURATION_LIMITS = {
    "current_limits": (1, 12000),
    "dead_man": (10, 500),
    "ramp": (1, 1000),
    "field_slew": (1, 65535),
    "resistances": (100, 10000),
    "inductances": (300, 16000),
    "supply": (5000, 50000),
    "max_field": (1, 32767),
    "max_rate": (1, 0x0FFFFFFF),
    "max_tilt": (1, 10923),
    "sense_gains": SENSE_GAINS,
    "supply_scale": (0, 65000),
}
"""Allowed configuration: within these no intermediate of the arithmetic leaves 32 bits."""

_IN_WORDS = {
    "current_limits": ("current limit", 1e-3, "A"),
    "dead_man": ("dead-man time", 1.0, "ms"),
    "ramp": ("elevation ramp", 1.0, "ms"),
    "field_slew": ("rate of the field's strength", 1e-3 * 1e3 / 256, "mT/s"),
    "resistances": ("resistance", 1e-3, "ohm"),
    "inductances": ("inductance", 1e-2, "mH"),
    "supply": ("supply", 1e-3, "V"),
    "max_field": ("largest field", 1e-3, "mT"),
    "max_rate": ("fastest turn", 360e3 / 2**32, "deg/s"),
    "max_tilt": ("steepest field", 360 / 2**16, "deg"),
    "sense_gains": ("current sense", 1.0 / 256, "mA per count"),
    "supply_scale": ("full scale of the supply's divider", 1e-3, "V"),
}
"""Name, and what one of the wire's units is in a lab's."""


def objections(configure: Configure) -> Iterator[str]:
    """What the board would not accept, and what it would: within the ranges, and no coil faster than L/R = 5 ms,
    which a 1 kHz loop could not regulate."""
    for name, limits in CONFIGURATION_LIMITS.items():
        value = getattr(configure, name)
        if isinstance(value, tuple):
            for number, entry in enumerate(value):
                yield from _outside(name, entry, limits, f" of coil {1 + 3 * number // len(value)}")
        else:
            yield from _outside(name, value, limits)
    coils = zip(configure.resistances, configure.inductances, strict=True)
    for coil, (resistance, inductance) in enumerate(coils, start=1):
        if not 2 * inductance >= resistance:
            time = 10.0 * inductance / resistance
            yield f"coil {coil} with L/R = {time:.3g} ms; the board regulates 5 ms and more"


def _outside(name: str, number: int, limits: tuple[int, int], of: str = "") -> Iterator[str]:
    low, high = limits
    if not low <= number <= high:
        words, scale, unit = _IN_WORDS[name]
        allowed = f"{low * scale:.4g} to {high * scale:.4g} {unit}"
        yield f"{words}{of} of {number * scale:.4g} {unit}; the board takes {allowed}"
