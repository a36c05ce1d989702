"""A study in the terminal: what it will be, how far it is, and what came of it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Any

import typer
from rich.progress import BarColumn, Progress, TextColumn

from server.commands.outcome import FAILED, REFUSED, console, fail

if TYPE_CHECKING:
    from server.studies.carrying_out import Carried
    from server.studies.progress import BestSet
    from server.studies.progress import Progress as StudyProgress
    from server.studies.study import Study

MINUTE, HOUR, DAY = 60.0, 3600.0, 86400.0


class StudyBar:
    """A progress bar on stderr that stays away when nobody looks at a terminal."""

    def __init__(self, name: str, total: int) -> None:
        self._bar = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(bar_width=24),
            TextColumn("{task.fields[figures]}", markup=False),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(name, total=total, figures=f"0/{total} runs")

    def __enter__(self) -> StudyBar:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def show(self, progress: StudyProgress) -> None:
        self._bar.update(
            self._task, completed=progress.done, total=progress.total, figures=_figures(progress)
        )

    def say(self, words: str) -> None:
        """What is being done just now, in front of the bar."""
        self._bar.update(self._task, description=words)


def _figures(progress: StudyProgress) -> str:
    parts = [f"{progress.done}/{progress.total} runs"]
    if progress.rate > 0.0:
        parts.append(
            f"{progress.rate:.3g} runs/s" if progress.rate < 100.0 else f"{progress.rate:.0f} runs/s"
        )
    if progress.seconds_left is not None:
        parts.append(f"{time_text(progress.seconds_left)} left")
    if progress.failed:
        parts.append(f"{progress.failed} failed")
    if progress.best is not None:
        parts.append(f"best so far {best_text(progress.best)}")
    return ", ".join(parts)


def best_text(best: BestSet) -> str:
    """`0.085 at tilt_deg 25, sweep_deg 30 (10 runs)`."""
    values = ", ".join(f"{name.rpartition('.')[2]} {_value(value)}" for name, value in best.values.items())
    runs = "1 run" if best.runs == 1 else f"{best.runs} runs"
    return f"{best.mean:.4g}{' at ' + values if values else ''} ({runs})"


def _value(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def time_text(seconds: float) -> str:
    """`45 s`, `12 min`, `3.4 h`, `2.1 days`."""
    if seconds < 2.0 * MINUTE:
        return f"{seconds:.0f} s" if seconds >= 1.0 else "under 1 s"
    if seconds < 2.0 * HOUR:
        return f"{seconds / MINUTE:.0f} min"
    return f"{seconds / HOUR:.1f} h" if seconds < 2.0 * DAY else f"{seconds / DAY:.1f} days"


def print_outcome(result: Mapping[str, Any], *, as_json: bool) -> None:
    """One JSON object, or lines for a person; on stdout."""
    if as_json:
        print(json.dumps(result, allow_nan=False, ensure_ascii=False))
        return
    width = max(len(name) for name in result)
    for name, value in result.items():
        shown = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
        print(f"{name:<{width}}  {shown}")


def end_of(study: Study, carried: Carried) -> None:
    """Ends the command with its status, unless the study is finished."""
    if carried.state == "finished":
        return
    status = REFUSED if study.definition.on == "rig" else FAILED
    raise fail(f"{carried.reason}; {how_to_go_on(study)}", status)


def how_to_go_on(study: Study) -> str:
    done = study.tally().done
    return f"{done} runs are done; `pivotrig studies resume {study.id}` goes on"


def say(words: str) -> None:
    typer.echo(words, err=True)
