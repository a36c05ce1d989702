"""MuJoCo's model and data of one rigid robot, as arrays."""

from __future__ import annotations

import logging
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from control.simulation.rigid.model import model_xml, rotational_damping
from control.simulation.rigid.parameters import RigidParameters
from control.snapshot import Vector

_mujoco: Any = mujoco
"""The bindings are compiled and bring no types."""
_mujoco.set_mju_user_warning(
    logging.getLogger(__name__).warning
)  # else it writes files where the program was started
_FIELDS = 6
"""Controls that are a field: three for each of the magnet's charges; the others are the feet's adhesion."""

Floats = NDArray[np.float64]


class Engine:
    """One body. state: position (mm) and unit quaternion.  speed: mm/s in the world, rad/s about the body's axes.

    friction: (4, 5), of the four balls; the first two columns are Coulomb's.  length: between the feet, m.
    """

    def __init__(self, parameters: RigidParameters, length: float) -> None:
        self.model: Any = _mujoco.MjModel.from_xml_string(model_xml(parameters, length))
        self.model.dof_damping[3:6] = rotational_damping(parameters, length)
        self.data: Any = _mujoco.MjData(self.model)
        self.state: Floats = self.data.qpos
        self.speed: Floats = self.data.qvel
        self.friction: Floats = self.model.pair_friction
        self._control: Floats = self.data.ctrl

    def reset(self) -> None:
        """Time and everything that the engine remembers from before; the feet adhere, there is no field."""
        _mujoco.mj_resetData(self.model, self.data)
        self._control[_FIELDS:] = 1.0

    def set_field(self, field: Vector) -> None:
        """field: T, the same at both charges."""
        self._control[0:3] = self._control[3:6] = field

    def advance(self, substeps: int) -> None:
        _mujoco.mj_step(self.model, self.data, substeps)

    def magnetic_load(self) -> Floats:
        """Force (uN, world) and torque (nN m, about the body's axes) of the field on the body as it lies now."""
        _mujoco.mj_forward(self.model, self.data)
        feet = self._control[_FIELDS:].copy()
        self._control[_FIELDS:] = 0.0
        _mujoco.mj_fwdActuation(self.model, self.data)
        self._control[_FIELDS:] = feet
        return self.data.qfrc_actuator.copy()
