import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import web
from control.coils import PAPER_PAIRS, CoilSet
from control.model import Pose, pivot_point
from server.scene.shapes import (
    ARROW_LENGTH,
    CIVIDIS,
    FULL_FIELD,
    FieldArrows,
    SCALES_mT,
    arrows_of,
    body_attitude,
    colours,
    full_field,
    is_visible,
    ring_segments,
    segments_through,
    square,
)

LENGTH, HEIGHT = 0.010, 0.003

ANGLES = st.floats(-math.pi, math.pi)
TILTS = st.floats(0.0, math.radians(60.0))
PIVOTS = st.sampled_from([1, -1])


@pytest.fixture(scope="module")
def arrows():
    return FieldArrows(CoilSet(), 0.06)


def rotated(wxyz, vector):
    w, axis = wxyz[0], np.array(wxyz[1:])
    return vector + 2.0 * np.cross(axis, np.cross(axis, vector) + w * np.array(vector))


@pytest.mark.parametrize("pair", PAPER_PAIRS)
def test_each_loop_has_its_diameter_and_stands_on_its_axis(pair):
    axis = "xyz".index(pair.axis)
    points = ring_segments(pair).reshape(-1, 3)
    assert set(np.round(points[:, axis], 9)) == {-pair.separation / 2, pair.separation / 2}
    across = np.delete(points, axis, axis=1)
    assert np.linalg.norm(across, axis=1) == pytest.approx(pair.diameter / 2)


@given(ANGLES, TILTS, PIVOTS)
def test_the_pressed_end_stays_on_its_pivot_and_the_other_rises(heading, tilt, pivot):
    pose = Pose(0.01, -0.02, heading)
    centre, wxyz = body_attitude(pose, pivot, tilt, LENGTH, HEIGHT)
    half = pivot * LENGTH / 2
    pressed, raised = (
        np.array(centre) + rotated(wxyz, np.array([0.0, end, -HEIGHT / 2])) for end in (half, -half)
    )
    assert pressed == pytest.approx([*pivot_point(pose, pivot, LENGTH), 0.0], abs=1e-9)
    assert raised[2] == pytest.approx(LENGTH * math.sin(tilt), abs=1e-9)


@given(ANGLES, PIVOTS)
def test_a_flat_body_looks_where_it_walks(heading, pivot):
    pose = Pose(0.0, 0.0, heading)
    centre, wxyz = body_attitude(pose, pivot, 0.0, LENGTH, HEIGHT)
    assert centre == pytest.approx((0.0, 0.0, HEIGHT / 2), abs=1e-9)
    assert rotated(wxyz, np.array([1.0, 0.0, 0.0])) == pytest.approx(
        [math.cos(heading), math.sin(heading), 0.0], abs=1e-9
    )


def test_arrows_follow_the_currents(arrows):
    currents = (1.0, -2.0, 3.0)
    field = CoilSet().field_at(arrows.origins, currents)
    points, _ = arrows_of(arrows.field(currents), arrows.origins, FULL_FIELD)
    along = points[:, 1] - points[:, 0]
    assert along == pytest.approx(field * ARROW_LENGTH / FULL_FIELD, abs=1e-5)
    assert points.mean(axis=1) == pytest.approx(arrows.origins, abs=1e-9)


def test_opposite_currents_turn_every_arrow_round(arrows):
    fields = (arrows.field((2.0, 1.0, 0.5)), arrows.field((-2.0, -1.0, -0.5)))
    (there, _), (back, _) = (arrows_of(field, arrows.origins, FULL_FIELD) for field in fields)
    assert (there[:, 1] - there[:, 0])[:, :2] == pytest.approx(-(back[:, 1] - back[:, 0])[:, :2])


def test_without_current_there_is_no_arrow_to_see(arrows):
    nothing = arrows.field((0.0, 0.0, 0.0))
    assert not is_visible(nothing)
    assert is_visible(arrows.field((1.0, 0.0, 0.0)))
    points, _ = arrows_of(nothing, arrows.origins, FULL_FIELD)
    assert np.isfinite(points).all()


def test_a_stronger_field_is_brighter():
    brightness = colours(np.linspace(0.0, 1.5, 20)).astype(float) @ [0.299, 0.587, 0.114]
    assert (np.diff(brightness) >= 0.0).all()


def test_the_scale_has_room_for_the_gaits_field_and_seldom_changes():
    """Round numbers: the paper's 10 mT and the 9 mT beside it have the same one."""
    assert full_field(0.010) == full_field(0.009) == FULL_FIELD
    for gait in np.linspace(0.0005, 0.050, 60):
        assert 1.2 * gait <= full_field(gait) * (1 + 1e-9)
    assert full_field(5.0) == SCALES_mT[-1] * 1e-3


def test_the_pages_legend_has_the_colours_of_the_arrows():
    sheet = (Path(web.__file__).parent / "styles" / "scene.css").read_text(encoding="utf-8")
    anchors = re.search(r"linear-gradient\(to right, (.*)\);", sheet)
    assert anchors is not None
    assert [
        [int(part) for part in rgb.split()] for rgb in re.findall(r"rgb\(([\d ]+)\)", anchors[1])
    ] == CIVIDIS.tolist()


@given(st.integers(0, 2000), st.integers(2, 300))
def test_a_long_line_is_thinned_and_keeps_its_ends(count, longest):
    points = np.column_stack([np.arange(count), -np.arange(count)]).astype(float)
    segments = segments_through(points, 0.5, longest)
    assert len(segments) == max(0, min(count, longest) - 1)
    if len(segments):
        assert segments[0, 0].tolist() == [*points[0], 0.5]
        assert segments[-1, 1].tolist() == [*points[-1], 0.5]
        assert (segments[1:, 0] == segments[:-1, 1]).all()


def test_a_square_closes():
    sides = square(3.0, 0.0)
    assert (sides[0, 0] == sides[-1, 1]).all()
    assert np.abs(sides[:, :, :2]).max() == 3.0
