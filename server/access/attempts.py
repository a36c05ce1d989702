"""How often somebody may be wrong about a token."""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Callable

WINDOW = 60.0
"""s"""
FROM_ONE = 10
"""Wrong tokens from one site within the window: a person who mistypes, not a program that tries."""
FROM_ALL = 100
"""Wrong tokens from everywhere within the window."""
SITES = 1000
"""Sites that are remembered; the oldest is forgotten first, and the limit for all remains."""


class Attempts:
    """Counts failures; clock: monotonic, s."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._all: deque[float] = deque(maxlen=FROM_ALL)
        self._sites: OrderedDict[str, deque[float]] = OrderedDict()

    def wait(self, site: str) -> float:
        """How long this site must not try again, s; 0 when it may."""
        own = self._sites.get(site)
        return max(self._full_for(self._all), self._full_for(own) if own is not None else 0.0)

    def fail(self, site: str) -> None:
        now = self._clock()
        own = self._sites.setdefault(site, deque(maxlen=FROM_ONE))
        own.append(now)
        self._all.append(now)
        self._sites.move_to_end(site)
        while len(self._sites) > SITES:
            self._sites.popitem(last=False)

    def _full_for(self, failures: deque[float]) -> float:
        if len(failures) < (failures.maxlen or 0):
            return 0.0
        return max(0.0, failures[0] + WINDOW - self._clock())
