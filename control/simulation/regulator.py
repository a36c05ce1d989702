"""The board's current regulator for one coil at 1 kHz, in the integers that the firmware uses.

The driver's current sense is unsigned and coarse, so the current is observed: the coil's model
L di/dt + R i = v runs along and is pulled into the interval that the sensed magnitude allows.  The observed
current is regulated by feed-forward (R i* + L di*/dt) plus PI; the PWM step that remains is carried over
to the next millisecond (error feedback), so 100 steps regulate as finely as 800.

Unless a name says otherwise: currents in mA, voltages in mV, `>>` rounds towards minus infinity.
"""

from __future__ import annotations

from control.link.messages import SENSE_GAIN

FULL_COUNT = 1023
MOST_SENSED = 32767
"""mA: a full reading is up to 44.6 A, and what travels has 16 bits."""

INTEGRAL_LIMIT = 6000 << 10
"""Q10 mV: covers 25 % of 24 V, a copper winding that is 60 K warmer than when it was measured."""


class Regulator:
    """Observer, PI and PWM dither of one coil; `steps` is the PWM resolution of its timer."""

    __slots__ = (
        "_current",
        "_dither",
        "_feed",
        "_forward_gain",
        "_gain",
        "_integral",
        "_lead",
        "_limit",
        "_model",
        "_reciprocal",
        "_reverse_gain",
        "_steps",
        "_target",
        "_voltage",
        "_volts",
    )

    def __init__(self, steps: int) -> None:
        self._steps = steps
        self._model = self._gain = self._feed = self._lead = 0
        self._volts = self._reciprocal = self._limit = 0
        self._current = 0
        self._forward_gain = self._reverse_gain = SENSE_GAIN
        self.rest()

    def sense_with(self, forward: int, reverse: int) -> None:
        """Gains of the current sense for positive and negative current, Q8 mA per count."""
        self._forward_gain = forward
        self._reverse_gain = reverse

    def configure(self, resistance: int, inductance: int) -> None:
        """Constants of the coil: mOhm, 10 uH.

        The model's gain uses L + R * 0.5 ms, which makes its 1 ms step agree with the exact exponential to
        second order.  The proportional gain is L / 5 ms: the closed loop's time constant.
        """
        self._feed = (resistance << 10) // 1000
        self._model = 6553600 // (inductance + resistance // 20)
        self._gain = (inductance * 131) >> 8
        self._lead = (inductance * 164) >> 8

    def supply_is(self, supply: int, nominal: int) -> None:
        """Takes over a measured supply (mV); a weak one raises the duty to twice the nominal at most."""
        trusted = max(supply, nominal >> 1)
        self._volts = (supply * ((1 << 21) // self._steps)) >> 13
        self._reciprocal = (self._steps << 16) // trusted
        self._limit = trusted

    def rest(self) -> None:
        """Bridge off: forget target, integral and remainder, but not the current that still flows."""
        self._target = self._integral = self._dither = self._voltage = 0

    @property
    def flows_backwards(self) -> bool:
        """Whether the observed current is negative."""
        return self._current < 0

    def sensed(self, counts: int) -> int:
        """A reading as a current with the observer's sign, mA, within 16 bits."""
        if self.flows_backwards:
            return -min(MOST_SENSED, (counts * self._reverse_gain) >> 8)
        return min(MOST_SENSED, (counts * self._forward_gain) >> 8)

    def observe(self, counts: int) -> None:
        """One millisecond of the coil's model, then half of the way into the sensed interval (Q8 mA)."""
        current = self._current
        current += ((self._voltage - (((current >> 6) * self._feed) >> 12)) * self._model) >> 8
        if current >= 0:
            self._current = _within(current, counts, self._forward_gain)
        else:
            self._current = -_within(-current, counts, self._reverse_gain)

    def regulate(self, target: int) -> int:
        """Signed PWM steps for the next millisecond, for a target current in mA."""
        product = ((target << 2) - (self._current >> 6)) * self._gain
        voltage = (
            ((target * self._feed) >> 10)
            + (((target - self._target) * self._lead) >> 6)
            + ((product + self._integral) >> 10)
        )
        self._target = target
        limit = self._limit
        if -limit <= voltage <= limit:
            integral = self._integral + (product >> 5)
            if -INTEGRAL_LIMIT <= integral <= INTEGRAL_LIMIT:
                self._integral = integral
        else:
            voltage = limit if voltage > 0 else -limit
        duty = ((voltage * self._reciprocal) >> 8) + self._dither
        self._dither = duty & 255
        steps = duty >> 8
        self._voltage = (steps * self._volts) >> 8
        return steps


def _within(magnitude: int, counts: int, gain: int) -> int:
    """Half of the way from an observed magnitude into the interval of the reading, both Q8 mA."""
    low = counts * gain
    if magnitude < low:
        return magnitude + ((low - magnitude) >> 1)
    if magnitude > low + gain:
        return magnitude - ((magnitude - low - gain) >> 1)
    return magnitude
