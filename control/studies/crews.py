"""Who does the work: this process, or processes of this computer."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Protocol

from control.studies.chunks import Chunk, Done, WorkersLost, work
from control.studies.offspring import stay_with

AHEAD = 3
"""Chunks given out for each worker: one that it does, and what it will do while somebody waits for a slow one."""
ONE_THREAD = {
    f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "BLIS", "NUMBA", "VECLIB_MAXIMUM")
}
"""A worker is one thread: there is a worker for each core already."""


class Crew(Protocol):
    """Some workers. window: chunks that it takes at once; more would only wait in memory."""

    @property
    def window(self) -> int: ...

    def submit(self, chunk: Chunk) -> Future[Done]: ...

    def check(self) -> None:
        """Called while somebody waits; raises `WorkersLost` when nothing will come any more."""
        ...


class Alone:
    """This process, while somebody waits."""

    window = 1

    def submit(self, chunk: Chunk) -> Future[Done]:
        future: Future[Done] = Future()
        future.set_result(work(chunk))
        return future

    def check(self) -> None:
        """It is here."""


class Processes:
    """Processes of this computer, by joblib's executor."""

    def __init__(self, jobs: int) -> None:
        from joblib.externals.loky import ProcessPoolExecutor

        self.window = AHEAD * jobs
        self._pool = ProcessPoolExecutor(jobs, initializer=stay_with, initargs=(os.getpid(),), env=ONE_THREAD)

    def submit(self, chunk: Chunk) -> Future[Done]:
        try:
            return self._pool.submit(work, chunk)
        except BrokenProcessPool as error:
            raise lost(error) from error

    def check(self) -> None:
        """A worker that dies breaks what it works on, which tells."""

    def close(self, *, at_once: bool) -> None:
        """Every worker is gone when this returns. at_once: in the middle of what it does."""
        self._pool.shutdown(wait=True, kill_workers=at_once)


def lost(error: BaseException) -> WorkersLost:
    return WorkersLost(
        "a worker process ended by itself; when memory was short, use fewer with --jobs "
        f"({str(error).splitlines()[0] if str(error) else type(error).__name__})"
    )


@contextmanager
def engaged(jobs: int, dask: str | None) -> Iterator[Crew]:
    """The workers that are asked for, and no trace of them afterwards.

    jobs: processes, 0 for one a core.  dask: a scheduler's address, None for none.  Raises `WorkersLost`.
    """
    if dask is not None:
        from control.studies.dask_crew import Cluster

        cluster = Cluster(dask)
        try:
            yield cluster
        finally:
            cluster.close()
    elif (jobs or cores()) == 1:
        yield Alone()
    else:
        processes = Processes(jobs or cores())
        try:
            yield processes
        except BaseException:
            processes.close(at_once=True)
            raise
        processes.close(at_once=False)


def cores() -> int:
    """Processor cores that this process may use."""
    return len(os.sched_getaffinity(0))
