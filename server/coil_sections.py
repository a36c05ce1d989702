"""The rig file's [coils] and [limits]: what the coils are, where they stand, and what they may do."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from server.section import Positive, Section

PerCoil = Annotated[list[Annotated[float, Field(gt=0.0, le=30.0)]], Field(min_length=3, max_length=3)]
"""A VNH5019 carries 30 A for a moment and 12 A for long."""

SenseGain = Annotated[float, Field(ge=17.5, le=43.5)]
"""The driver's 34.88 mA per count of the UNO's ADC is known to be off by up to 25 %."""


class Coil(Section):
    diameter_mm: Positive
    separation_mm: Positive
    turns: Annotated[int, Field(gt=0)]
    resistance_ohm: Positive
    inductance_mH: Positive
    sense_mA_per_count: tuple[SenseGain, SenseGain] = (34.88, 34.88)
    """Of the bridge's current sense, for positive and for negative current."""
    field_gain: Annotated[float, Field(ge=0.2, le=5.0)] = 1.0
    """Measured field over the geometry's, from `pivotrig calibrate coils`."""


class RegistrationSection(Section):
    """Where the coils stand in the camera's workspace, from `pivotrig calibrate registration`."""

    x_mm: Annotated[float, Field(ge=-200.0, le=200.0)] = 0.0
    """The coils' centre."""
    y_mm: Annotated[float, Field(ge=-200.0, le=200.0)] = 0.0
    rotation_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    """From the workspace's x axis to that of the x coils, counter-clockwise."""
    magnet_reversed: bool = False
    """The magnet's north is at end B."""


class Coils(Section):
    """Outer diameters and separations are the paper's; turns, resistances and inductances are assumed."""

    x: Coil = Coil(diameter_mm=390, separation_mm=240, turns=314, resistance_ohm=2.5, inductance_mH=125)
    y: Coil = Coil(diameter_mm=305, separation_mm=190, turns=248, resistance_ohm=2.0, inductance_mH=55)
    z: Coil = Coil(diameter_mm=225, separation_mm=110, turns=154, resistance_ohm=1.5, inductance_mH=14)
    supply_V: Annotated[float, Field(gt=0.0, le=60.0)] = 24.0
    supply_full_scale_V: Annotated[float, Field(ge=0.0, le=65.0)] = 55.0
    """The supply that fills the board's ADC: 5 V times the divider on A5; 0 where none is wired."""
    allocation: Literal["local", "centre"] = "local"
    """local: field and tilt hold over the whole plate; centre: the paper's, exact at the centre only."""
    field_source: Annotated[str, Field(max_length=120)] = "geometry"
    """Where the field gains come from: the geometry, or the date and the residual of a measurement."""
    registration: RegistrationSection = RegistrationSection()


class LimitsSection(Section):
    """What one coil, all of them, the robot and its field may do; what is heard of them is held against it."""

    current_A: PerCoil = Field(default=[8.0, 8.0, 8.0])
    power_W: Annotated[float, Field(gt=0.0, le=10_000.0)] = 300.0
    """Heat of all coils together: what a 24 V supply of 12.5 A gives (assumed)."""
    current_slew_A_s: Annotated[
        list[Annotated[float, Field(gt=0.0, le=1e6)]], Field(min_length=3, max_length=3)
    ] = Field(default=[192.0, 436.0, 1714.0])
    """V / L of each coil at 24 V: no bridge of that supply changes its current faster."""
    continuous_A: PerCoil = Field(default=[9.0, 7.9, 6.1])
    """What each coil bears for ever, 40 K above the room; estimated from its size and wire."""
    heat_time_constant_s: Annotated[
        list[Annotated[float, Field(ge=1.0, le=1e6)]], Field(min_length=3, max_length=3)
    ] = Field(default=[2700.0, 2100.0, 1300.0])
    field_mT: Annotated[float, Field(gt=0.0, le=50.0)] = 15.0
    rate_deg_s: Annotated[float, Field(gt=0.0, le=3600.0)] = 360.0
    workspace_mm: Annotated[float, Field(gt=0.0, le=1000.0)] = 120.0
    soft_margin_mm: Annotated[float, Field(ge=0.0, le=100.0)] = 2.0
    """How far outside the workspace the robot's centre may be driven."""
    hard_margin_mm: Annotated[float, Field(ge=0.0, le=100.0)] = 8.0
    """How far outside the workspace the coils are switched off."""

    @model_validator(mode="after")
    def _margins_are_ordered(self) -> LimitsSection:
        if self.soft_margin_mm > self.hard_margin_mm:
            raise ValueError(
                f"soft_margin_mm ({self.soft_margin_mm}) must not exceed hard_margin_mm ({self.hard_margin_mm})"
            )
        return self
