"""A robot in the scene: its body with the tilt, the pivot it stands on, its reference with the target, its trail."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser
from numpy.typing import NDArray

from control.model import Pivot, Pose, pivot_point
from server.scene.geometry import CM, RobotSize
from server.scene.layers import root_of
from server.scene.shapes import body_attitude, segments_through

Colour = tuple[int, int, int]
END_A: Colour = (86, 180, 233)
END_B: Colour = (230, 159, 0)
PIVOT: Colour = (255, 255, 255)

TARGET = 0.22
"""Radius of the ball that marks where the robot should be, cm."""
CAP = 0.2
"""Share of the body's length that each end's colour takes."""
LINE_HEIGHT = 0.0004
"""Lines on the plate float that high above it, m, so that they do not flicker into it."""
LONGEST_LINE = 240
"""Points of a drawn path or trail; more are thinned out."""


@dataclass(frozen=True, slots=True)
class ShownRobot:
    """A robot at one instant. pose: None while it is not known.  body_tilt: rad.  path, trail: (n, 2) m.

    target: where on its path it should be now, m; None while it follows none.
    """

    pose: Pose | None
    pivot: Pivot
    body_tilt: float
    path: NDArray[np.float64]
    trail: NDArray[np.float64]
    target: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Looks:
    """What tells two robots apart. label: stands above the robot, in place of A and B at its ends."""

    body: Colour
    path: Colour
    trail: Colour
    label: str = ""


LOOKS = (
    Looks((196, 52, 46), (86, 180, 233), (204, 121, 167)),
    Looks((0, 158, 115), (240, 228, 66), (230, 159, 0)),
)
"""Of the first robot and of the one it is compared with: Okabe and Ito's colours, which survive colour blindness."""


class RobotNodes:
    """The nodes of one robot. number: 0 for the first, 1 for the one that it is compared with."""

    def __init__(self, scene: viser.SceneApi, number: int, size: RobotSize, looks: Looks) -> None:
        self._scene, self._size = scene, size
        self._number = number
        self._root = f"/compared/{number}" if number else ""
        self._drawn: dict[str, NDArray[np.float64]] = {}
        self.body = scene.add_frame(f"{self._root}/robot", show_axes=False)
        self._body_nodes(looks)
        self.pivot = scene.add_icosphere(f"{self._root}/pivot", radius=0.14, color=PIVOT)
        self.target = scene.add_icosphere(
            f"{root_of('reference')}/{number}/target",
            radius=TARGET,
            color=looks.path,
            opacity=0.5,
            visible=False,
        )
        self.lines = {
            "path": self._line(f"{root_of('reference')}/{number}/path", looks.path, 0.08),
            "trail": self._line(f"{root_of('trail')}/{number}", looks.trail, 0.07),
        }

    def show(self, robot: ShownRobot) -> None:
        self._place(robot)
        self._place_target(robot.target)
        self._show_line("path", robot.path)
        self._show_line("trail", robot.trail)

    def _body_nodes(self, looks: Looks) -> None:
        name, scene = f"{self._root}/robot", self._scene
        length, width, height = self._size.length * CM, self._size.width * CM, self._size.height * CM
        scene.add_box(f"{name}/body", looks.body, (width, length * (1 - 2 * CAP), height))
        for end, colour, side in (("A", END_A, 1.0), ("B", END_B, -1.0)):
            at = side * length * (0.5 - 0.5 * CAP)
            scene.add_box(f"{name}/{end}", colour, (width, length * CAP, height), position=(0.0, at, 0.0))
            if not looks.label:
                above = (0.0, side * length * 0.7, height)
                scene.add_label(f"{name}/{end}/label", end, position=above, font_size_mode="screen")
        if looks.label:
            above = (0.0, 0.0, 6.0 * height)
            scene.add_label(f"{name}/label", looks.label, position=above, font_size_mode="screen")

    def _line(self, name: str, colour: Colour, thickness: float) -> viser.LineSegmentsHandle:
        nothing = np.zeros((1, 2, 3))
        return self._scene.add_line_segments(name, nothing, colour, thickness=thickness, visible=False)

    def _place(self, robot: ShownRobot) -> None:
        self.body.visible = self.pivot.visible = robot.pose is not None
        if robot.pose is None:
            return
        size = self._size
        position, wxyz = body_attitude(robot.pose, robot.pivot, robot.body_tilt, size.length, size.height)
        self.body.position = np.array(position) * CM
        self.body.wxyz = wxyz
        x, y = pivot_point(robot.pose, robot.pivot, size.length)
        self.pivot.position = (x * CM, y * CM, 0.0)

    def _place_target(self, target: tuple[float, float] | None) -> None:
        self.target.visible = target is not None
        if target is not None:
            self.target.position = (target[0] * CM, target[1] * CM, LINE_HEIGHT * CM)

    def _show_line(self, name: str, points: NDArray[np.float64]) -> None:
        """Sent only when it has changed: a path does not for minutes."""
        if name in self._drawn and np.array_equal(self._drawn[name], points):
            return
        self._drawn[name] = points.copy()
        segments = segments_through(points, LINE_HEIGHT, LONGEST_LINE)
        self.lines[name].visible = len(segments) > 0
        if len(segments):
            self.lines[name].points = (segments * CM).astype(np.float32)
