"""What a page costs, by the browser's own measures: time on its stopwatch, time of its main thread, memory."""

from __future__ import annotations

import time
from bisect import bisect_right
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import CDPSession, Page

SCRIPT = frozenset(
    {
        "EvaluateScript",
        "EventDispatch",
        "FireAnimationFrame",
        "FunctionCall",
        "RunMicrotasks",
        "TimerFire",
        "V8.GC_SCAVENGER",
        "V8.GC_MARK_COMPACTOR",
        "v8.callFunction",
    }
)
"""Events of a trace in which scripts run, or are cleaned up after."""

FRAME = "PrePaint"
CATEGORIES = "devtools.timeline,disabled-by-default-devtools.timeline,devtools.timeline.frame,v8,v8.execute"

STANDS = """() => performance.getEntriesByName("dashboard stands").length > 0"""

PAINTS = """() => new Promise((tell) => {
  new PerformanceObserver((list) => tell({
    largest: list.getEntries().at(-1).startTime,
    first: performance.getEntriesByName("first-contentful-paint")[0].startTime,
    stands: performance.getEntriesByName("dashboard stands")[0].startTime,
    modules: performance.getEntriesByType("resource")
      .filter(({ name }) => /\\.m?js$/.test(name)).map(({ transferSize }) => transferSize),
  })).observe({ type: "largest-contentful-paint", buffered: true });
})"""


@dataclass(frozen=True, slots=True)
class Memory:
    """heap: bytes that the page's scripts cannot do without.  nodes, listeners: of its documents."""

    heap: float
    nodes: float
    listeners: float


class Gauge:
    """Reads one page's costs through the browser's protocol."""

    def __init__(self, page: Page) -> None:
        self._page = page
        self._session: CDPSession = page.context.new_cdp_session(page)
        self._session.send("Performance.enable")
        self._session.send("HeapProfiler.enable")

    def memory(self) -> Memory:
        for _ in range(2):
            self._session.send("HeapProfiler.collectGarbage")
        found = self._session.send("Performance.getMetrics")["metrics"]
        metrics = {each["name"]: each["value"] for each in found}
        return Memory(metrics["JSHeapUsedSize"], metrics["Nodes"], metrics["JSEventListeners"])

    def frames(self, duration: float) -> list[float]:
        """Time that scripts took in each frame of the next `duration` s, ms of the main thread."""
        events: list[dict[str, Any]] = []
        ended: list[object] = []
        self._session.on("Tracing.dataCollected", lambda message: events.extend(message["value"]))
        self._session.on("Tracing.tracingComplete", lambda message: ended.append(message))
        self._session.send("Tracing.start", {"categories": CATEGORIES, "transferMode": "ReportEvents"})
        self._page.wait_for_timeout(duration * 1e3)
        self._session.send("Tracing.end")
        deadline = time.monotonic() + 60.0
        while not ended and time.monotonic() < deadline:
            self._page.wait_for_timeout(50)
        return script_times(events)


def script_times(events: list[dict[str, Any]]) -> list[float]:
    """The processor's time of all scripts from the begin of one frame to that of the next, ms.

    Time of the thread, not of the clock: what else the computer does meanwhile is not the page's.
    """
    frames = [event for event in events if event["name"] == FRAME]
    threads = [(event["pid"], event["tid"]) for event in frames]
    own = max(set(threads), key=threads.count)
    begins = sorted(event["ts"] for event in frames if (event["pid"], event["tid"]) == own)
    scripts = [e for e in events if (e["pid"], e["tid"]) == own and e["name"] in SCRIPT and e["ph"] == "X"]
    times = [0.0] * len(begins)
    until = 0
    for event in sorted(scripts, key=lambda event: event["ts"]):
        if event["ts"] < until:
            continue  # part of the one before
        until = event["ts"] + event.get("dur", 0)
        if (frame := bisect_right(begins, event["ts"]) - 1) >= 0:
            times[frame] += event.get("tdur", event.get("dur", 0)) / 1e3
    return times


def percentile(values: list[float], share: float) -> float:
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]
