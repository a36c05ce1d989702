"""A rig in three dimensions, in Viser: coils to scale, the field, robots with their tilt, paths and trails.

Viser is reached through `server.scene.bridge` alone. Nothing in it can act on the rig.
The scene's unit is the centimetre: Viser's near plane and lights suit lengths of 1 to 100.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import rich
import viser
from viser import _messages as viser_messages

from control.coils import CoilPair
from control.snapshot import Vector
from server.scene.geometry import CM, SceneGeometry
from server.scene.layers import root_of
from server.scene.private_viser import private_viser
from server.scene.robot import LINE_HEIGHT, LOOKS, Colour, Looks, RobotNodes, ShownRobot
from server.scene.shapes import (
    ABOVE_ROBOT,
    FULL_FIELD,
    FieldArrows,
    Floats,
    arrows_of,
    is_visible,
    ring_segments,
    square,
)
from server.scene.views import FIELD_OF_VIEW, SQUARE, stand

PAIR_COLOURS: dict[str, Colour] = {"x": (213, 94, 0), "y": (0, 158, 115), "z": (0, 114, 178)}
"""Okabe and Ito's palette, which survives colour blindness."""
PLATE: Colour = (74, 80, 88)
FRAME: Colour = (178, 184, 192)


@dataclass(frozen=True, slots=True)
class View:
    """What the scene shows at one instant. currents: of the coils, A.  robots: as many as the scene has looks.

    full_field: the end of the field's colours and lengths, T.
    """

    geometry: SceneGeometry
    currents: Vector
    robots: Sequence[ShownRobot]
    full_field: float = FULL_FIELD


def start_viser() -> viser.ViserServer:
    """A quiet Viser that no other program can reach, and that cannot be shared with the outside."""
    rich.get_console().quiet = True  # Viser prints banners to stdout, which belongs to results
    logging.getLogger("websockets.server").setLevel(logging.WARNING)
    server = private_viser("rig")
    for message in (viser_messages.ShareUrlRequest, viser_messages.ShareUrlDisconnect):
        server._websock_server.unregister_handler(message)
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    server.gui.main_panel.minimize()
    return server


def label_place(pair: CoilPair) -> Vector:
    """On the rim of the pair's second loop, where the first view shows it, in the coils' frame, m."""
    x, y, z = pair.centres[1]
    radius = 0.5 * pair.diameter
    return {"x": (x, radius, z), "y": (radius, y, z), "z": (-radius, y, z)}[pair.axis]


class Scene:
    """All nodes of the scene and how they follow a view. It blocks: use it off the event loop."""

    def __init__(self, geometry: SceneGeometry, looks: Sequence[Looks] = LOOKS[:1]) -> None:
        """looks: one for each robot that there is to see."""
        self._looks = looks
        self.server = start_viser()
        self._first_view(geometry)
        self._build(geometry)

    def _build(self, geometry: SceneGeometry) -> None:
        self._geometry = geometry
        self._arrows = FieldArrows(geometry.coils, geometry.workspace)
        self._light()
        self._furniture()
        self._field_nodes()
        scene = self.server.scene
        self.robots = [
            RobotNodes(scene, number, geometry.robot, looks) for number, looks in enumerate(self._looks)
        ]

    def rebuild(self, geometry: SceneGeometry) -> None:
        """Draw another rig in place of this one; who looks keeps the view."""
        with self.server.atomic():
            self.server.scene.reset()
            self._build(geometry)

    def stop(self) -> None:
        self.server.stop()

    def show(self, view: View) -> None:
        """Bring the scene up to date; with another geometry it is drawn anew."""
        if view.geometry is not self._geometry:
            self.rebuild(view.geometry)
        with self.server.atomic():
            self._show_field(view)
            for nodes, robot in zip(self.robots, view.robots, strict=True):
                nodes.show(robot)

    def _light(self) -> None:
        scene = self.server.scene
        scene.configure_environment_map(None)
        scene.configure_default_lights(enabled=True, cast_shadow=False)
        scene.add_light_ambient("/ambient", intensity=1.0)

    def _first_view(self, geometry: SceneGeometry) -> None:
        overview = stand("overview", geometry, (0.0, 0.0, 0.0), SQUARE)
        camera = self.server.initial_camera
        camera.position, camera.look_at, camera.up = overview.position, overview.look_at, overview.up
        camera.fov = FIELD_OF_VIEW

    def _furniture(self) -> None:
        scene, half = self.server.scene, self._geometry.workspace * CM
        for pair in self._geometry.coils.pairs:
            self._coil_pair(pair)
        side = 2.0 * half + 2.0
        scene.add_box("/plate", PLATE, (side, side, 0.3), position=(0.0, 0.0, -0.16))
        scene.add_line_segments("/workspace", square(half, LINE_HEIGHT * CM), FRAME, thickness=0.06)
        scene.add_label("/workspace/label", f"{2 * half * 10:.0f} mm", position=(half, -half - 0.6, 0.0))

    def _coil_pair(self, pair: CoilPair) -> None:
        name = f"{root_of('coils')}/{pair.axis}"
        rings = self._geometry.coils.registration.to_workspace(ring_segments(pair)) * CM
        self.server.scene.add_line_segments(name, rings, PAIR_COLOURS[pair.axis], thickness=0.25)
        label = f"{pair.axis} coils, {pair.diameter * 1e3:.0f} mm"
        place = self._geometry.coils.registration.to_workspace(np.array(label_place(pair))) * CM
        self.server.scene.add_label(f"{name}/label", label, position=tuple(place))

    def _field_nodes(self) -> None:
        self._field = self._arrow_nodes("grid", len(self._arrows.origins), shaft_radius=0.05)
        self._field_at_robot = self._arrow_nodes("robot", 1, shaft_radius=0.1)

    def _arrow_nodes(self, name: str, count: int, shaft_radius: float) -> viser.ArrowsHandle:
        return self.server.scene.add_arrows(
            f"{root_of('field')}/{name}",
            np.tile(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), (count, 1, 1)),
            np.zeros((count, 3), dtype=np.uint8),
            shaft_radius=shaft_radius,
            head_radius=2.6 * shaft_radius,
            head_length=6.0 * shaft_radius,
            visible=False,
        )

    def _show_field(self, view: View) -> None:
        arrows = self._arrows
        self._show_arrows(self._field, arrows.field(view.currents), arrows.origins, view.full_field)
        pose = view.robots[0].pose
        if pose is None:
            self._field_at_robot.visible = False
            return
        origin = np.array([[pose.x, pose.y, ABOVE_ROBOT]])
        field = self._geometry.coils.field_at(origin, view.currents)
        self._show_arrows(self._field_at_robot, field, origin, view.full_field)

    def _show_arrows(
        self, nodes: viser.ArrowsHandle, field: Floats, origins: Floats, full_field: float
    ) -> None:
        """Field (n, 3) T at origins (n, 3) m; where there is none, there are no arrows."""
        points, colours = arrows_of(field, origins, full_field)
        nodes.visible = is_visible(field)
        nodes.points = (points * CM).astype(np.float32)
        nodes.colors = colours
