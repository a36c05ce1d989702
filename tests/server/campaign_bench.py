"""Campaigns on the complete simulated rig, as fast as it goes, with the truth beside them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from control.model import Pose, Tracking, wrap
from control.simulation.board import TwinBoard
from control.snapshot import RigState, Snapshot
from control.studies.definition import StudyDefinition
from control.studies.table import StudyRow
from server.archive import Archive
from server.assembly import Machine, build_machine
from server.catalogue.records import RunQuery, RunRecord
from server.settings import RigFile
from server.studies.campaign import Activity, Campaign, Outcome
from server.studies.campaign.headless import HeadlessOperator
from server.studies.campaign.way_back import ID as WAY_BACK
from server.studies.store import StudyStore
from server.studies.study import Study

CIRCLE = {"radius_mm": 5.0, "speed_mm_s": 10.0, "centre_x_mm": -3.0, "centre_y_mm": -40.0}
"""It begins 3 mm from where the simulated robot is put."""
SHORT: dict[str, Any] = {
    "name": "short", "on": "rig", "duration_s": 0.6,
    "trajectory": {"name": "circle", "parameters": CIRCLE},
    "gait": {"sweep_deg": 20.0}, "rig": {"rest_s": 0.1}, "axes": [{"of": "gait.tilt_deg", "values": [20, 25, 30]}],
}  # fmt: skip
"""Three runs of 0.6 s, which take the robot a few millimetres away."""
HERE: dict[str, Any] = {"start": {"x_mm": 0.0, "y_mm": -42.0, "heading_deg": 90.0}}
"""The start where the simulated robot is put: no way back is walked to the first run."""


class BenchOperator(HeadlessOperator):
    campaign: Campaign


class AttendedOperator(BenchOperator):
    """Somebody is there: the test, which looks at every tick."""

    is_attended = True


@dataclass(slots=True)
class Sitting:
    """One campaign while it goes on, and what was seen of it.

    starts: where the robot truly was when each run began.  words: what the campaign said.  driven_while_held: ticks
    of a hold, but the first, at which the coils were driven.  seen_for: how long the robot had been seen when a hold
    ended, s.
    """

    machine: Machine
    starts: list[Pose] = field(default_factory=list)
    words: list[str] = field(default_factory=list)
    driven_while_held: int = 0
    seen_for: list[float] = field(default_factory=list)
    seen_since: float = 0.0
    was_held: bool = False
    campaign: Campaign | None = None
    run: str = ""
    """The study's run that is on."""

    def see(self, snapshot: Snapshot) -> None:
        walked = snapshot.run.id if snapshot.run is not None else ""
        run = "" if walked == WAY_BACK else walked
        if run and run != self.run:
            self.starts.append(self.truth)
        self.run = run
        if snapshot.rig is RigState.HELD and self.was_held and not self.board.drive_is_zero:
            self.driven_while_held += 1
        if snapshot.tracking is not Tracking.LOCKED:
            self.seen_since = snapshot.time
        if self.was_held and snapshot.rig is RigState.ARMED:
            self.seen_for.append(snapshot.time - self.seen_since)
        self.was_held = snapshot.rig is RigState.HELD

    def hear(self, activity: Activity) -> None:
        self.words.append(activity.words)

    def has_said(self, words: str) -> bool:
        return any(words in each for each in self.words)

    @property
    def truth(self) -> Pose:
        assert self.machine.world is not None
        return self.machine.world.body().pose

    @property
    def board(self) -> TwinBoard:
        assert self.machine.world is not None
        assert isinstance(self.machine.world.board, TwinBoard)
        return self.machine.world.board

    def inject(self, name: str, duration: float = math.inf, **parameters: Any) -> None:
        assert self.machine.faults is not None
        self.machine.faults.inject(name, parameters, duration=duration)

    def clear(self, name: str) -> None:
        assert self.machine.faults is not None
        self.machine.faults.clear(name)

    def stop(self, reason: str) -> None:
        assert self.campaign is not None
        self.campaign.stop(reason)


Watch = Callable[[Sitting, Snapshot], None]


class CampaignBench:
    """A data folder, and a rig that is built anew for each sitting."""

    def __init__(self, data: Path) -> None:
        self.data = data
        self.archive = Archive.open(data, patient=True)
        self.store = StudyStore(data, self.archive.catalogue)

    def close(self) -> None:
        self.archive.close()

    def study(self, **changes: Any) -> Study:
        """A new one: `SHORT`, changed."""
        return self.store.create(StudyDefinition.from_json({**SHORT, **changes}))

    def sit(
        self,
        study: Study,
        watch: Watch | None = None,
        *,
        attended: bool = False,
        kind: type[BenchOperator] = BenchOperator,
    ) -> tuple[Outcome, Sitting]:
        """Carry a study out, or on. watch: sees each tick, and may do what a person may."""
        machine = build_machine(RigFile().with_simulation(seed=3), realtime=False)
        sitting = Sitting(machine)

        def see(snapshot: Snapshot) -> None:
            sitting.see(snapshot)
            if watch is not None:
                watch(sitting, snapshot)

        operator = (AttendedOperator if attended else kind)(machine, self.archive.recorder, see)
        sitting.campaign = Campaign(study, operator, self.archive.catalogue, sitting.hear)
        operator.campaign = sitting.campaign
        outcome = sitting.campaign.run()
        for run in self.runs(study):
            self.archive.recorder.written(run.id, 30.0)
        return outcome, sitting

    def runs(self, study: Study, state: str = "") -> list[RunRecord]:
        """Those of the study in the catalogue, with their settings."""
        found = self.archive.catalogue.page(RunQuery(study=study.id, state=state), limit=100)
        return [self.archive.catalogue.get(record.id) for record in found.runs]


def off(pose: Pose, start: Pose) -> tuple[float, float]:
    """How far from the start, mm and degrees."""
    turn = math.degrees(abs(wrap(pose.heading - start.heading)))
    return pose.distance_to(start.x, start.y) * 1e3, turn


def start_of(study: Study) -> Pose:
    start = study.definition.plan().run(0, {}).start
    assert start is not None
    return start


def indices(rows: list[StudyRow]) -> list[int]:
    return [row.index for row in rows]
