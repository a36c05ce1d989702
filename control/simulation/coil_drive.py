"""From the field that is commanded to the PWM of three bridges, in the board's integers.

Field in uT, currents in mA, supply in mV; the allocation is Q14 mA/uT, a row a coil.
"""

from __future__ import annotations

from control.link import messages
from control.simulation.fixed_point import ANGLE_MASK, QUARTER_TURN, SINE
from control.simulation.motion import FieldMotion
from control.simulation.regulator import FULL_COUNT, Regulator

PWM_STEPS = (800, 800, 100)
"""Timer1 counts to 800 for coils 1 and 2, Timer2 to 100 for coil 3, both at 20 kHz."""

OVER_CURRENT_TICKS = 3
DUTY_SCALE = tuple((32768 << 7) // steps for steps in PWM_STEPS)
_ZERO: messages.Triple = (0, 0, 0)


class CoilDrive:
    """duty: signed PWM steps.  commanded: mA.  saturated: the currents were scaled back to a limit.

    supply: as it is sensed, mV; 0 where it is not.
    """

    __slots__ = (
        "_allocation",
        "_counts",
        "_limits",
        "_nominal",
        "_over_current",
        "_regulators",
        "_scale",
        "_settled_supply",
        "_trips",
        "commanded",
        "duty",
        "saturated",
        "supply",
        "supply_low",
    )

    def __init__(self) -> None:
        x, y, z = PWM_STEPS
        self._regulators = (Regulator(x), Regulator(y), Regulator(z))
        self._allocation = (0,) * 9
        self._limits = self._counts = _ZERO
        self._trips: messages.Six = (
            *(FULL_COUNT, FULL_COUNT),
            *(FULL_COUNT, FULL_COUNT),
            *(FULL_COUNT, FULL_COUNT),
        )
        self._nominal = self._scale = self.supply = 0
        self._settled_supply = -1
        self.supply_low = False
        self.rest()

    def configure(self, message: messages.Configure) -> None:
        self._limits = message.current_limits
        x, y, z = message.current_limits
        a, b, c, d, e, f = message.sense_gains
        self._trips = (
            *(_trip_count(x, a), _trip_count(x, b)),
            *(_trip_count(y, c), _trip_count(y, d)),
            *(_trip_count(z, e), _trip_count(z, f)),
        )
        constants = zip(
            self._regulators, message.resistances, message.inductances, ((a, b), (c, d), (e, f)), strict=True
        )
        for regulator, resistance, inductance, (forward, reverse) in constants:
            regulator.configure(resistance, inductance)
            regulator.sense_with(forward, reverse)
        self._nominal = message.supply
        self._scale = message.supply_scale
        self._settled_supply = -1

    def allocate(self, allocation: messages.Nine) -> None:
        self._allocation = allocation

    def rest(self) -> None:
        """All bridges off."""
        self.duty = self.commanded = _ZERO
        self.saturated = False
        self._over_current = 0
        for regulator in self._regulators:
            regulator.rest()

    @property
    def supply_assumed(self) -> bool:
        """Nothing senses the supply, which is taken to be what it should be."""
        return self._scale == 0

    def sense(self, counts: messages.Triple, supply_count: int) -> None:
        """Takes in what the ADC reads in this millisecond."""
        self._counts = counts
        self.supply = (supply_count * self._scale) >> 10
        self.supply_low = self._scale != 0 and self.supply < (self._nominal * 3) >> 2

    def coast(self) -> None:
        """One millisecond without drive: the observers follow the currents that decay."""
        for regulator, count in zip(self._regulators, self._counts, strict=True):
            regulator.observe(count)

    def is_over_current(self) -> bool:
        """Whether a coil has been sensed above 1.25 times its limit for 3 ms; to be asked once a tick."""
        r1, r2, r3 = self._regulators
        c1, c2, c3 = self._counts
        trips = self._trips
        if (
            c1 > trips[r1.flows_backwards]
            or c2 > trips[2 + r2.flows_backwards]
            or c3 > trips[4 + r3.flows_backwards]
        ):
            self._over_current += 1
        else:
            self._over_current = 0
        return self._over_current >= OVER_CURRENT_TICKS

    def advance(self, motion: FieldMotion) -> None:
        """One millisecond of regulation towards the field of `motion`."""
        supply = self.supply if self._scale else self._nominal
        if supply != self._settled_supply:
            self._settle_supply(supply)
        counts = self._counts
        t1, t2, t3 = self._targets(motion)
        r1, r2, r3 = self._regulators
        r1.observe(counts[0])
        r2.observe(counts[1])
        r3.observe(counts[2])
        self.duty = r1.regulate(t1), r2.regulate(t2), r3.regulate(t3)

    def _targets(self, motion: FieldMotion) -> messages.Triple:
        """Currents for B = |B| [cos e cos phi, cos e sin phi, sin e] with phi = heading + 90 deg."""
        heading = motion.heading >> 16
        elevation = motion.elevation >> 16
        field = motion.magnitude >> 8
        level = (field * SINE[(elevation + QUARTER_TURN) & ANGLE_MASK] + 16384) >> 15
        x = (16384 - level * SINE[heading]) >> 15
        y = (level * SINE[(heading + QUARTER_TURN) & ANGLE_MASK] + 16384) >> 15
        z = (field * SINE[elevation & ANGLE_MASK] + 16384) >> 15
        a, b, c, d, e, f, g, h, k = self._allocation
        i1 = (a * x + b * y + c * z + 8192) >> 14
        i2 = (d * x + e * y + f * z + 8192) >> 14
        i3 = (g * x + h * y + k * z + 8192) >> 14
        l1, l2, l3 = self._limits
        if -l1 <= i1 <= l1 and -l2 <= i2 <= l2 and -l3 <= i3 <= l3:
            self.saturated = False
            self.commanded = i1, i2, i3
        else:
            self.saturated = True
            self.commanded = self._scaled_back((i1, i2, i3))
        return self.commanded

    def _scaled_back(self, currents: messages.Triple) -> messages.Triple:
        """All three by the same factor (Q14), so that the direction of the field stays.

        The quotient is of halves, which have 16 bits, and rounded towards the smaller factor.
        """
        factor = 1 << 14
        for current, limit in zip(currents, self._limits, strict=True):
            if abs(current) > limit:
                factor = min(factor, ((limit >> 1) << 14) // ((abs(current) + 1) >> 1))
        i1, i2, i3 = currents
        return (i1 * factor) >> 14, (i2 * factor) >> 14, (i3 * factor) >> 14

    def _settle_supply(self, supply: int) -> None:
        self._settled_supply = supply
        for regulator in self._regulators:
            regulator.supply_is(supply, self._nominal)

    def measured(self) -> messages.Triple:
        """Sensed magnitudes with the observers' signs, mA."""
        x, y, z = (r.sensed(count) for r, count in zip(self._regulators, self._counts, strict=True))
        return x, y, z

    def duty_q15(self) -> messages.Triple:
        """The duty registers as a fraction of full drive, Q15."""
        x, y, z = ((d * s) >> 7 for d, s in zip(self.duty, DUTY_SCALE, strict=True))
        return x, y, z


def _trip_count(limit: int, gain: int) -> int:
    """ADC counts at 1.25 times a limit in mA: 860 at most, so that a sense at full scale trips as well."""
    return (limit * 320) // gain
