"""Three nested coil pairs: geometry -> field per ampere -> the currents that make a wanted field.

The field is linear in the currents, B = K(p) I, with K(p) the 3x3 field per ampere at p (paper, section 6);
its columns are the pairs in the order x, y, z. The pairs are not ideal Helmholtz pairs (separation is not
the radius), so K changes over the plate; `CoilSet.local_allocation` takes that into account,
`CoilSet.centre_allocation` does as the paper does.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import magpylib
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from control.axes import AXES, Axis
from control.field_map import FieldMap, PlaneElements
from control.model import Pivot
from control.registration import COINCIDENT, Registration
from control.snapshot import Vector

Matrix = tuple[Vector, Vector, Vector]
"""Three rows of three."""

MAP_MARGIN = 0.02
"""How far the field map reaches beyond the workspace, m: the robot is 10 mm long and may overrun an edge."""

WORST_CONDITION = 20.0
"""K with a larger condition number is refused: an error in a current would come out 20 times larger in the
field's direction. The paper's rig has 1.4 at the corners."""

# The loop of current that magpylib draws in the x-y plane, turned onto each axis.
_TURNED = {
    "x": Rotation.from_euler("y", 90, degrees=True),
    "y": Rotation.from_euler("x", -90, degrees=True),
    "z": Rotation.identity(),
}


def _require_positive(what: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"{what} must be a finite number above 0, got {value}")


def _along(axis: Axis, distance: float) -> Vector:
    return (
        distance if axis == "x" else 0.0,
        distance if axis == "y" else 0.0,
        distance if axis == "z" else 0.0,
    )


@dataclass(frozen=True, slots=True)
class CoilPair:
    """Two equal coils on one axis, in series, their fields adding up; each is taken as one thin loop.

    diameter, separation: m.  turns: of each of the two coils.
    resistance, inductance: of both in series, ohm and H.
    gain: measured field over the field of this geometry, 1 while the geometry is trusted.
    """

    axis: Axis
    diameter: float
    separation: float
    turns: int
    resistance: float
    inductance: float
    gain: float = 1.0

    def __post_init__(self) -> None:
        if self.axis not in AXES:
            raise ValueError(f"coil pair: the axis is one of x, y, z, got {self.axis!r}")
        _require_positive(f"coil pair {self.axis}: diameter in m", self.diameter)
        _require_positive(f"coil pair {self.axis}: separation in m", self.separation)
        _require_positive(f"coil pair {self.axis}: turns", self.turns)
        _require_positive(f"coil pair {self.axis}: resistance in ohm", self.resistance)
        _require_positive(f"coil pair {self.axis}: inductance in H", self.inductance)
        _require_positive(f"coil pair {self.axis}: field gain", self.gain)

    @property
    def centres(self) -> tuple[Vector, Vector]:
        """The centres of the two loops, m."""
        return _along(self.axis, -0.5 * self.separation), _along(self.axis, 0.5 * self.separation)


PAPER_PAIRS = (
    CoilPair("x", diameter=0.390, separation=0.240, turns=314, resistance=2.5, inductance=0.125),
    CoilPair("y", diameter=0.305, separation=0.190, turns=248, resistance=2.0, inductance=0.055),
    CoilPair("z", diameter=0.225, separation=0.110, turns=154, resistance=1.5, inductance=0.014),
)
"""The paper's rig (section 6). Diameters and separations are the paper's; the turns give 10 mT at 8 A with
the outer radius; resistances and inductances are assumed."""


class CoilSet:
    """The three pairs of a rig and what they do over its workspace (a square of 2 * `workspace`, m).

    Points and fields are the workspace's; `registration` says where in it the coils stand.
    Raises ValueError when the three axes are not all there, or when the pairs cannot make every direction of
    field somewhere in the workspace.
    """

    def __init__(
        self,
        pairs: Sequence[CoilPair] = PAPER_PAIRS,
        workspace: float = 0.06,
        registration: Registration = COINCIDENT,
    ):
        if sorted(pair.axis for pair in pairs) != list(AXES):
            axes = ", ".join(pair.axis for pair in pairs)
            raise ValueError(f"a coil set has one pair on each of the axes x, y, z; got {axes or 'none'}")
        _require_positive("workspace half-size in m", workspace)
        x, y, z = sorted(pairs, key=lambda pair: pair.axis)
        self.pairs: tuple[CoilPair, CoilPair, CoilPair] = (x, y, z)
        self.workspace = workspace
        self.registration = registration
        self._sign = -1.0 if registration.magnet_reversed else 1.0
        self._map = _field_map(self.pairs, workspace, registration)
        self._centre_allocation = self.local_allocation(registration.x, registration.y)

    def field_at(self, points: ArrayLike, currents: ArrayLike) -> NDArray[np.float64]:
        """The field (n, 3) T at points (n, 3) m anywhere, for the currents (3,) A; exact, not mapped."""
        return self.field_per_ampere(points) @ np.asarray(currents, dtype=float)

    def field_per_ampere(self, points: ArrayLike) -> NDArray[np.float64]:
        """K (n, 3, 3) T/A at points (n, 3) m anywhere; keep it for a fixed grid: the field is K @ I."""
        return field_per_ampere(self.pairs, np.asarray(points, dtype=float), self.registration)

    def plane_elements(self, x: float, y: float) -> PlaneElements:
        """(Kxx, Kxy, Kyx, Kyy, Kzz), T/A, on the plate at (x, y) m; the other elements are zero."""
        return self._map.elements(x, y)

    def per_ampere(self, x: float, y: float) -> Matrix:
        """K(p) on the plate, T/A; row = field component, column = pair. Beyond the map's edge the edge's."""
        xx, xy, yx, yy, zz = self._map.elements(x, y)
        return (xx, xy, 0.0), (yx, yy, 0.0), (0.0, 0.0, zz)

    @property
    def centre(self) -> Matrix:
        """K at the coils' centre, T/A."""
        return self.per_ampere(self.registration.x, self.registration.y)

    def local_field(self, x: float, y: float, currents: Vector) -> Vector:
        """The field (T) on the plate at (x, y) m for the currents (A)."""
        xx, xy, yx, yy, zz = self._map.elements(x, y)
        i1, i2, i3 = currents
        return xx * i1 + xy * i2, yx * i1 + yy * i2, zz * i3

    def local_allocation(self, x: float, y: float) -> Matrix:
        """The inverse of K(p), A/T: I = allocation B makes B at (x, y) m; row = pair, column = component.

        For a reversed magnet it makes -B, which is to that robot what B is to one with its north at end A.
        """
        xx, xy, yx, yy, zz = self._map.elements(x, y)
        scale = self._sign / (xx * yy - xy * yx)
        return (yy * scale, -xy * scale, 0.0), (-yx * scale, xx * scale, 0.0), (0.0, 0.0, self._sign / zz)

    def centre_allocation(self) -> Matrix:
        """The local allocation at the coils' centre, A/T: the paper's currents, wherever the robot is."""
        return self._centre_allocation


