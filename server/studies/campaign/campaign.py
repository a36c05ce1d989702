"""A campaign: the runs of a study on one rig, one after the other, each from the same start.

For each run: wait until the rig is fit, walk back to the start, rest, walk, add the row. What interrupts a run is
no end: the run is made again, up to a number of attempts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from control.metrics import Metrics
from control.model import Pose
from control.registry import UnknownName
from control.runs import RunRequest, RunState
from control.safety import Refused
from control.studies.errors import StudyError
from control.studies.plan import PlannedRun
from control.studies.sections import StartSection
from control.studies.start import start_of
from control.studies.table import StudyRow
from server.catalogue.catalogue import Catalogue
from server.catalogue.errors import CatalogueError
from server.metrics_json import metrics_json
from server.studies.campaign.activity import Activity, Tell, tell_nobody
from server.studies.campaign.attendant import Attendant, Interrupted, Stopped
from server.studies.campaign.operator import Operator, RigGone
from server.studies.campaign.rows import failed_row, finished_row, put_right
from server.studies.campaign.rules import Rules
from server.studies.campaign.way_back import WayBack
from server.studies.carrying_out import Rules as StopRules
from server.studies.condition import StudyState
from server.studies.errors import StudyStoreError
from server.studies.study import Carrying, Study

RECORDED_WITHIN = 10.0
"""A run's row waits for its recording and the catalogue, s, so that whoever has the row finds the run; a disk that
takes longer is no reason to wait, since nothing that was walked is lost then."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """state: of the study, as in `server.studies.condition`.  reason: "" for one that is finished."""

    state: StudyState
    reason: str = ""


class Campaign:
    """`run` once, on a thread of its own; `stop` from wherever.  tell: is told of everything, on that thread."""

    def __init__(
        self, study: Study, operator: Operator, catalogue: Catalogue, tell: Tell = tell_nobody
    ) -> None:
        self.name = f"the study {study.definition.name!r}"
        self._study = study
        self._operator = operator
        self._catalogue = catalogue
        self._tell = tell
        self._rules = Rules.of(study.definition)
        self._plan = study.definition.plan()
        self._attendant = Attendant(operator, self._rules, self._say)
        self._way_back = WayBack(operator, self._attendant, self._rules)
        self.activity = Activity("getting ready", 0, self._plan.total)

    def stop(self, reason: str, *, is_end: bool = False) -> None:
        """From any thread and from signal handlers. is_end: the program ends; the study counts as interrupted."""
        self._attendant.stop(reason, is_end=is_end)

    def run(self) -> Outcome:
        """Until it is over, with the coils off at the end; raises `StudyBusy` and `StudyStoreError`."""
        with self._study.claimed() as book:
            outcome = self._carried_out(book)
            book.ends(outcome.state, outcome.reason)
        return outcome

    def _carried_out(self, book: Carrying) -> Outcome:
        try:
            with self._operator.occupied(self):
                try:
                    put_right(self._study.id, self._plan, book, self._catalogue)
                    return self._walk_all(book)
                finally:
                    self._attendant.leave()
        except Stopped as stopped:
            return Outcome(stopped.state, str(stopped))
        except (Refused, RigGone, StudyStoreError, StudyError, CatalogueError) as error:
            return Outcome("interrupted", str(error))

    def _walk_all(self, book: Carrying) -> Outcome:
        rules = StopRules(self._study.definition, book, self._plan)
        if (ended := rules.failed) is not None:
            return Outcome(ended.state, ended.reason)
        while ahead := self._plan.next(book.done):
            self._begin(ahead[0], book.done)
            row = self._row(self._plan.run(ahead[0], book.done))
            book.extend(rules.allowed([row]))
            self._show(row, len(book.done))
            if (ended := rules.stopped) is not None:
                return Outcome(ended.state, ended.reason)
        return Outcome("finished")

    # One run -------------------------------------------------------------------------------------

    def _row(self, run: PlannedRun) -> StudyRow:
        """Of a run that came to its end, or that failed as often as it may."""
        run_id, reason = "", ""
        for attempt in range(1, self._rules.attempts + 1):
            try:
                self._way_back.bring(_start_of(run), run.selection)
                run_id = self._operator.start(self._request(run), self._attendant.require_going)
                self._say("walking")
                return finished_row(run, run_id, metrics_json(self._walked(run_id)), attempt)
            except (Interrupted, Refused) as error:
                reason = str(error)
                self._say(f"attempt {attempt} of {self._rules.attempts} failed: {reason}")
            except (ValueError, UnknownName) as error:  # another attempt would not mend that
                return failed_row(run, run_id, str(error), attempt)
        return failed_row(run, run_id, reason, self._rules.attempts)

    def _walked(self, id: str) -> Metrics:
        """Follow a run to its end; raises `Interrupted`."""
        self._attendant.follow()
        done = self._operator.outcome(id)
        if done.state is not RunState.FINISHED or done.metrics is None:
            raise Interrupted(done.reason)
        self._attendant.until(lambda: self._operator.is_recorded(id), RECORDED_WITHIN)
        return done.metrics

    def _request(self, run: PlannedRun) -> RunRequest:
        return RunRequest(
            run.selection,
            passes=run.passes,
            duration=run.duration,
            unattended=True,
            label=f"{self._study.definition.name}: run {run.index + 1}",
            study=self._study.id,
            study_run=run.index,
        )

    # News ----------------------------------------------------------------------------------------

    def _begin(self, index: int, done: Mapping[int, StudyRow]) -> None:
        self.activity = Activity("", len(done), self._plan.total, index)

    def _say(self, words: str) -> None:
        """What goes on now; told once."""
        now = self.activity
        whole = words if now.index is None else f"run {now.done + 1} of {now.total}: {words}"
        if whole != now.words:
            self.activity = Activity(whole, now.done, now.total, now.index)
            self._tell(self.activity)

    def _show(self, row: StudyRow, done: int) -> None:
        """The row of a run."""
        self.activity = Activity(
            f"run {done} of {self._plan.total}: {row.state}", done, self._plan.total, None, row
        )
        self._tell(self.activity)


def _start_of(run: PlannedRun) -> Pose:
    """A plan for a rig says where each run starts; others start at the path's first point, heading along it."""
    return run.start or start_of(StartSection(), run.selection.build_trajectory())
