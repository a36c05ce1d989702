"""The figures of a run as everybody outside sees them: REST, the command line, recordings and their catalogue."""

from __future__ import annotations

from typing import Any

from control.metrics import Metrics
from server.api.ticks import MILLI, number, scaled


def metrics_json(metrics: Metrics) -> dict[str, Any]:
    return {
        "mean_error_mm": scaled(metrics.mean_error, MILLI, 6),
        "normalized_mean_error": number(metrics.normalized_mean_error, 6),
        "rms_error_mm": scaled(metrics.rms_error, MILLI, 6),
        "max_error_mm": scaled(metrics.max_error, MILLI, 6),
        "end_error_mm": scaled(metrics.end_error, MILLI, 6),
        "travelled_mm": scaled(metrics.travelled, MILLI),
        "duration_s": number(metrics.duration),
        "ticks": metrics.ticks,
        "steps": metrics.steps,
        "sweeps": metrics.sweeps,
        "reversals": metrics.reversals,
    }
