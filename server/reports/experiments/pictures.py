"""The figures of section 6."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from matplotlib.figure import Figure

from control.simulation.rigid.tilt_study import TiltPoint
from control.studies.table import StudyRow, StudyTable
from server.reports.drawing import png
from server.reports.experiments.carrying import Tables
from server.reports.experiments.designs import DISTRIBUTIONS, PARAMETRIC, RIGID, TILTS, Experiment
from server.reports.experiments.measured import NAMES, Measured
from server.reports.experiments.scatter_claims import LABELS, PAPERS, PLANNER, SETS, Scatter
from server.reports.page import Picture
from server.reports.rigid_tilt import rigid_tilt
from server.reports.study.histograms import histograms
from server.reports.study.layout import STEP, SWEEP, TILT, Layout
from server.reports.study.lines import lines
from server.reports.study.trajectories import Walked, trajectories
from server.reports.study.walks import WalkedAgain

Studies = Mapping[str, Experiment]


def of_studies(tables: Tables) -> list[Picture]:
    """ME over tilt, path step and sweep."""
    whole = Measured.of(tables[PARAMETRIC])
    tilts = Measured.of(tables[TILTS])
    drawn = [
        ("tilt_at_10", "ME over the tilt at a sweep of 10° (paper: first figure of ME, a).",
         lines(whole.only(sweep=10).samples, Layout(TILT, STEP, None, ()))),
        ("step_at_10", "ME over the path step at a sweep of 10° (paper: first figure of ME, b).",
         lines(whole.only(sweep=10).samples, Layout(STEP, TILT, None, ()))),
        ("tilt_by_sweep", "ME over the tilt for each sweep and path step (paper: second figure of ME).",
         lines(whole.samples, Layout(TILT, SWEEP, STEP, ()))),
        ("sweep_by_tilt", "The same over the sweep.", lines(whole.samples, Layout(SWEEP, TILT, STEP, ()))),
        *(
            (f"plants_at_{sweep}", f"ME over 10° to 35° of tilt at a sweep of {sweep}°, on two plants.",
             lines(tilts.only(sweep=sweep).samples, Layout(TILT, STEP, "plant", ())))
            for sweep in (10, 30)
        ),
    ]  # fmt: skip
    return [_picture(*one) for one in drawn]


def of_rigid(tables: Tables, points: Sequence[TiltPoint]) -> list[Picture]:
    """The rigid plant: ME over the tilt, and what its pivot switches do; nothing where it did not take part."""
    if RIGID not in tables or not points:
        return []
    over = lines(Measured.of(tables[RIGID]).samples, Layout(TILT, SWEEP, None, ()))
    return [
        _picture(
            "rigid", "ME over the tilt on the rigid plant, Δt = 0.1 s, the first 40 s of an eight.", over
        ),
        _picture(
            "rigid_switches",
            "What a pivot switch of the rigid plant does, over the tilt.",
            rigid_tilt(points),
        ),
    ]


def of_scatter(found: Scatter) -> Picture:
    panels = {
        f"sweep {sweep}°, tilt {tilt}°": {LABELS[c]: found.laws[c, sweep, tilt] for c in (*PAPERS, PLANNER)}
        for sweep, tilt in SETS
    }
    caption = "How ME scatters over the runs of each set (paper: figure of distributions)."
    return _picture("scatter", caption, histograms(panels, "ME"))


def of_paths(studies: Studies, tables: Tables) -> list[Picture]:
    """One run of some sets, walked once more."""
    tilts = [
        {NAMES["sweep"]: 10, NAMES["tilt"]: tilt, NAMES["step"]: step}
        for step in (0.1, 0.2, 0.3)
        for tilt in (20, 25, 30)
    ]
    sweeps = [
        {NAMES["sweep"]: sweep, NAMES["tilt"]: 25, NAMES["step"]: 0.2} for sweep in (10, 15, 20, 25, 30, 40)
    ]
    both = [{"controller": c, NAMES["sweep"]: s, NAMES["tilt"]: t} for c in PAPERS for s, t in SETS]
    drawn = (
        ("paths_tilt", "One eight at a sweep of 10°: tilt from left to right, path step from above (paper: first "
         "figure of paths).", PARAMETRIC, tilts),
        ("paths_sweep", "One eight at a tilt of 25°, Δt = 0.2 s (paper: second figure of paths).", PARAMETRIC, sweeps),
        ("paths_controllers", "Gb above, Ob below, Δt = 0.1 s (paper: third figure of paths).", DISTRIBUTIONS, both),
    )  # fmt: skip
    found = []
    for name, caption, key, wanted in drawn:
        walks = list(_walks(studies[key], tables[key], wanted))
        if walks:
            found.append(_picture(name, caption, trajectories(walks, 3)))
    return found


def _walks(study: Experiment, table: StudyTable, wanted: Iterable[Mapping[str, object]]) -> Iterable[Walked]:
    again = WalkedAgain(study.definition)
    for values in wanted:
        row = _first(table, values)
        walked = None if row is None else again(row, _title(values))
        if walked is not None:
            yield walked


def _first(table: StudyTable, values: Mapping[str, object]) -> StudyRow | None:
    """The first finished run at these values."""
    return next(
        (
            row
            for row in table.rows
            if row.state == "finished" and all(row.values[axis] == value for axis, value in values.items())
        ),
        None,
    )


def _title(values: Mapping[str, object]) -> str:
    shown = {"controller": "{}", SWEEP: "sweep {}°", TILT: "tilt {}°", STEP: "Δt {} s"}
    return ", ".join(shown[axis].format(LABELS.get(str(value), value)) for axis, value in values.items())


def _picture(name: str, caption: str, figure: Figure) -> Picture:
    return Picture(name, caption, png(figure))
