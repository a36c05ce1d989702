"""A rig in three dimensions, in Viser: coils to scale, the field, robots with their tilt, paths and trails.

Viser listens on loopback only and is reached through `server.scene.bridge`. Nothing in it can act on the rig.
The scene's unit is the centimetre: Viser's near plane and lights suit lengths of 1 to 100.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import rich
import viser
from viser import _messages as viser_messages

from control.coils import CoilPair
from control.snapshot import Vector
from server.scene.geometry import SceneGeometry
from server.scene.robot import CM, LINE_HEIGHT, LOOKS, Colour, Looks, RobotNodes, ShownRobot
from server.scene.shapes import FieldArrows, ring_segments, square

PAIR_COLOURS: dict[str, Colour] = {"x": (213, 94, 0), "y": (0, 158, 115), "z": (0, 114, 178)}
"""Okabe and Ito's palette, which survives colour blindness."""
PLATE: Colour = (74, 80, 88)
FRAME: Colour = (178, 184, 192)


@dataclass(frozen=True, slots=True)
class View:
    """What the scene shows at one instant. currents: of the coils, A.  robots: as many as the scene has looks."""

    geometry: SceneGeometry
    currents: Vector
    robots: Sequence[ShownRobot]


def start_viser() -> viser.ViserServer:
    """A quiet Viser on a free loopback port, which cannot be shared with the outside."""
    rich.get_console().quiet = True  # Viser prints banners to stdout, which belongs to results
    logging.getLogger("websockets.server").setLevel(logging.WARNING)
    server = viser.ViserServer(host="127.0.0.1", port=0, label="rig", verbose=False)
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
        self._first_view()
        self._build(geometry)

    def _build(self, geometry: SceneGeometry) -> None:
        self._geometry = geometry
        self._arrows = FieldArrows(geometry.coils, geometry.workspace)
        self._light()
        self._furniture()
        self._field_nodes()
        roots = ("", *(f"/compared/{number}" for number in range(1, len(self._looks))))
        pairs = zip(roots, self._looks, strict=True)
        self.robots = [RobotNodes(self.server.scene, root, geometry.robot, looks) for root, looks in pairs]

    def rebuild(self, geometry: SceneGeometry) -> None:
        """Draw another rig in place of this one; who looks keeps the view."""
        with self.server.atomic():
            self.server.scene.reset()
            self._build(geometry)

    @property
    def port(self) -> int:
        return self.server.get_port()

    def stop(self) -> None:
        self.server.stop()

    def show(self, view: View) -> None:
        """Bring the scene up to date; with another geometry it is drawn anew."""
        if view.geometry is not self._geometry:
            self.rebuild(view.geometry)
        with self.server.atomic():
            self._show_field(view.currents)
            for nodes, robot in zip(self.robots, view.robots, strict=True):
                nodes.show(robot)

    def _light(self) -> None:
        scene = self.server.scene
        scene.configure_environment_map(None)
        scene.configure_default_lights(enabled=True, cast_shadow=False)
        scene.add_light_ambient("/ambient", intensity=1.6)

    def _first_view(self) -> None:
        camera = self.server.initial_camera
        camera.position = (9.0, -43.0, 33.0)
        camera.look_at = (0.0, 0.0, -1.0)
        camera.up = (0.0, 0.0, 1.0)
        camera.fov = math.radians(36.0)

    def _furniture(self) -> None:
        scene, half = self.server.scene, self._geometry.workspace * CM
        for pair in self._geometry.coils.pairs:
            self._coil_pair(pair)
        side = 2.0 * half + 2.0
        scene.add_box("/plate", PLATE, (side, side, 0.3), position=(0.0, 0.0, -0.16))
        scene.add_line_segments("/workspace", square(half, LINE_HEIGHT * CM), FRAME, thickness=0.06)
        scene.add_label("/workspace/label", f"{2 * half * 10:.0f} mm", position=(half, -half - 0.6, 0.0))

    def _coil_pair(self, pair: CoilPair) -> None:
        name = f"/coils/{pair.axis}"
        rings = self._geometry.coils.registration.to_workspace(ring_segments(pair)) * CM
        self.server.scene.add_line_segments(name, rings, PAIR_COLOURS[pair.axis], thickness=0.25)
        label = f"{pair.axis} coils, {pair.diameter * 1e3:.0f} mm"
        place = self._geometry.coils.registration.to_workspace(np.array(label_place(pair))) * CM
        self.server.scene.add_label(f"{name}/label", label, position=tuple(place))

    def _field_nodes(self) -> None:
        points, colours = self._arrows.for_currents((0.0, 0.0, 0.0))
        self._field = self.server.scene.add_arrows(
            "/field",
            points * CM,
            colours,
            shaft_radius=0.05,
            head_radius=0.13,
            head_length=0.3,
            visible=False,
        )

    def _show_field(self, currents: Vector) -> None:
        points, colours = self._arrows.for_currents(currents)
        self._field.visible = self._arrows.is_visible(currents)
        self._field.points = (points * CM).astype(np.float32)
        self._field.colors = colours
