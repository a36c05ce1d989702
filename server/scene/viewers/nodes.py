"""What one viewer's scene has for itself: the tops of its layers, its eye, and the camera's picture on the plate.

Viser lets a node have one variant of the server's and one of a client, which wins, whatever comes first; so a layer is
hidden by a frame of the viewer's own above the nodes that all viewers share.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from viser import _messages as viser_messages
from viser._messages import Message

from server.scene.geometry import CM, SceneGeometry
from server.scene.layers import LAYERS, Layer, root_of
from server.scene.plate_pictures import PlatePicture
from server.scene.views import Stand
from vision.camera_model import CameraModel

OWNER = "viewer"
"""Whose variants these are; Viser's own clients are called by numbers."""
PICTURE = f"{root_of('camera')}/picture"
RAYS = f"{root_of('camera')}/rays"
ABOVE_PLATE = 0.01
"""Of the picture, cm; below the lines on the plate."""
FACE_UP = (0.0, 1.0, 0.0, 0.0)
"""Viser's pictures are seen from below."""
RAY_COLOUR = (214, 160, 30)
RAY_POINTS = 8
"""Along each side of what the camera sees on the plate: a lens bends it."""


def owned(message: Message) -> Message:
    message.owner = OWNER  # type: ignore[attr-defined]
    return message


def tops(shown: frozenset[Layer]) -> list[Message]:
    """To a newcomer: the layers' tops."""
    return [owned(viser_messages.FrameMessage(root_of(layer), plain_frame())) for layer in LAYERS] + switches(
        LAYERS, shown
    )


def switches(layers: Iterable[Layer], shown: frozenset[Layer]) -> list[Message]:
    visible = viser_messages.SetSceneNodeVisibilityMessage
    return [owned(visible(root_of(layer), layer in shown)) for layer in layers]


def plain_frame() -> viser_messages.FrameProps:
    return viser_messages.FrameProps(
        show_axes=False,
        axes_length=1.0,
        axes_radius=0.1,
        origin_radius=0.1,
        origin_color=(0, 0, 0),
        scale=1.0,
    )


def eye_at(stand: Stand) -> list[Message]:
    return [
        viser_messages.SetCameraUpDirectionMessage(stand.up),
        viser_messages.SetCameraLookAtMessage(stand.look_at),
        viser_messages.SetCameraPositionMessage(stand.position),
    ]


def camera_nodes(geometry: SceneGeometry, picture: PlatePicture) -> list[Message]:
    """The picture on the plate, and from where it was taken."""
    side = 2.0 * picture.half * CM
    props = viser_messages.ImageProps(
        _format="jpeg",
        _data=picture.jpeg,
        render_width=side,
        render_height=side,
        cast_shadow=False,
        receive_shadow=False,
        scale=1.0,
    )
    nodes: list[Message] = [
        owned(viser_messages.ImageMessage(PICTURE, props)),
        owned(viser_messages.SetOrientationMessage(PICTURE, FACE_UP)),
        owned(viser_messages.SetPositionMessage(PICTURE, (0.0, 0.0, ABOVE_PLATE))),
    ]
    return nodes if geometry.camera is None else [*nodes, rays(geometry.camera)]


def next_picture(picture: PlatePicture) -> list[Message]:
    return [viser_messages.SceneNodeUpdateMessage(PICTURE, {"_data": picture.jpeg}, OWNER)]


def rays(camera: CameraModel) -> Message:
    segments = (sight_of(camera) * CM).astype(np.float32)
    colours = np.broadcast_to(np.array(RAY_COLOUR, dtype=np.uint8), segments.shape).copy()
    props = viser_messages.LineSegmentsProps(
        points=segments, thickness=0.04, colors=colours, scale=1.0, thickness_units="world"
    )
    return owned(viser_messages.LineSegmentsMessage(RAYS, props))


def sight_of(camera: CameraModel) -> np.ndarray:
    """Segments (n, 2, 3) m: the rim of what the camera sees of the plate, and a ray from it to each corner."""
    width, height = camera.size[0] - 1.0, camera.size[1] - 1.0
    corners = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height], [0.0, 0.0]])
    shares = np.linspace(0.0, 1.0, RAY_POINTS, endpoint=False)[:, None]
    sides = [one + shares * (other - one) for one, other in pairwise(corners)]
    seen = camera.to_workspace(np.concatenate([*sides, corners[:1]]))
    rim = np.column_stack([seen, np.full(len(seen), ABOVE_PLATE / CM)])
    eye = -np.array(camera.rotation).T @ np.array(camera.translation)
    to_corners = [np.stack([eye, rim[RAY_POINTS * corner]]) for corner in range(4)]
    return np.concatenate([np.stack([rim[:-1], rim[1:]], axis=1), np.stack(to_corners)])
