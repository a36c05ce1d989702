"""What one worker is given at a time, and does: some runs, one after the other."""

from __future__ import annotations

import hashlib
import threading
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from control import plugins
from control.metrics import Metrics
from control.simulation.plants import MissingExtra
from control.studies.arithmetic import Ground, ground
from control.studies.batch.outcome import Failed
from control.studies.plan import PlannedRun

Outcome = Metrics | Failed
"""What comes of one run."""

_loading = threading.Lock()
_loaded: set[str] = set()


class WorkersLost(Exception):
    """Whoever does the work cannot go on; the text says why and what to do. What is done stays done."""


@dataclass(frozen=True, slots=True)
class PluginFile:
    """path: absolute.  text: a digest of what was in it when it was loaded."""

    path: str
    text: str


@dataclass(frozen=True, slots=True)
class Chunk:
    """runs: in their order.  plugins: of controllers and trajectories.  ground: what the results rest on."""

    runs: tuple[PlannedRun, ...]
    plugins: tuple[PluginFile, ...]
    ground: Ground


@dataclass(frozen=True, slots=True)
class Done:
    """One of each for every run, in the chunk's order. elapsed: how long it took, s."""

    outcomes: tuple[Outcome, ...]
    elapsed: tuple[float, ...]


def chunk_of(runs: tuple[PlannedRun, ...]) -> Chunk:
    """With all that a process elsewhere has to know."""
    paths = (str(path.resolve()) for path in plugins.loaded_files())
    return Chunk(runs, tuple(PluginFile(path, _text(path)) for path in paths), ground())


def work(chunk: Chunk) -> Done:
    """In a worker. Raises `WorkersLost` where this process cannot give the results that are wanted."""
    _get_ready(chunk)
    from control.studies.batch import simulate

    outcomes, elapsed = [], []
    for run in chunk.runs:
        began = time.perf_counter()
        try:
            [outcome] = simulate([run])
        except MissingExtra as error:
            raise WorkersLost(f"a worker cannot go on: {error}") from error
        outcomes.append(outcome)
        elapsed.append(time.perf_counter() - began)
    return Done(tuple(outcomes), tuple(elapsed))


def _get_ready(chunk: Chunk) -> None:
    if differences := chunk.ground.differences(ground()):
        raise WorkersLost(
            f"a worker is not like this program ({'; '.join(differences)}), so its results could differ; "
            "install the same versions there"
        )
    with _loading:
        _load_plugins(tuple(plugin.path for plugin in chunk.plugins))
    for plugin in chunk.plugins:
        if plugin.text != _text(plugin.path):
            raise WorkersLost(
                f"a worker has another text of the plug-in {plugin.path} than this program, so its results would "
                "differ; give it the same file and start it again"
            )


@cache
def _text(path: str) -> str:
    """A digest of the file as this process met it first: one that is changed later is not loaded again."""
    try:
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()
    except OSError:
        return ""


def _load_plugins(files: tuple[str, ...]) -> None:
    present = {str(path.resolve()) for path in plugins.loaded_files()}
    wanted = [file for file in files if file not in _loaded | present]
    if wanted and not _loaded:
        plugins.load_installed()
    for file in wanted:
        try:
            plugins.load_file(Path(file))
        except plugins.PluginError as error:
            raise WorkersLost(f"a worker cannot use a plug-in: {error}") from error
        _loaded.add(file)
