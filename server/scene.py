"""The rig in three dimensions, in Viser: coils to scale, the field, the robot with its tilt, path and trail.

Viser listens on loopback only and is reached through `server.scene_bridge`. Nothing in it can act on the rig.
The scene's unit is the centimetre: Viser's near plane and lights suit lengths of 1 to 100.
"""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass

import numpy as np
import rich
import viser
from numpy.typing import NDArray
from viser import _messages as viser_messages

from control.coils import CoilPair, CoilSet
from control.model import Pose, pivot_point
from control.snapshot import Snapshot, Vector
from server.scene_shapes import (
    FieldArrows,
    body_attitude,
    ring_segments,
    segments_through,
    square,
)

CM = 100.0
"""Scene units per metre."""

Colour = tuple[int, int, int]
PAIR_COLOURS: dict[str, Colour] = {"x": (213, 94, 0), "y": (0, 158, 115), "z": (0, 114, 178)}
"""Okabe and Ito's palette, which survives colour blindness."""
PLATE: Colour = (74, 80, 88)
FRAME: Colour = (178, 184, 192)
BODY: Colour = (196, 52, 46)
END_A: Colour = (86, 180, 233)
END_B: Colour = (230, 159, 0)
PIVOT: Colour = (255, 255, 255)
PATH: Colour = (86, 180, 233)
TRAIL: Colour = (204, 121, 167)

CAP = 0.2
"""Share of the body's length that each end's colour takes."""
LINE_HEIGHT = 0.0004
"""Lines on the plate float that high above it, m, so that they do not flicker into it."""
LONGEST_LINE = 240
"""Points of a drawn path or trail; more are thinned out."""


@dataclass(frozen=True, slots=True)
class SceneGeometry:
    """Lengths in m. workspace: half the square's side.  length: between the pivots.  width, height: body."""

    coils: CoilSet
    workspace: float
    length: float
    width: float
    height: float


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
    """All nodes of the scene and how they follow a snapshot. It blocks: use it off the event loop."""

    def __init__(self, geometry: SceneGeometry) -> None:
        self.server = start_viser()
        self._first_view()
        self._build(geometry)

    def _build(self, geometry: SceneGeometry) -> None:
        self._geometry = geometry
        self._arrows = FieldArrows(geometry.coils, geometry.workspace)
        self._light()
        self._furniture()
        self._robot_nodes()
        self._moving_nodes()
        self._drawn: dict[str, NDArray[np.float64]] = {}

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

    def show(self, snapshot: Snapshot, path: NDArray[np.float64], trail: NDArray[np.float64]) -> None:
        """Bring the scene up to date. path, trail: (n, 2) m."""
        with self.server.atomic():
            self._show_field(snapshot)
            self._show_robot(snapshot)
            self._show_line("path", path)
            self._show_line("trail", trail)

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

    def _robot_nodes(self) -> None:
        scene = self.server.scene
        size = self._geometry
        length, width, height = size.length * CM, size.width * CM, size.height * CM
        self._robot = scene.add_frame("/robot", show_axes=False)
        scene.add_box("/robot/body", BODY, (width, length * (1 - 2 * CAP), height))
        for name, colour, side in (("A", END_A, 1.0), ("B", END_B, -1.0)):
            at = side * length * (0.5 - 0.5 * CAP)
            scene.add_box(f"/robot/{name}", colour, (width, length * CAP, height), position=(0.0, at, 0.0))
            above = (0.0, side * length * 0.7, height)
            scene.add_label(f"/robot/{name}/label", name, position=above, font_size_mode="screen")
        self._pivot = scene.add_icosphere("/pivot", radius=0.14, color=PIVOT)

    def _moving_nodes(self) -> None:
        scene = self.server.scene
        points, colours = self._arrows.for_currents((0.0, 0.0, 0.0))
        self._field = scene.add_arrows(
            "/field",
            points * CM,
            colours,
            shaft_radius=0.05,
            head_radius=0.13,
            head_length=0.3,
            visible=False,
        )
        nothing = np.zeros((1, 2, 3))
        self._lines = {
            "path": scene.add_line_segments("/path", nothing, PATH, thickness=0.08, visible=False),
            "trail": scene.add_line_segments("/trail", nothing, TRAIL, thickness=0.07, visible=False),
        }

    def _show_field(self, snapshot: Snapshot) -> None:
        points, colours = self._arrows.for_currents(snapshot.currents)
        self._field.visible = self._arrows.is_visible(snapshot.currents)
        self._field.points = (points * CM).astype(np.float32)
        self._field.colors = colours

    def _show_robot(self, snapshot: Snapshot) -> None:
        self._robot.visible = self._pivot.visible = snapshot.pose is not None
        if snapshot.pose is None:
            return
        self._place_body(snapshot.pose, snapshot)
        pivot = pivot_point(snapshot.pose, snapshot.command.pivot, self._geometry.length)
        self._pivot.position = (pivot[0] * CM, pivot[1] * CM, 0.0)

    def _place_body(self, pose: Pose, snapshot: Snapshot) -> None:
        position, wxyz = body_attitude(
            pose, snapshot.command.pivot, snapshot.body_tilt, self._geometry.length, self._geometry.height
        )
        self._robot.position = np.array(position) * CM
        self._robot.wxyz = wxyz

    def _show_line(self, name: str, points: NDArray[np.float64]) -> None:
        """Sent only when it has changed: a path does not for minutes."""
        if name in self._drawn and np.array_equal(self._drawn[name], points):
            return
        self._drawn[name] = points.copy()
        segments = segments_through(points, LINE_HEIGHT, LONGEST_LINE)
        self._lines[name].visible = len(segments) > 0
        if len(segments):
            self._lines[name].points = (segments * CM).astype(np.float32)
