"""The formulas of controllers, walker, field and robot, made callable from compiled code as they stand.

`LAWS` is a fingerprint of their source texts and of the compiled walk's: a kernel that is kept on the disk belongs
to it, so that a changed formula is never met by an old kernel.
"""

from __future__ import annotations

import hashlib
import inspect

from numba.extending import register_jitable

from control import backlash, field_model, gait, metrics, model, walker
from control.controllers import geometric, gradient
from control.simulation import plant, slip
from control.studies.batch import bench, compiled_field, compiled_robot, compiled_walk

FORMULAS = (
    model.wrap,
    model.distance,
    model.pivot_point,
    model.opposite,
    gait.remaining_turn,
    gait.sweep_end,
    backlash.lag_after,
    backlash.pull_after,
    field_model.turned_until,
    field_model.raised_until,
    slip.between_rows,
    slip.mixed,
    plant.watch_elevation,
    plant.turn_towards,
    plant.hung_on,
    plant.mean_forward,
    plant.slid,
    geometric.nearest_pivot,
    geometric.swing_rate,
    gradient.cost_errors,
    gradient.cost_value,
    gradient.cost_by_rate,
    gradient.distance_from_pivot,
    gradient.descend,
    gradient.lowest_on,
    gradient.is_other_lower,
    gradient.is_at_rest_too_far,
    gradient.gone_on,
)
OWN = (
    *compiled_robot.PARTS,
    *compiled_field.PARTS,
    *compiled_walk.PARTS,
)
MODULES = (
    backlash,
    bench,
    field_model,
    gait,
    metrics,
    model,
    walker,
    geometric,
    gradient,
    plant,
    slip,
    compiled_field,
    compiled_robot,
    compiled_walk,
)


def fingerprint() -> str:
    """Of the texts of all modules that a kernel is made of, constants included."""
    texts = "\0".join(inspect.getsource(module) for module in MODULES)
    return hashlib.sha256(texts.encode()).hexdigest()


LAWS = fingerprint()

for formula in (*FORMULAS, *OWN):
    register_jitable(formula)
