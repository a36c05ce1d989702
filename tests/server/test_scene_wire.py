"""The messages that are put between Viser's own, as Viser itself would write them."""

import struct

import msgspec
import numpy as np
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from scene_visit import messages_in
from viser import _messages as viser_messages
from viser.infra import _infra

from server.scene.layers import LAYERS
from server.scene.viewers.nodes import OWNER, eye_at, sight_of, tops
from server.scene.viewers.wire import frame_of
from server.scene.views import Stand
from vision.camera_model import CameraModel


def lines(segments):
    colours = np.zeros(segments.shape, dtype=np.uint8)
    props = viser_messages.LineSegmentsProps(segments, 0.1, colours, 1.0, "world")
    return viser_messages.LineSegmentsMessage("/lines", props)


def arrays_in(frame):
    whole, compressed = struct.unpack_from("<QQ", frame)
    content = msgspec.msgpack.decode(
        zstandard.ZstdDecompressor().decompress(frame[16 : 16 + compressed], max_output_size=whole)
    )
    at, found = 16 + compressed, []
    for length in content["binaryBufferLengths"]:
        at += -at % 8
        found.append(frame[at : at + length])
        at += length
    assert at == len(frame)
    return found


@given(st.lists(st.integers(0, 5), max_size=4))
def test_arrays_come_back_whatever_their_lengths(counts):
    segments = [np.random.default_rng(n).random((n, 2, 3)).astype(np.float32) for n in counts]
    frame = frame_of([lines(each) for each in segments])
    assert [m["name"] for m in messages_in(frame)] == ["/lines"] * len(counts)
    points = arrays_in(frame)[::2]
    assert [bytes(found) for found in points] == [each.tobytes() for each in segments]


def test_the_private_names_that_the_injected_messages_rely_on_still_exist():
    """After an upgrade of Viser that renames one of them, this says so instead of an empty scene."""
    for name in ("_append_aligned_buffers", "_message_producer"):
        assert hasattr(_infra, name)
    frame = messages_in(frame_of([*tops(frozenset()), *eye_at(Stand((1.0, 2.0, 3.0), (0.0, 0.0, 0.0)))]))
    for message in frame:
        kind = getattr(viser_messages, message["type"])
        assert set(message) - {"type"} == set(kind.__dataclass_fields__)
    owners = {message["owner"] for message in frame if "owner" in message}
    assert owners == {OWNER}
    assert not OWNER.isdigit()
    assert [m["name"] for m in frame if m["type"] == "FrameMessage"] == [f"/{layer}" for layer in LAYERS]


def test_the_rays_of_the_camera_meet_the_corners_of_what_it_sees():
    camera = CameraModel.looking_down()
    rays = sight_of(camera)[-4:]
    eye = -np.array(camera.rotation).T @ np.array(camera.translation)
    assert np.allclose(rays[:, 0], eye)
    assert np.allclose(camera.to_image(rays[:, 1, :2])[2], (639.0, 479.0), atol=0.5)
