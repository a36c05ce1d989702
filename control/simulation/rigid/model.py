"""The rigid robot as a MuJoCo model, in millimetres, grams and seconds: forces come in uN, torques in nN m.

Assumed of the body: a bar as long as its feet are apart, of even density, 2 mm wide and 1 mm high, whose ends stand
on two balls each (line feet: it can pitch, yaw and slide, but not roll).
"""

from __future__ import annotations

import math

from control.simulation.rigid.parameters import GRAVITY, NOMINAL_FIELD, RigidParameters

PER_METRE = 1e3
"""mm in 1 m."""
MILLIGRAM = 1e-3
"""g."""
SUBSTEP = 2e-4
"""MuJoCo's time step, s."""
BALL = 0.1
"""Radius of the balls that the feet are, mm."""
BAR_WIDTH, BAR_HEIGHT = 2.0, 1.0
"""Of the body, mm (assumed; they decide its inertia)."""
CENTRE_HEIGHT = 0.5
"""Of the body's centre above the plate, mm (assumed)."""

ADHESION_RANGE = 0.02
"""How far adhesion reaches, mm (assumed). MuJoCo lets a foot that slides rise by some um, which must not free it."""

FEET = ("a_back", "a_front", "b_back", "b_front")
"""The four balls: ends A and B; back and front, seen in the walking direction."""

TORQUE_UNIT = 1e9
"""g mm^2/s^2 in 1 N m."""
FORCE_UNIT = 1e6
"""g mm/s^2 in 1 N."""


def rotational_damping(parameters: RigidParameters, length: float) -> float:
    """g mm^2/s, the same about all axes: 2 zeta sqrt(I m B), of swinging freely about the nominal field.

    length: between the feet, m. About a foot the body is four times as inert, and damped half as much.
    """
    inertia = bar_inertia(parameters.mass_mg * MILLIGRAM, length * PER_METRE)[2]
    stiffness = _moment(parameters) * NOMINAL_FIELD
    return 2.0 * (parameters.damping_percent / 100.0) * math.sqrt(inertia * stiffness)


def _moment(parameters: RigidParameters) -> float:
    """nN m/T."""
    return parameters.moment_mA_m2 * 1e-3 * TORQUE_UNIT


def balls(parameters: RigidParameters, length: float) -> list[tuple[float, float, float]]:
    """Where the four balls are on the body, mm, in the order of `FEET`. length: between the feet, m."""
    across, along = 0.5 * parameters.foot_width_mm, 0.5 * length * PER_METRE
    return [(side, end, BALL - CENTRE_HEIGHT) for end in (along, -along) for side in (-across, across)]


def bar_inertia(mass: float, length: float) -> tuple[float, float, float]:
    """About x (across), y (along) and z (up), g mm^2, for a mass in g and a length in mm."""
    x, y, z = BAR_WIDTH**2, length**2, BAR_HEIGHT**2
    return mass * (y + z) / 12.0, mass * (x + z) / 12.0, mass * (x + y) / 12.0


def model_xml(parameters: RigidParameters, length: float) -> str:
    """length: between the feet, m.

    The magnet is two opposite charges at the feet's distance, so that the field's forces on them add up to the
    torque m x B exactly, at the attitude of each moment; a charge is the moment over the distance. MuJoCo must not
    reset by itself: a body whose motion cannot be computed would go on from the origin.
    """
    mass, length = parameters.mass_mg * MILLIGRAM, length * PER_METRE
    inertia = " ".join(f"{value!r}" for value in bar_inertia(mass, length))
    charge = _moment(parameters) / length
    return f"""
<mujoco model="pivot walker">
  <option timestep="{SUBSTEP}" integrator="implicitfast" solver="Newton" cone="elliptic" impratio="10"
          jacobian="dense" gravity="0 0 -{GRAVITY * PER_METRE}">
    <flag autoreset="disable"/>
  </option>
  <worldbody>
    <geom name="plate" type="plane" size="100 100 1" contype="0" conaffinity="0"/>
    <site name="world"/>
    <body name="robot" pos="0 0 {CENTRE_HEIGHT}">
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia}"/>
      <site name="north" pos="0 {0.5 * length!r} 0"/>
      <site name="south" pos="0 {-0.5 * length!r} 0"/>
      {_foot("a", 0.5 * length, parameters.foot_width_mm)}
      {_foot("b", -0.5 * length, parameters.foot_width_mm)}
    </body>
  </worldbody>
  <contact>
    {"".join(_pair(name, parameters.friction) for name in FEET)}
  </contact>
  <actuator>
    {_charge("north", charge)}
    {_charge("south", -charge)}
    {_adhesion("a", parameters.adhesion_mN)}
    {_adhesion("b", parameters.adhesion_mN)}
  </actuator>
</mujoco>"""


def _foot(end: str, along: float, width: float) -> str:
    balls = "".join(
        f'<geom name="{end}_{side}" type="sphere" size="{BALL}" pos="{across!r} 0 0" mass="0"'
        ' contype="0" conaffinity="0"/>'
        for side, across in (("back", -0.5 * width), ("front", 0.5 * width))
    )
    return f'<body name="foot_{end}" pos="0 {along!r} {BALL - CENTRE_HEIGHT!r}">{balls}</body>'


def _pair(foot: str, friction: float) -> str:
    return (
        f'<pair geom1="plate" geom2="{foot}" condim="3" solref="0.001 1" gap="{ADHESION_RANGE}"'
        f' friction="{friction} {friction} 0 0 0"/>'
    )


def _charge(site: str, charge: float) -> str:
    """Three forces along the world's axes, for the field in T."""
    gears = (f"{charge!r} 0 0 0 0 0", f"0 {charge!r} 0 0 0 0", f"0 0 {charge!r} 0 0 0")
    return "".join(f'<general site="{site}" refsite="world" gear="{gear}"/>' for gear in gears)


def _adhesion(end: str, force_mN: float) -> str:
    return f'<adhesion body="foot_{end}" ctrlrange="0 1" gain="{force_mN * 1e-3 * FORCE_UNIT!r}"/>'
