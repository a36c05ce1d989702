"""What the rigid robot is made of, in the lab's units, and the one number that decides its gait: Lambda."""

from __future__ import annotations

import math

from pydantic import Field

from control.registry import Parameters

GRAVITY = 9.81
"""m/s^2."""
NOMINAL_FIELD = 10e-3
"""The paper's field, T; what Lambda is quoted at."""
MILLI = 1e-3
MILLIGRAM = 1e-6
"""kg."""


class RigidParameters(Parameters):
    """The plausible robot; nothing of it was measured on the paper's.

    A magnet of diameter 1 mm, length 2 mm and grade N52 has the moment (its volume times 1.45 T / mu_0).
    """

    moment_mA_m2: float = Field(
        default=1.8,
        gt=0.0,
        le=100.0,
        title="Magnetic moment",
        description="Of the magnet along the body, its north at end A.",
        json_schema_extra={"unit": "mA·m²"},
    )
    mass_mg: float = Field(
        default=79.0,
        ge=1.0,
        le=10_000.0,
        title="Mass",
        description="Of the whole robot, with the magnet.",
        json_schema_extra={"unit": "mg"},
    )
    adhesion_mN: float = Field(
        default=0.3,
        ge=0.0,
        le=100.0,
        title="Adhesion",
        description="Force that holds each end on the plate while it touches.",
        json_schema_extra={"unit": "mN"},
    )
    friction: float = Field(
        default=0.4,
        gt=0.0,
        le=5.0,
        title="Friction",
        description="Mean Coulomb coefficient between the feet and the plate.",
    )
    friction_scatter_percent: float = Field(
        default=20.0,
        ge=0.0,
        le=100.0,
        title="Uneven friction",
        description="Standard deviation of the coefficient from patch to patch of the plate, of its mean.",
        json_schema_extra={"unit": "%"},
    )
    patch_mm: float = Field(
        default=1.0,
        ge=0.05,
        le=50.0,
        title="Size of a patch",
        description="Side of the squares of the plate that have one friction each; the seed draws them.",
        json_schema_extra={"unit": "mm"},
    )
    foot_width_mm: float = Field(
        default=2.0,
        gt=0.2,
        le=20.0,
        title="Width of a foot",
        description="Distance between the two balls that each end stands on, across the body.",
        json_schema_extra={"unit": "mm"},
    )
    damping_percent: float = Field(
        default=10.0,
        gt=0.0,
        le=500.0,
        title="Damping",
        description="Of the body's swinging about the field, of the critical one.",
        json_schema_extra={"unit": "%"},
    )

    def magnetic_ratio(self, length: float, field: float = NOMINAL_FIELD) -> float:
        """Lambda = m B / (W L / 2 + F L): the magnet's torque over what it takes to lift one end.

        length: between the ends, m.  field: T.
        """
        weight = self.mass_mg * MILLIGRAM * GRAVITY
        holding = length * (0.5 * weight + self.adhesion_mN * MILLI)
        return self.moment_mA_m2 * MILLI * field / holding

    def lifting_elevation(self, length: float, field: float = NOMINAL_FIELD) -> float:
        """Elevation of the field from which the free end lifts, Lambda sin a = 1, rad; infinite if it never does."""
        ratio = self.magnetic_ratio(length, field)
        return math.asin(1.0 / ratio) if ratio > 1.0 else math.inf

    def with_magnetic_ratio(self, ratio: float, length: float) -> RigidParameters:
        """The same robot with the magnet that gives it this Lambda at the nominal field. length: m."""
        moment = self.moment_mA_m2 * ratio / self.magnetic_ratio(length)
        return RigidParameters.model_validate({**self.model_dump(), "moment_mA_m2": moment})
