"""When an unattended campaign goes on by itself, when it waits for a person, and when it ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from control.coil_heat import CoilHeat
from control.gait import Gait
from control.loop import ControlLoop
from control.runs import RunRequest
from control.safety import ENERGISED
from control.snapshot import RigState, Snapshot
from control.studies.definition import StudyDefinition
from server.studies.campaign.way_back import ID as WAY_BACK
from tests.server.campaign_bench import HERE, BenchOperator, CampaignBench, Sitting

ONE_RUN: dict[str, Any] = {"axes": [{"of": "gait.tilt_deg", "values": [25]}]}


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[CampaignBench]:
    bench = CampaignBench(tmp_path)
    yield bench
    bench.close()


class Person:
    """Cuts the supply in the middle of the first run, and comes back after a while to arm the rig."""

    def __init__(self, comes_after: float) -> None:
        self._comes_after = comes_after
        self._cut_at: float | None = None
        self.has_come = False
        self.energised_alone = 0

    def __call__(self, sitting: Sitting, snapshot: Snapshot) -> None:
        if self._cut_at is None:
            if sitting.run and snapshot.run is not None and snapshot.run.elapsed > 0.2:
                self._cut_at = snapshot.time
                sitting.inject("supply_off", duration=0.5)
        elif not self.has_come and snapshot.time > self._cut_at + 0.3:
            self.energised_alone += not sitting.board.drive_is_zero
            self._come(sitting, snapshot.time - self._cut_at)

    def _come(self, sitting: Sitting, gone: float) -> None:
        if gone > self._comes_after:
            sitting.machine.loop.arm(Gait())
            self.has_come = True


def test_after_a_disarm_a_campaign_waits_for_a_person_and_then_goes_on_by_itself(
    bench: CampaignBench,
) -> None:
    study = bench.study(**ONE_RUN, **HERE)
    person = Person(comes_after=1.5)
    outcome, sitting = bench.sit(study, person, attended=True)
    assert outcome.state == "finished"
    assert person.has_come
    assert person.energised_alone == 0, "I3: after a disarm no current without a new arm edge"
    assert sitting.has_said("run 1 of 1: waiting for a person: arm the rig")
    (row,) = study.rows()
    assert (row.state, row.attempts) == ("finished", 2)


def test_a_campaign_waits_for_a_person_only_so_long(bench: CampaignBench) -> None:
    study = bench.study(**ONE_RUN, **HERE, rig={"rest_s": 0.1, "wait_minutes": 0.05})
    outcome, _ = bench.sit(study, Person(comes_after=60.0), attended=True)
    assert outcome.state == study.state == "stopped"
    assert outcome.reason.startswith("waited for 0.05 min: waiting for a person: arm the rig")
    assert study.rows() == []


def test_where_nobody_can_come_a_disarm_ends_the_campaign_and_it_can_be_resumed(bench: CampaignBench) -> None:
    study = bench.study(**ONE_RUN, **HERE)
    outcome, _ = bench.sit(study, Person(comes_after=60.0))
    assert outcome.state == "stopped"
    assert outcome.reason.startswith("a person must arm the rig")
    outcome, _ = bench.sit(study)
    assert outcome.state == "finished"


def test_an_emergency_stop_ends_the_campaign(bench: CampaignBench) -> None:
    study = bench.study(**ONE_RUN, **HERE)

    def stop(sitting: Sitting, snapshot: Snapshot) -> None:
        if sitting.run and snapshot.run is not None and snapshot.run.elapsed > 0.2:
            sitting.machine.loop.estop()
            sitting.stop("emergency stop")

    outcome, sitting = bench.sit(study, stop)
    assert (outcome.state, outcome.reason) == ("stopped", "emergency stop")
    assert sitting.machine.loop.state is RigState.FAULT, "it stays latched"
    assert study.rows() == []


class JustInTime(BenchOperator):
    """The operator's stop comes after the campaign has decided to arm the rig, and before the rig hears of that."""

    def do(self, act: Callable[[ControlLoop], Any]) -> Any:
        if self._loop.state is RigState.DISARMED and not self._loop.obstacle:
            self.campaign.stop("stopped by the operator")
        return super().do(act)


class JustBeforeTheRun(BenchOperator):
    """The same, with a run."""

    def start(self, request: RunRequest, permit: Callable[[], None]) -> str:
        self.campaign.stop("stopped by the operator")
        return super().start(request, permit)


