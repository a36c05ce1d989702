"""What the mirror of the board's field hands on at each tick: enough to know the field at every instant afterwards."""

import math
import random

import pytest

from control.field import Corner, FieldTrace
from control.field_model import FieldModel
from control.model import PIVOT_A, PIVOT_B

TILT = 0.4
RAMP = 0.05
SLEW = 0.010 / 0.3
PERIOD = 1.0 / 60.0


def walk(field: FieldModel, now: float, ticks: int, chance: random.Random) -> tuple[float, list[FieldTrace]]:
    """Swing to and fro and change the end now and then; the time afterwards, and a trace a tick."""
    traces = []
    for _ in range(ticks):
        if chance.random() < 0.1:
            rate = chance.choice((-1.5, 1.5))
            pivot = chance.choice((PIVOT_A, PIVOT_B))
            field.command(pivot, TILT, rate, field.heading + rate * chance.uniform(0.05, 0.5))
        now += PERIOD
        field.advance(now)
        traces.append(field.trace())
    return now, traces


def kept(traces: list[FieldTrace]) -> list[Corner]:
    """All corners that were told, less those that were told anew."""
    corners: list[Corner] = []
    for trace in traces:
        if trace.anew:
            corners = [corner for corner in corners if corner.time < trace.corners[0].time]
        corners += trace.corners
    return corners


def interpolated(corners: list[Corner], time: float) -> tuple[float, float]:
    later = next(index for index, corner in enumerate(corners) if corner.time >= time)
    a, b = corners[max(later - 1, 0)], corners[later]
    share = (time - a.time) / (b.time - a.time) if b.time > a.time else 0.0
    return a.heading + share * (b.heading - a.heading), a.elevation + share * (b.elevation - a.elevation)


def started() -> FieldModel:
    field = FieldModel(RAMP, SLEW)
    field.start(1.0, 0.3, PIVOT_A, TILT, 0.010)
    return field


@pytest.mark.parametrize("seed", range(5))
def test_the_corners_of_all_ticks_are_the_field_s_whole_motion(seed: int) -> None:
    field, chance = started(), random.Random(seed)
    now, traces = walk(field, 1.0, 100, chance)
    corners = kept(traces)
    assert [corner.time for corner in corners] == sorted(corner.time for corner in corners)
    for _ in range(50):
        time = chance.uniform(now - 1.0, now)
        assert interpolated(corners, time) == pytest.approx(
            (field.heading_at(time), field.elevation_at(time)), abs=1e-9
        )


def test_each_corner_is_told_once() -> None:
    field = started()
    _, traces = walk(field, 1.0, 200, random.Random(1))
    times = [corner.time for trace in traces for corner in trace.corners]
    assert len(times) == len(set(times))
    assert [trace.anew for trace in traces] == [True] + 199 * [False]


def test_a_mirror_that_was_wrong_tells_its_corners_anew() -> None:
    field = started()
    now, traces = walk(field, 1.0, 60, random.Random(2))
    field.synchronise(0.5, now, field.heading + 0.3)
    now, after = walk(field, now, 20, random.Random(3))
    assert after[0].anew
    corners = kept(traces + after)
    for time in (now - 0.6, now - 0.3, now - 0.05):
        assert interpolated(corners, time)[0] == pytest.approx(field.heading_at(time), abs=1e-9)


def test_strength_and_its_rise_are_told() -> None:
    field = started()
    off = FieldModel(RAMP, SLEW).trace()
    assert (off.is_on, off.strength, off.full_at) == (False, 0.0, math.inf)
    now, traces = walk(field, 1.0, 30, random.Random(4))
    for tick, trace in enumerate(traces, start=1):
        assert trace.strength == pytest.approx(min(SLEW * tick * PERIOD, 0.010))
        assert trace.full_at == pytest.approx(1.3)
    field.stop(now)
    assert field.trace().strength == 0.0
    assert not field.trace().is_on
