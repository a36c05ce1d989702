"""What is left when a rig ends badly: nothing."""

import asyncio
import threading
from datetime import UTC, datetime

import pytest

from control.link.conversion import LinkError
from control.news import Ended
from control.runs import Run, RunRequest, RunState, Selection
from server.assembly import build_machine
from server.exchange import rehearse
from server.rig import Rig
from server.run_list import RunList
from server.settings import RigFile
from tests.faults.invariants import nothing_left_behind

pytestmark = pytest.mark.anyio


async def test_a_rig_whose_loop_has_failed_is_closed_all_the_same():
    def fail(*_: object) -> None:
        raise ZeroDivisionError("a fault of the program")

    with nothing_left_behind():
        rig = Rig(build_machine(RigFile(), realtime=True))
        await rig.start()
        rig.machine.loop.tick = fail  # type: ignore[method-assign]
        async with asyncio.timeout(10.0):
            while rig.failure is None:
                await asyncio.sleep(0.01)
        await rig.stop()
        assert rig.machine.link.status.state == "closed"
        assert isinstance(rig.failure, ZeroDivisionError)


async def test_values_that_do_not_go_together_leave_no_simulated_device_behind():
    coil = RigFile().coils.x.model_dump(mode="json")
    with nothing_left_behind(), pytest.raises(LinkError, match="resistance of coil 1 of 100 ohm"):
        rehearse(RigFile.model_validate({"coils": {"x": {**coil, "resistance_ohm": 100.0}}}))


class Interrupting(str):
    """An id whose first comparison lets another thread start a run, as the rig's thread may at any time."""

    __slots__ = ("start",)
    __hash__ = str.__hash__

    def __eq__(self, other: object) -> bool:
        thread = threading.Thread(target=self.start)
        thread.start()
        thread.join(0.2)
        return str.__eq__(self, other)


def run(id: str) -> Run:
    return Run(id, RunRequest(Selection()), RunState.RUNNING, datetime.now(UTC))


async def test_a_run_that_starts_while_another_one_is_ended_keeps_its_own_state():
    runs = RunList()
    runs.start(run("first"))
    id = Interrupting("first")
    started = threading.Event()

    def start() -> None:
        runs.start(run("second"))
        started.set()

    id.start = start
    metrics = RunList  # never looked at
    runs.end(Ended(id, RunState.FINISHED, "", metrics))  # type: ignore[arg-type]
    assert started.wait(5.0)
    assert [(each.id, each.state) for each in runs] == [
        ("second", RunState.RUNNING),
        ("first", RunState.FINISHED),
    ]