def field_per_ampere(
    pairs: Sequence[CoilPair], points: NDArray[np.float64], registration: Registration = COINCIDENT
) -> NDArray[np.float64]:
    """K (n, 3, len(pairs)) T/A at points (n, 3) m of the workspace, by magpylib's closed form for loops."""
    if not registration.frames_coincide:
        return registration.turned(field_per_ampere(pairs, registration.to_coils(points)))
    fields = [pair.gain * magpylib.getB(_loops(pair), points, sumup=True).reshape(-1, 3) for pair in pairs]
    return np.stack(fields, axis=-1)


def _loops(pair: CoilPair) -> list[magpylib.current.Circle]:
    """The pair with one ampere in it."""
    turned = _TURNED[pair.axis]
    return [
        magpylib.current.Circle(
            current=pair.turns, diameter=pair.diameter, position=centre, orientation=turned
        )
        for centre in pair.centres
    ]


@lru_cache(maxsize=8)
def _field_map(
    pairs: tuple[CoilPair, CoilPair, CoilPair], workspace: float, registration: Registration
) -> FieldMap:
    field_map = FieldMap(lambda points: field_per_ampere(pairs, points, registration), workspace + MAP_MARGIN)
    _check_condition(field_map, workspace)
    return field_map


def _check_condition(field_map: FieldMap, workspace: float) -> None:
    inside = np.abs(field_map.axis) <= workspace + 1e-9
    nodes = field_map.nodes[inside][:, inside]
    worst = float(np.linalg.cond(nodes).max()) if np.isfinite(nodes).all() else math.inf
    if not worst <= WORST_CONDITION:
        raise ValueError(
            "these coils cannot make every direction of field over a workspace of "
            f"{2 * workspace * 1e3:g} mm: the worst condition number of the field per ampere is {worst:.1f}, "
            f"allowed up to {WORST_CONDITION:g}; check diameters, separations and turns, "
            "or make the workspace smaller"
        )


def command_field(pivot: Pivot, heading: float, tilt: float, strength: float) -> Vector:
    """The field (T) that turns the robot to `heading` (rad) and presses `pivot` down.

    B = |B| [cos(tilt) cos(phi), cos(tilt) sin(phi), -pivot sin(tilt)] with phi = heading + pi/2, the long
    axis, and the magnet's north at end A (paper, section 6). tilt: elevation, rad.  strength: |B|, T.
    """
    level = strength * math.cos(tilt)
    return -level * math.sin(heading), level * math.cos(heading), -pivot * strength * math.sin(tilt)


def currents_for(allocation: Matrix, field: Vector) -> Vector:
    """I = allocation B, A; field in T, allocation in A/T."""
    bx, by, bz = field
    (a, b, c), (d, e, f), (g, h, i) = allocation
    return a * bx + b * by + c * bz, d * bx + e * by + f * bz, g * bx + h * by + i * bz
