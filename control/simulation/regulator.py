"""The board's current regulator for one coil at 1 kHz, in the integers that the firmware uses.

The driver's current sense is unsigned and coarse, so the current is observed: the coil's model
L di/dt + R i = v runs along and is pulled into the interval that the sensed magnitude allows.  The observed
current is regulated by feed-forward (R i* + L di*/dt) plus PI; the PWM step that remains is carried over
to the next millisecond (error feedback), so 100 steps regulate as finely as 800.

Unless a name says otherwise: currents in mA, voltages in mV, `>>` rounds towards minus infinity.
"""

from __future__ import annotations

SENSE_GAIN = 8929
"""mA per ADC count, Q8: 5 V / 1024 / (0.14 V/A) = 34.88 mA (VNH5019 with the UNO's 5 V reference)."""

FULL_COUNT = 1023
INTEGRAL_LIMIT = 6000 << 10
"""Q10 mV: covers 25 % of 24 V, a copper winding that is 60 K warmer than when it was measured."""


class Regulator:
    """Observer, PI and PWM dither of one coil; `steps` is the PWM resolution of its timer."""

    __slots__ = (
        "_current",
        "_dither",
        "_feed",
        "_gain",
        "_integral",
        "_lead",
        "_limit",
        "_model",
        "_reciprocal",
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
        self.rest()

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
        self._volts = (supply << 8) // self._steps
        self._reciprocal = (self._steps << 16) // trusted
        self._limit = trusted

    def rest(self) -> None:
        """Bridge off: forget target, integral and remainder, but not the current that still flows."""
        self._target = self._integral = self._dither = self._voltage = 0

    @property
    def sign(self) -> int:
        return -1 if self._current < 0 else 1

    def observe(self, counts: int) -> None:
        """One millisecond of the coil's model, then half of the way into the sensed interval (Q8 mA)."""
        current = self._current
        current += ((self._voltage - (((current >> 6) * self._feed) >> 12)) * self._model) >> 8
        low = counts * SENSE_GAIN
        if current >= 0:
            if current < low:
                current += (low - current) >> 1
            elif current > low + SENSE_GAIN:
                current -= (current - low - SENSE_GAIN) >> 1
        elif -current < low:
            current -= (low + current) >> 1
        elif -current > low + SENSE_GAIN:
            current += (-current - low - SENSE_GAIN) >> 1
        self._current = current

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
