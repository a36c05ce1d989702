"""A run at a glance: at most 2 000 points of what the charts show, gathered while it is recorded."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from control.axes import AXES
from control.snapshot import Snapshot
from server.recording.topics import DEGREES, MILLI

MOST = 2000
"""Points: more than a chart has pixels."""
SPARKLINE = 60
"""Points of the small picture in the list of runs."""

Series = dict[str, float | None]


def point_of(snapshot: Snapshot) -> Series:
    """What the charts show of one tick; null for what is not known."""
    pose, seen = snapshot.pose, snapshot.observation
    found = seen.measurement if seen is not None else None
    x, y = snapshot.reference or (None, None)
    return {
        "error_mm": _times(snapshot.error, MILLI),
        **_place("", (pose.x, pose.y, pose.heading) if pose else None),
        **_place("_measured", (found.pose.x, found.pose.y, found.pose.heading) if found else None),
        "heading_goal_deg": snapshot.command.heading_goal * DEGREES if snapshot.command.field > 0.0 else None,
        "x_reference_mm": _times(x, MILLI),
        "y_reference_mm": _times(y, MILLI),
        **{f"current_{axis}_A": value for axis, value in zip(AXES, snapshot.currents, strict=True)},
        **{f"measured_{axis}_A": value for axis, value in zip(AXES, snapshot.measured_currents, strict=True)},
    }


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


def _place(suffix: str, pose: tuple[float, float, float] | None) -> Series:
    x, y, heading = pose or (None, None, None)
    return {
        f"x{suffix}_mm": _times(x, MILLI),
        f"y{suffix}_mm": _times(y, MILLI),
        f"heading{suffix}_deg": _times(heading, DEGREES),
    }


class Overview:
    """Every tick at first, then every second, every fourth, ...; the newest one is always there."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._stride = 1
        self._ticks = 0
        self._points: list[tuple[float, Series]] = []
        self._newest: tuple[float, Callable[[], Series]] | None = None

    def add(self, time: float, point: Callable[[], Series]) -> None:
        """time: since the start of the run, s.  point: makes the tick's point, where it is wanted."""
        if self._ticks % self._stride == 0:
            self._points.append((time, point()))
            self._newest = None
        else:
            self._newest = time, point
        self._ticks += 1
        if len(self._points) > self._most - 1:
            self._thin_out()

    def _thin_out(self) -> None:
        time, newest = self._points[-1]
        del self._points[1::2]
        self._stride *= 2
        if self._points[-1][0] != time:
            self._newest = time, lambda: newest

    def as_json(self) -> dict[str, list[float | None]]:
        """time_s and the series, all of one length."""
        points = list(self._all())
        names = points[0][1] if points else ()
        series = {name: [point[name] for _, point in points] for name in names}
        return {"time_s": [time for time, _ in points], **series}

    def sparkline(self, count: int = SPARKLINE) -> tuple[float, ...]:
        """Errors over the run, mm, evenly spread."""
        return spread((error for _, point in self._all() if (error := point["error_mm"]) is not None), count)

    def _all(self) -> Iterator[tuple[float, Series]]:
        yield from self._points
        if self._newest is not None:
            time, point = self._newest
            yield time, point()


def spread(values: Iterable[float], count: int = SPARKLINE) -> tuple[float, ...]:
    """At most `count` of them, evenly: the first and the last are among them."""
    all = tuple(values)
    if len(all) <= count:
        return all
    return tuple(all[index * (len(all) - 1) // (count - 1)] for index in range(count))
