"""The figure of a run of hours: as small as that of minutes, and with every peak."""

import numpy as np
import pytest

from server.exports.run_figure import MOST_DRAWN, About, Walked, drawn, evenly

COUNT = 300_000
"""Ticks of an hour and a half."""
PEAK = 123_457
"""The one at which the error has its peak."""
GAP = slice(200_000, 210_000)
"""Ticks that have no error."""


@pytest.fixture(scope="module")
def figure():
    time = np.arange(COUNT) / 60.0
    x, y = np.cos(time), np.sin(time)
    error = np.full(COUNT, 1.0)
    error[PEAK], error[GAP] = 9.0, np.nan
    run = Walked(time, x, y, x, y, error, time, np.ones(COUNT))
    return drawn(run, About("", "", None))


def test_no_line_has_more_points_than_a_screen_can_tell_apart(figure):
    lines = [line for axes in figure.axes for line in axes.lines]
    assert 0 < max(len(line.get_xdata()) for line in lines) <= MOST_DRAWN


def test_a_peak_of_one_tick_and_a_gap_are_drawn_where_they_are(figure):
    times, errors = figure.axes[1].lines[0].get_data()
    assert errors[times == PEAK / 60.0] == [9.0]
    assert np.nanmax(errors) == 9.0
    inside = (times > GAP.start / 60.0 + 1.0) & (times < GAP.stop / 60.0 - 1.0)
    assert inside.any()
    assert np.isnan(errors[inside]).all()


@pytest.mark.parametrize("count", [0, 1, 2, MOST_DRAWN - 1, MOST_DRAWN, MOST_DRAWN + 1, 10 * MOST_DRAWN])
def test_both_ends_are_kept_and_no_point_comes_twice(count):
    points = evenly(count)
    assert len(points) == min(count, MOST_DRAWN)
    assert np.all(np.diff(points) > 0)
    assert list(points[[0, -1]] if count else points) == ([0, count - 1] if count else [])
