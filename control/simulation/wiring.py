"""How the simulated coils hang on the bridges: a rig that has been plugged together wrongly, if one likes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from control.axes import AXES
from control.snapshot import Vector

LEADS = tuple(f"{sign}{axis}" for sign in ("", "-") for axis in AXES)


@dataclass(frozen=True, slots=True)
class Wiring:
    """leads: what the bridges 1, 2 and 3 drive: "x", "y" or "z", with "-" in front where the leads are swapped."""

    leads: tuple[str, ...] = AXES

    def __post_init__(self) -> None:
        if any(lead not in LEADS for lead in self.leads) or {lead[-1] for lead in self.leads} != set(AXES):
            raise ValueError(
                f"the wiring {list(self.leads)} is none: each of x, y and z once, with - for swapped leads"
            )

    @property
    def is_straight(self) -> bool:
        return self.leads == AXES

    def through_pairs(self, samples: Sequence[Vector]) -> Sequence[Vector]:
        """The currents of the pairs x, y, z from those of the bridges, A, sample by sample."""
        if self.is_straight:
            return samples
        (a, i), (b, j), (c, k) = (self._bridge_of(axis) for axis in AXES)
        return [(a * sample[i], b * sample[j], c * sample[k]) for sample in samples]

    def _bridge_of(self, axis: str) -> tuple[float, int]:
        """Sign and index of the bridge that drives the pair on `axis`."""
        index = next(index for index, lead in enumerate(self.leads) if lead[-1] == axis)
        return (-1.0 if self.leads[index].startswith("-") else 1.0), index


STRAIGHT = Wiring()
"""Bridge 1 drives the x pair, 2 the y pair, 3 the z pair, all the right way round."""
