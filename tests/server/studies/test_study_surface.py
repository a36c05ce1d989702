"""The picture of what an auto-tune has learned."""

from __future__ import annotations

import numpy as np
import pytest

from control.studies.tuning import Sample, Surface
from server.reports.drawing import svg
from server.reports.study.surface import draw_surface

TILTS = (10, 20, 30)


def surface_over(name: str, marks: tuple[object, ...], best: object) -> Surface:
    """Tilt to the right, something else up; the middle was lost."""
    shape = (len(marks), len(TILTS))
    samples = tuple(
        Sample({"gait.tilt_deg": tilt, name: mark}, None if tilt == 20 else 0.3)
        for tilt in TILTS
        for mark in marks
    )
    return Surface(
        "normalized_mean_error", ("gait.tilt_deg", name), (TILTS, marks),
        np.linspace(0.2, 0.4, shape[0] * 3).reshape(shape), np.full(shape, 0.02), samples,
        {"gait.tilt_deg": 10, name: best},
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "marks", "best"),
    [("gait.sweep_deg", (10.0, 25.0, 40.0), 25.0), ("controller", ("geometric", "gradient"), "gradient")],
)
def test_a_map_names_its_axes_the_best_place_and_what_failed(
    name: str, marks: tuple[object, ...], best: object
) -> None:
    picture = svg(draw_surface(surface_over(name, marks, best))).decode()
    for word in ("tilt, °", "expected ME", "uncertainty", "failed runs", "best"):
        assert word in picture
    assert ("gradient" in picture) == (best == "gradient")


def test_one_axis_is_a_line_with_its_runs() -> None:
    samples = (Sample({"gait.tilt_deg": 20}, 0.3), Sample({"gait.tilt_deg": 30}, None))
    line = Surface(
        "mean_error_mm", ("gait.tilt_deg",), (TILTS,), np.array([0.3, 0.2, 0.25]), np.full(3, 0.02), samples,
        {"gait.tilt_deg": 20},
    )  # fmt: skip
    picture = svg(draw_surface(line)).decode()
    for word in ("tilt, °", "Mean error, mm", "expected, with 95 %", "runs", "best"):
        assert word in picture
