"""Runs carried out by several workers, with the results in the order of the runs whoever was first."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError, Future, TimeoutError
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from control.studies.batch.outcome import Failed
from control.studies.chunks import Chunk, Done, Outcome, WorkersLost, chunk_of
from control.studies.crews import Crew, engaged, lost
from control.studies.plan import PlannedRun

__all__ = ["Failed", "Result", "Workers", "WorkersLost", "carry_out", "hired"]

Result = tuple[int, Outcome]
"""Index of a run in its plan, and what came of it."""

CHUNK = 0.3
"""A chunk of work should take so long, s: far longer than handing it over, short beside a study."""
MOST = 64
"""Runs in a chunk, at most."""
PATIENCE = 0.2
"""Between two looks whether the workers are still there, s; also how long Ctrl-C waits."""
NEWEST = 0.5
"""Weight of the newest of the times that a kind of run took."""

Kind = tuple[str, str, str]
"""Controller, plant and trajectory: runs of the same take about as long."""


def carry_out(runs: Iterable[PlannedRun], jobs: int = 0, dask: str | None = None) -> Iterator[Result]:
    """What came of each run, in the order of the runs. Runs are taken as they are needed, so there may be many.

    jobs: processes of this computer; 0: one a core; 1: this process alone.  dask: address of a scheduler instead.
    Results do not depend on either. Closing the iterator ends all workers. Raises `WorkersLost`.
    """
    with hired(jobs, dask) as workers:
        yield from workers.carry_out(runs)


@contextmanager
def hired(jobs: int = 0, dask: str | None = None) -> Iterator[Workers]:
    """Workers for several rounds of runs, as `carry_out` has them for one."""
    with engaged(jobs, dask) as crew:
        yield Workers(crew)


class Workers:
    """A crew, and what is known of how long its work takes."""

    def __init__(self, crew: Crew) -> None:
        self._crew = crew
        self._pace = Pace()

    def carry_out(self, runs: Iterable[PlannedRun]) -> Iterator[Result]:
        """In the order of the runs; raises `WorkersLost`."""
        for some in self.in_chunks(runs):
            for run, outcome in some:
                yield run.index, outcome

    def in_chunks(self, runs: Iterable[PlannedRun]) -> Iterator[list[tuple[PlannedRun, Outcome]]]:
        """The same, as many at once as were done together; raises `WorkersLost`."""
        runs, pending = iter(runs), deque[tuple[Chunk, Future[Done]]]()
        while True:
            self._give_out(runs, pending)
            if not pending:
                return
            chunk, future = pending.popleft()
            done = _awaited(future, self._crew)
            for run, elapsed in zip(chunk.runs, done.elapsed, strict=True):
                self._pace.note(run, elapsed)
            yield list(zip(chunk.runs, done.outcomes, strict=True))

    def _give_out(self, runs: Iterator[PlannedRun], pending: deque[tuple[Chunk, Future[Done]]]) -> None:
        while len(pending) < self._crew.window and (some := self._pace.take(runs)):
            chunk = chunk_of(some)
            pending.append((chunk, self._crew.submit(chunk)))


def _awaited(future: Future[Done], crew: Crew) -> Done:
    """Raises `WorkersLost`, in words, for everything that can happen to a worker."""
    while True:
        try:
            return future.result(PATIENCE)
        except TimeoutError as error:
            if future.done():
                raise WorkersLost(f"a worker gave up: {error}") from error
            crew.check()
        except WorkersLost:
            raise
        except BrokenProcessPool as error:
            raise lost(error) from error
        except CancelledError as error:
            crew.check()
            raise WorkersLost("the cluster has let go of this study's work; start it again") from error
        except Exception as error:  # the boundary to other computers, which may fail in any way
            raise WorkersLost(f"a worker cannot do its work: {type(error).__name__}: {error}") from error


class Pace:
    """How many runs make a chunk: as many as take some tenths of a second, by what such runs took so far."""

    def __init__(self) -> None:
        self._took: dict[Kind, float] = {}

    def note(self, run: PlannedRun, elapsed: float) -> None:
        """elapsed: how long it took, s."""
        kind = _kind(run)
        before = self._took.get(kind, elapsed)
        self._took[kind] = NEWEST * elapsed + (1.0 - NEWEST) * before

    def take(self, runs: Iterator[PlannedRun]) -> tuple[PlannedRun, ...]:
        """The next chunk; empty when there are no more runs. A run of a kind that is not known yet ends it."""
        chunk, left = list[PlannedRun](), CHUNK
        while left > 0.0 and len(chunk) < MOST and (run := next(runs, None)) is not None:
            chunk.append(run)
            left -= self._took.get(_kind(run), CHUNK)
        return tuple(chunk)


def _kind(run: PlannedRun) -> Kind:
    return run.selection.controller.name, run.plant.name, run.selection.trajectory.name
