"""The figures of a rig for Prometheus, read from the newest snapshot when somebody asks: nothing is spent between.

Units are base units and stand in the names; counters count since the program began.
"""

from __future__ import annotations

import gc
import math
import os
import resource
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from prometheus_client import CollectorRegistry, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, InfoMetricFamily, Metric
from prometheus_client.registry import Collector

from control.model import Tracking
from control.snapshot import RigState, Snapshot
from server.watching.tally import KINDS

if TYPE_CHECKING:
    from server.rig import Rig
    from server.watching.tally import ClientTally, EventTally, RigTally

CONTENT_TYPE = "text/plain; version=0.0.4; charset=utf-8"
KEPT = 0.5
"""An answer serves everybody who asks within this time, s: to make it takes 2 ms of the loop's interpreter."""
AXES = ("x", "y", "z")
PAGE = os.sysconf("SC_PAGE_SIZE")

Labelled = Mapping[str, float | None]


class Exposition:
    """The text of all figures."""

    def __init__(
        self, rig: Rig, ticks: RigTally, events: EventTally, clients: ClientTally, version: str
    ) -> None:
        self._registry = CollectorRegistry(auto_describe=False)
        self._registry.register(RigCollector(rig, ticks, events, clients, version))
        self._made_at = -math.inf
        self._text = b""

    def text(self, now: Callable[[], float] = time.monotonic) -> bytes:
        if now() - self._made_at > KEPT:
            self._text = generate_latest(self._registry)
            self._made_at = now()
        return self._text


class RigCollector(Collector):
    """Reads; it changes nothing and waits for nothing."""

    def __init__(
        self, rig: Rig, ticks: RigTally, events: EventTally, clients: ClientTally, version: str
    ) -> None:
        self._rig = rig
        self._ticks = ticks
        self._events = events
        self._clients = clients
        self._version = version

    def collect(self) -> Iterator[Metric]:
        snapshot = self._rig.snapshot
        yield InfoMetricFamily("pivotrig_build", "The program.", value={"version": self._version})
        yield from self._rig_figures(snapshot)
        yield from loop_figures(snapshot, self._ticks.ticks)
        yield from tracking_figures(snapshot)
        yield from link_figures(snapshot)
        yield from coil_figures(snapshot)
        yield from recorder_figures(snapshot)
        yield from self._client_figures()
        yield from process_figures()

    def _rig_figures(self, snapshot: Snapshot) -> Iterator[Metric]:
        states = {state.value: float(state is snapshot.rig) for state in RigState}
        yield gauge("rig_state", "1 for the state that the rig is in.", states, "state")
        entered = {state.value: self._ticks.entered[state.value] for state in RigState}
        yield counter("rig_state_entered", "How often the rig went into a state.", entered, "state")
        yield gauge("rig_simulated", "1 for a simulated rig.", float(snapshot.simulated))
        yield gauge("rig_faults", "Faults that are there now.", float(len(snapshot.faults)))
        events = CounterMetricFamily(
            "pivotrig_events", "Lines of the event log.", labels=("severity", "code")
        )
        for (severity, code), count in list(self._events.events.items()):
            events.add_metric((severity, code), count)
        yield events
        running = snapshot.run
        yield gauge("run_active", "1 while a run goes on.", float(running is not None))
        error = running.mean_error if running is not None else None
        yield gauge("run_mean_error_meters", "Mean distance from the path in this run.", error)

    def _client_figures(self) -> Iterator[Metric]:
        opened = {kind: float(self._clients.open[kind]) for kind in KINDS}
        yield gauge(
            "clients", "Connections that are open, and requests that are being answered.", opened, "kind"
        )
        answers = {kind: self._clients.requests[kind] for kind in ("1xx", "2xx", "3xx", "4xx", "5xx")}
        yield counter("http_responses", "Answers by the class of their status.", answers, "status")


def loop_figures(snapshot: Snapshot, ticks: int) -> Iterator[Metric]:
    timing = snapshot.timing
    yield counter("loop_ticks", "Ticks of the control loop.", ticks)
    yield gauge("loop_rate_hertz", "Ticks a second.", timing.rate)
    yield gauge("loop_period_p99_seconds", "99th percentile of the time between ticks.", timing.period_p99)
    latency = {"0.5": timing.latency_p50, "0.99": timing.latency_p99}
    yield gauge("loop_latency_seconds", "From a frame to the bytes of its command.", latency, "quantile")
    yield counter("loop_dropped_frames", "Frames that came too fast to be used.", timing.dropped_frames)
    yield gauge(
        "camera_latency_seconds", "From mid-exposure until the frame is here.", snapshot.camera.latency
    )
    yield gauge("camera_rate_hertz", "Frames a second.", snapshot.camera.rate)


