"""Workers of a Dask cluster: other computers, when one is not enough."""

from __future__ import annotations

import time
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

from control.studies.chunks import Chunk, Done, WorkersLost, work
from control.studies.crews import AHEAD

if TYPE_CHECKING:
    from distributed import Client

CONNECTING = 10.0
"""The scheduler answers within this time, s, or is not there."""
WITHOUT_WORKERS = 60.0
"""A cluster may be without any worker for so long, s: they start slowly, and come back after a restart."""
LOOK = 2.0
"""Between two questions who works, s."""
RUNNING = "running"


class Cluster:
    """One scheduler. Dask gives the work of a worker that was lost to another one by itself."""

    def __init__(self, address: str) -> None:
        """Raises `WorkersLost` where nobody answers."""
        self._address = address
        self._client = _connected(address)
        self._executor = self._client.get_executor(pure=False)
        self._workers, self._looked = 0, -LOOK
        self._seen = time.monotonic()

    @property
    def window(self) -> int:
        return AHEAD * max(self._present(), 1)

    def submit(self, chunk: Chunk) -> Future[Done]:
        try:
            return self._executor.submit(work, chunk)
        except (OSError, RuntimeError) as error:
            raise self._gone(str(error)) from error

    def check(self) -> None:
        self._present()
        waited = time.monotonic() - self._seen
        if waited > WITHOUT_WORKERS and not self._is_connected:
            raise self._gone(f"no answer for {waited:.0f} s")
        if waited > WITHOUT_WORKERS:
            raise WorkersLost(
                f"the Dask cluster {self._address} has had no worker for {waited:.0f} s; "
                f"start some with `dask worker {self._address}`"
            )

    def close(self) -> None:
        """What has not been done is let go of."""
        self._executor.shutdown(wait=False)
        self._client.close(timeout=CONNECTING)

    @property
    def _is_connected(self) -> bool:
        return self._client.status == RUNNING

    def _present(self) -> int:
        """Threads of all workers; asked every two seconds."""
        now = time.monotonic()
        if now - self._looked >= LOOK:
            self._looked = now
            self._workers = self._count()
            if self._workers:
                self._seen = time.monotonic()
        return self._workers

    def _count(self) -> int:
        scheduler = self._client.scheduler
        if scheduler is None or not self._is_connected:
            return 0
        try:
            found: Any = self._client.sync(scheduler.ncores, callback_timeout=CONNECTING)
        except (OSError, TimeoutError):
            return 0
        return sum(found.values())

    def _gone(self, what: str) -> WorkersLost:
        return WorkersLost(
            f"the Dask scheduler {self._address} is gone ({what}); start it again, or go on without --dask"
        )


def _connected(address: str) -> Client:
    try:
        from distributed import Client
    except ImportError as error:
        raise WorkersLost(
            "--dask needs the extra `cluster`: install it with `uv sync --extra cluster`, "
            "or `pip install 'pivotrig[cluster]'`"
        ) from error
    try:
        return Client(address, timeout=CONNECTING, set_as_default=False, name="pivotrig study")
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        first = (str(error) or type(error).__name__).splitlines()[0]
        raise WorkersLost(
            f"no Dask scheduler answers at {address}: {first}; "
            "start one with `dask scheduler`, or leave --dask out"
        ) from error
