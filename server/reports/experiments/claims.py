"""All statements of section 6, in the order of the paper."""

from __future__ import annotations

from server.reports.experiments import rig_claims, scatter_claims, sweep_claims, tilt_claims
from server.reports.experiments.carrying import Tables
from server.reports.experiments.designs import DISTRIBUTIONS, PARAMETRIC, RIGID, TILTS
from server.reports.experiments.measured import Measured
from server.reports.experiments.scatter_claims import Scatter, scatter_of
from server.reports.findings import Finding


def scatter(tables: Tables) -> Scatter:
    table = tables[DISTRIBUTIONS]
    return scatter_of(Measured.of(table), Measured.of(table, "steps"))


def findings(tables: Tables, laws: Scatter) -> list[Finding]:
    parametric = Measured.of(tables[PARAMETRIC])
    ends = Measured.of(tables[PARAMETRIC], "end_error_mm")
    rigid = Measured.of(tables[RIGID]) if RIGID in tables else None
    return [
        *rig_claims.of_rig(),
        *tilt_claims.of_plants(Measured.of(tables[TILTS]), rigid),
        *tilt_claims.of_study(parametric),
        *sweep_claims.of_path_step(parametric, ends),
        *sweep_claims.of_sweep(parametric),
        *scatter_claims.of_scatter(laws),
    ]