def tracking_figures(snapshot: Snapshot) -> Iterator[Metric]:
    states = {state.value: float(state is snapshot.tracking) for state in Tracking}
    yield gauge("tracking_state", "1 for the state of the track.", states, "state")
    yield gauge("tracking_age_seconds", "Since the robot was last seen.", snapshot.tracking_age)
    x, y, heading = snapshot.pose_sigma
    yield gauge("pose_sigma_meters", "Standard deviation of the place.", {"x": x, "y": y}, "axis")
    yield gauge("pose_sigma_heading_radians", "Standard deviation of the heading.", heading)
    yield gauge("path_error_meters", "Distance from the desired point.", snapshot.error)
    refused = snapshot.refusals
    counts = {"frames": refused.frames, "sightings": refused.sightings, "reports": refused.reports}
    yield counter("refused_inputs", "What was not let in: pictures, sightings, reports.", counts, "kind")


def link_figures(snapshot: Snapshot) -> Iterator[Metric]:
    link, counts = snapshot.link, snapshot.link.counts
    yield gauge("link_ready", "1 while the board obeys.", float(link.state == "ready"))
    trips = {"0.5": link.round_trip_median, "0.99": link.round_trip_p99}
    yield gauge("link_round_trip_seconds", "From a command to its echo.", trips, "quantile")
    yield gauge("link_bad_ratio", "Share of broken messages in the last second.", link.bad_share)
    yield counter(
        "link_messages", "Messages over the link.", {"sent": counts.sent, "received": counts.received}, "way"
    )
    broken = dict.fromkeys(sorted(counts.broken), 0.0) | {kind: float(n) for kind, n in counts.broken.items()}
    yield counter("link_broken_messages", "Received messages that were dropped.", broken, "cause")
    yield counter("link_resends", "Questions that had to be asked again.", counts.resends)
    yield counter("link_reconnects", "How often a lost port was opened again.", counts.reconnects)
    yield gauge("supply_volts", "The coils' supply.", link.supply)


def coil_figures(snapshot: Snapshot) -> Iterator[Metric]:
    yield gauge("coil_current_amperes", "Commanded.", by_axis(snapshot.currents), "axis")
    yield gauge(
        "coil_measured_current_amperes", "Sensed by the board.", by_axis(snapshot.measured_currents), "axis"
    )
    yield gauge(
        "coil_heat_ratio", "Share of the heat that a coil may have.", by_axis(snapshot.coil_heat), "axis"
    )
    yield gauge(
        "field_teslas", "At the robot, made by the commanded currents.", by_axis(snapshot.field), "axis"
    )
    yield gauge("field_limited", "1 while a limit holds the command back.", float(bool(snapshot.limited_by)))


def recorder_figures(snapshot: Snapshot) -> Iterator[Metric]:
    recording = snapshot.recording
    states = {state: float(state == recording.state) for state in ("off", "recording", "failed")}
    yield gauge("recorder_state", "1 for the state of the recorder.", states, "state")
    yield gauge("recorder_file_bytes", "Of the recording that is being written.", float(recording.size))
    yield gauge("recorder_waiting_ticks", "Ticks that wait to be written.", float(recording.ticks_waiting))
    yield gauge(
        "recorder_left_out_frames", "Pictures left out of this recording.", float(recording.frames_left_out)
    )


def process_figures() -> Iterator[Metric]:
    used = resource.getrusage(resource.RUSAGE_SELF)
    yield counter("process_cpu_seconds", "Processor time.", used.ru_utime + used.ru_stime)
    resident = int(Path("/proc/self/statm").read_text().split()[1]) * PAGE
    yield gauge("process_resident_memory_bytes", "Memory.", float(resident))
    yield gauge("process_open_fds", "Open files and sockets.", float(len(os.listdir("/proc/self/fd"))))
    yield gauge("process_threads", "Threads of Python.", float(threading.active_count()))
    collections = {str(number): float(each["collections"]) for number, each in enumerate(gc.get_stats())}
    yield counter("process_gc_collections", "Searches for garbage.", collections, "generation")


def by_axis(values: Iterable[float]) -> dict[str, float | None]:
    return dict(zip(AXES, values, strict=True))


def gauge(name: str, words: str, value: float | Labelled | None, label: str = "") -> Metric:
    """What is unknown is left out, as is what is no number."""
    family = GaugeMetricFamily(f"pivotrig_{name}", words, labels=(label,) if label else None)
    return filled(family, value)


def counter(name: str, words: str, value: float | Labelled, label: str = "") -> Metric:
    family = CounterMetricFamily(f"pivotrig_{name}", words, labels=(label,) if label else None)
    return filled(family, value)


def filled(family: GaugeMetricFamily | CounterMetricFamily, value: float | Labelled | None) -> Metric:
    samples = value.items() if isinstance(value, Mapping) else [(None, value)]
    for label, each in samples:
        if each is not None and math.isfinite(each):
            family.add_metric([] if label is None else [label], each)
    return family
