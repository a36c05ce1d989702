"""A campaign on the rig that is served: asked from the campaign's own thread, beside everybody who watches it."""

from __future__ import annotations

import asyncio
import concurrent.futures
import threading
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

from control.loop import ControlLoop
from control.runs import Run, RunRequest
from control.safety import Refused
from control.snapshot import RigState, Snapshot
from server.occupation import Occupant, Stop
from server.studies.campaign.operator import RigGone

if TYPE_CHECKING:
    from server.rig import Rig

T = TypeVar("T")

CLOSED = "the rig was closed"
LOOK_AGAIN = 0.25
"""Where no tick comes, the rig is looked at so often all the same, s."""


class RigOperator:
    """To be made on the event loop's thread, and used on another one.

    consent: a person agrees that the campaign arms the rig when it begins; a simulated rig needs none.
    heard: the newest stop when that person asked for the campaign; a later one counts.
    """

    is_attended = True

    def __init__(self, rig: Rig, *, consent: bool, heard: Stop | None) -> None:
        self.may_arm = consent or rig.settings.is_simulated
        self._rig = rig
        self._events = asyncio.get_running_loop()
        self._ticked = threading.Event()
        self._stopped_before = heard
        self._newest: Snapshot | None = None
        """Of the ticks since the campaign did something."""

    @property
    def now(self) -> float:
        return self._rig.machine.camera.now()

    @contextmanager
    def occupied(self, by: Occupant) -> Iterator[None]:
        """A stop that came since the campaign was asked for counts; raises `Refused` while a run goes on."""
        occupation = self._rig.occupation
        with occupation.by(by), self._rig.watched(self._see):
            stop = occupation.latest_stop
            if stop is not None and stop is not self._stopped_before:
                by.stop(stop.reason, is_end=stop.is_end)
            self.do(_require_no_run)
            yield

    def _see(self, snapshot: Snapshot) -> None:
        """On the rig's thread."""
        self._newest = snapshot
        self._ticked.set()

    def tick(self) -> Snapshot:
        """A rig whose loop hangs has no ticks; what is known of it is told then."""
        while True:
            self._ticked.wait(LOOK_AGAIN)
            self._ticked.clear()
            if self._rig.failure is not None or self._rig.updates.closed:
                raise RigGone(self._rig.snapshot.reason)
            if self._newest is not None:
                snapshot, self._newest = self._newest, None
                return snapshot
            if self._rig.hangs:
                return self._rig.snapshot

    def do(self, act: Callable[[ControlLoop], T]) -> T:
        return self._answer(self._rig.between_ticks(lambda: act(self._rig.machine.loop)))

    def check_disk(self) -> None:
        self._rig.check_recording()

    def start(self, request: RunRequest, permit: Callable[[], None]) -> str:
        return self._answer(self._rig.begin_run(request, permit)).id

    def outcome(self, id: str) -> Run:
        return self._rig.runs.of(id)

    def is_recorded(self, id: str) -> bool:
        return self._rig.is_recorded(id)

    def _answer(self, question: Coroutine[Any, Any, T]) -> T:
        """Ask on the event loop, and wait for what comes of it; ticks before it are no news any more."""
        if self._events.is_closed():
            question.close()
            raise RigGone(CLOSED)
        asked = asyncio.run_coroutine_threadsafe(question, self._events)
        while not concurrent.futures.wait([asked], LOOK_AGAIN).done:
            if not self._events.is_running():
                raise RigGone(CLOSED)
        self._newest = None
        try:
            return asked.result()
        except concurrent.futures.CancelledError as error:
            raise RigGone(CLOSED) from error
        except RuntimeError as error:
            if self._rig.updates.closed:  # its thread has ended
                raise RigGone(CLOSED) from error
            raise


def _require_no_run(loop: ControlLoop) -> None:
    """Somebody else's run is not the campaign's to resume."""
    if loop.state in (RigState.RUNNING, RigState.HELD):
        raise Refused(f"a run is {loop.state}; let it come to its end, or stop it, and begin the study then")
