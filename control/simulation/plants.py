"""The simulated robots by name: each with a pydantic model of its parameters, in the lab's units.

`slip` and `noslip` are kinematic (`control.simulation.plant`), `rigid` is a body with contacts
(`control.simulation.rigid`), which needs the extra `physics` once it is built.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

from pydantic import Field

from control.model import Pivot, Pose
from control.registry import Parameters, Registry
from control.simulation.plant import PlantCounters, SlipPlant
from control.simulation.rigid.parameters import RigidParameters
from control.simulation.slip import NO_SLIP, SLIP_TABLE, Slip, SlipParameters
from control.snapshot import Vector


class Plant(Protocol):
    """The robot in the field at its place.

    pose: as if it lay flat on the end that is pressed down.  body_tilt: elevation of the other one, rad.
    """

    @property
    def pose(self) -> Pose: ...
    @property
    def position(self) -> tuple[float, float]: ...
    @property
    def pivot(self) -> Pivot: ...
    @property
    def body_tilt(self) -> float: ...
    @property
    def counters(self) -> PlantCounters: ...
    def step(self, field: Vector, dt: float) -> None: ...
    def place(self, pose: Pose) -> None: ...


class PlantKind(Protocol):
    """A sort of robot with its parameters, of which any number can be built."""

    name: str
    title: str
    summary: str
    Parameters: type[Parameters]

    def __init__(self, parameters: Any) -> None: ...

    def build(self, length: float, start: Pose, seed: int) -> Plant:
        """length: between the pivots, m.  seed: of whatever scatters.  Raises `MissingExtra`."""
        ...


class MissingExtra(ValueError):
    """A plant whose library is not installed."""


plants: Registry[PlantKind] = Registry("plant")


@dataclass(frozen=True, slots=True)
class PlantChoice:
    """A plant by name, with its parameters in the lab units of its parameter model."""

    name: str = "slip"
    parameters: Mapping[str, Any] = field(default_factory=dict)

    def kind(self) -> PlantKind:
        """Raises `UnknownName` or pydantic's `ValidationError`."""
        return plants.build(self.name, self.parameters)


def build_plant(choice: PlantChoice, length: float, start: Pose, seed: int = 0) -> Plant:
    """A robot at `start`; length between its pivots in m. Raises like `PlantChoice.kind`, and `MissingExtra`."""
    return choice.kind().build(length, start, seed)


class SlipChoiceParameters(Parameters):
    """How far the table of `control.simulation.slip` is believed; all 1: as it is."""

    slip_scale: float = Field(
        default=1.0,
        ge=0.0,
        le=10.0,
        title="Displacement",
        description="Factor on the mean displacements of the new pivot at a switch.",
    )
    scatter_scale: float = Field(
        default=1.0,
        ge=0.0,
        le=10.0,
        title="Scatter",
        description="Factor on all standard deviations: of the displacements and of the play.",
    )
    play_scale: float = Field(
        default=1.0,
        ge=0.0,
        le=10.0,
        title="Play",
        description="Factor on the mean free play between the field's heading and the body's.",
    )
    magnetic_ratio: float = Field(
        default=3.2,
        gt=0.0,
        le=1000.0,
        title="Magnetic ratio Λ",
        description="Magnet's torque over the weight's at 10 mT, 2 m B / (W L); decides only how the free end lifts.",
    )

    def table(self) -> SlipParameters:
        """The scaled table; the very same one where nothing is scaled."""
        if self == SlipChoiceParameters():
            return SLIP_TABLE
        rows = tuple(self._scaled(row) for row in SLIP_TABLE.rows)
        return replace(SLIP_TABLE, rows=rows, magnetic_ratio=self.magnetic_ratio)

    def _scaled(self, row: Slip) -> Slip:
        return replace(
            row,
            play=self.play_scale * row.play,
            play_sd=self.scatter_scale * row.play_sd,
            out=self.slip_scale * row.out,
            out_sd=self.scatter_scale * row.out_sd,
            forward_base=self.slip_scale * row.forward_base,
            forward_per_sweep=self.slip_scale * row.forward_per_sweep,
            forward_sd=self.scatter_scale * row.forward_sd,
        )


@plants.register
class SlipKind:
    name = "slip"
    title = "Slip"
    summary = "Kinematic, with the play and the displacements that a rigid-body study of the gait gave."
    Parameters = SlipChoiceParameters

    def __init__(self, parameters: SlipChoiceParameters) -> None:
        self.table = parameters.table()

    def build(self, length: float, start: Pose, seed: int) -> SlipPlant:
        return SlipPlant(self.table, length, start, seed)


class NoSlipParameters(Parameters):
    """There are none."""


@plants.register
class NoSlipKind:
    name = "noslip"
    title = "No slip"
    summary = (
        "The paper's kinematic model: the body's heading is the field's, each pivot stays where it lands."
    )
    Parameters = NoSlipParameters

    def __init__(self, parameters: NoSlipParameters) -> None:  # noqa: ARG002
        self.table = NO_SLIP

    def build(self, length: float, start: Pose, seed: int) -> SlipPlant:
        return SlipPlant(self.table, length, start, seed)


@plants.register
class RigidKind:
    name = "rigid"
    title = "Rigid body"
    summary = "A free body under gravity, Coulomb contact and the magnet's torque; needs the extra `physics`."
    Parameters = RigidParameters

    def __init__(self, parameters: RigidParameters) -> None:
        self.parameters = parameters

    def build(self, length: float, start: Pose, seed: int) -> Plant:
        try:
            from control.simulation.rigid.plant import RigidPlant
        except ModuleNotFoundError as error:
            if error.name != "mujoco":
                raise
            raise MissingExtra(
                "the plant 'rigid' needs MuJoCo, which is not installed: install the extra `physics` with "
                "`uv sync --extra physics`, or choose the plant slip or noslip"
            ) from None
        return RigidPlant(self.parameters, length, start, seed)