@pytest.mark.parametrize(("kind", "driven"), [(JustInTime, set()), (JustBeforeTheRun, {""})])
def test_a_stop_counts_before_what_is_on_its_way_to_the_rig(
    bench: CampaignBench, kind: type[BenchOperator], driven: set[str]
) -> None:
    study = bench.study(**ONE_RUN, **HERE)
    seen: set[str] = set()

    def watch(_: Sitting, snapshot: Snapshot) -> None:
        if snapshot.rig in ENERGISED:
            seen.add("" if snapshot.run is None else snapshot.run.id)

    outcome, _ = bench.sit(study, watch, kind=kind)
    assert (outcome.state, outcome.reason) == ("stopped", "stopped by the operator")
    assert seen == driven
    assert bench.runs(study) == []


def test_a_run_that_a_person_pauses_goes_on_when_it_is_resumed_and_counts_once(bench: CampaignBench) -> None:
    study = bench.study(**ONE_RUN, **HERE)
    paused_at: list[float] = []

    def pause(sitting: Sitting, snapshot: Snapshot) -> None:
        if not sitting.run or snapshot.run is None:
            return
        if not paused_at and snapshot.run.elapsed > 0.2:
            sitting.machine.loop.pause()
            paused_at.append(snapshot.time)
        elif snapshot.rig is RigState.HELD and snapshot.time > paused_at[0] + 1.0:
            sitting.machine.loop.resume()

    outcome, _ = bench.sit(study, pause, attended=True)
    assert outcome.state == "finished"
    (row,) = study.rows()
    assert (row.state, row.attempts) == ("finished", 1)
    assert len(bench.runs(study)) == 1


def test_a_campaign_rests_with_the_coils_off_until_they_are_cool(bench: CampaignBench) -> None:
    study = bench.study(**ONE_RUN)
    hottest_at_start: list[float] = []
    driven_while_cooling = 0

    def heat(sitting: Sitting, snapshot: Snapshot) -> None:
        nonlocal driven_while_cooling
        is_back = snapshot.run is not None and snapshot.run.id == WAY_BACK
        if is_back and not sitting.has_said("cool"):
            sitting.machine.loop.coil_heat = CoilHeat((0.1, 0.6005, 0.1))
        driven_while_cooling += sitting.was_held and not sitting.board.drive_is_zero
        if sitting.run and not hottest_at_start:
            hottest_at_start.append(max(snapshot.coil_heat))

    outcome, sitting = bench.sit(study, heat)
    assert outcome.state == "finished"
    assert sitting.has_said("run 1 of 1: waiting for the coils to cool: 61 % → 60 %")
    assert hottest_at_start[0] <= 0.60
    assert driven_while_cooling <= 1, "the stop of the tick at which it rests is on its way"


def test_a_way_back_that_something_holds_is_walked_anew_and_is_no_attempt(bench: CampaignBench) -> None:
    study = bench.study(**ONE_RUN)
    is_hidden: list[bool] = []

    def hide(sitting: Sitting, snapshot: Snapshot) -> None:
        is_back = snapshot.run is not None and snapshot.run.id == WAY_BACK
        if is_back and not is_hidden:
            is_hidden.append(True)
            sitting.inject("robot_hidden", duration=0.6)

    outcome, sitting = bench.sit(study, hide)
    assert outcome.state == "finished"
    assert sitting.has_said("the way back was interrupted: the robot is not seen")
    assert study.rows()[0].attempts == 1


def test_a_full_disk_is_waited_for_and_is_no_attempt(bench: CampaignBench) -> None:
    study = bench.study(**ONE_RUN)
    is_full: list[bool] = []

    def fill(sitting: Sitting, snapshot: Snapshot) -> None:
        if snapshot.run is not None and not is_full:
            is_full.append(True)
            sitting.inject("disk_full")
        if sitting.has_said("waiting: the run cannot be recorded"):
            sitting.clear("disk_full")

    outcome, sitting = bench.sit(study, fill)
    assert outcome.state == "finished"
    assert sitting.has_said("waiting: the run cannot be recorded")
    assert study.rows()[0].attempts == 1


def test_an_own_start_is_walked_back_to(bench: CampaignBench) -> None:
    start = {"x_mm": 0.0, "y_mm": -35.0, "heading_deg": 60.0}
    study = bench.study(**ONE_RUN, start=start)
    outcome, sitting = bench.sit(study)
    assert outcome.state == "finished"
    (begun,) = sitting.starts
    assert begun.distance_to(0.0, -0.035) <= 1e-3
    assert StudyDefinition.from_json(study.definition.to_json()).start.heading_deg == 60.0
