"""One sitting at a study in the terminal, as a batch or on a rig."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.commands.consent import ask_for_consent
from server.commands.outcome import FAILED, REFUSED, fail, open_rig_store
from server.commands.run_choice import tell_of_loss
from server.commands.study_progress import StudyBar, end_of, how_to_go_on, print_outcome
from server.data_folder import data_folder
from server.signals import ENDING, ESTOP, handled, interrupted_once

if TYPE_CHECKING:
    from types import FrameType

    from server.archive import Archive
    from server.assembly import Machine
    from server.settings import RigFile
    from server.studies.campaign import Activity, Campaign
    from server.studies.carrying_out import Carried
    from server.studies.study import Study


@dataclass(frozen=True, slots=True)
class Sitting:
    """How a study is carried out. jobs: processes, 0 for one a core.  dask: a scheduler's address instead.

    rig, data: what --rig and --data said.  consent: what --yes said.
    """

    jobs: int = 0
    dask: str | None = None
    rig: Path | None = None
    data: Path | None = None
    consent: bool = False
    as_json: bool = False


def sit(study: Study, sitting: Sitting) -> None:
    """Carry out what is left, and print what came of it; ends the command unless the study is finished."""
    carried = _on_a_rig(study, sitting) if study.definition.on == "rig" else _as_batch(study, sitting)
    print_outcome(result_of(study, carried), as_json=sitting.as_json)
    end_of(study, carried)


def result_of(study: Study, carried: Carried) -> dict[str, Any]:
    from server.studies.progress import Progression, best_json, measure_of

    measure, tally = measure_of(study.definition), study.tally()
    best = Progression(0, study.results(), measure).best()
    return {
        "id": study.id,
        "name": study.definition.name,
        "state": carried.state,
        "reason": carried.reason,
        "runs": tally.done,
        "failed": tally.failed,
        "wall_s": study.condition.wall_s,
        "table": str(study.write_table()),
        "best": None if best is None else best_json(best, measure),
    }


def _as_batch(study: Study, sitting: Sitting) -> Carried:
    from server.studies.carrying_out import Workforce, carry_out_batch

    workforce = Workforce(sitting.jobs, sitting.dask)
    try:
        with interrupted_once(), _bar(study) as bar:
            return carry_out_batch(study, workforce, bar.show)
    except KeyboardInterrupt:
        raise fail(f"stopped; {how_to_go_on(study)}", FAILED) from None


def _on_a_rig(study: Study, sitting: Sitting) -> Carried:
    from control.link.conversion import LinkError
    from control.simulation.plants import MissingExtra
    from server.assembly import build_machine
    from server.studies.campaign import Campaign
    from server.studies.campaign.headless import HeadlessOperator
    from server.studies.carrying_out import Carried
    from vision.sources.opening import CameraError

    rig_file = open_rig_store(sitting.rig, sitting.data).settings
    ask_for_consent(rig_file, yes=sitting.consent)
    try:
        machine = build_machine(rig_file, realtime=not rig_file.is_simulated)
        with _archive(rig_file, sitting) as archive, _bar(study) as bar:
            operator = HeadlessOperator(machine, archive.recorder)
            campaign = Campaign(study, operator, archive.catalogue, _News(study, bar))
            with _signals(machine, campaign):
                outcome = campaign.run()
    except (LinkError, CameraError, MissingExtra, OSError) as error:
        raise fail(f"the rig cannot be opened: {error}", REFUSED) from error
    return Carried(outcome.state, outcome.reason)


@contextmanager
def _archive(rig_file: RigFile, sitting: Sitting) -> Iterator[Archive]:
    """A simulated rig waits for its recorder; a real one waits for no disk."""
    from server.archive import Archive
    from server.catalogue.errors import CatalogueError

    try:
        archive = Archive.open(data_folder(sitting.data), patient=rig_file.is_simulated)
        tell_of_loss(archive)
    except (CatalogueError, OSError) as error:
        raise fail(f"{error}; choose another folder with --data", FAILED) from error
    try:
        yield archive
    finally:
        archive.close()


def _bar(study: Study) -> StudyBar:
    return StudyBar(study.definition.name, study.definition.plan().total)


class _News:
    """Shows what a campaign tells."""

    def __init__(self, study: Study, bar: StudyBar) -> None:
        from server.studies.progress import Progression, measure_of

        self._bar = bar
        self._results = study.results()
        total = study.definition.plan().total
        self._progression = Progression(total, self._results, measure_of(study.definition))

    def __call__(self, activity: Activity) -> None:
        self._bar.say(activity.words)
        if activity.row is not None:
            self._results.refresh()
            self._progression.add(activity.row)
            self._bar.show(self._progression.now())


@contextmanager
def _signals(machine: Machine, campaign: Campaign) -> Iterator[None]:
    """Coils off first, then the campaign ends by itself; an emergency stop ends it, too."""

    def stop(number: int, _frame: FrameType | None) -> None:
        machine.stop_coils()
        is_operator = number in (signal.SIGINT, ESTOP)
        campaign.stop(
            "stopped by the operator" if is_operator else "the program was ended", is_end=not is_operator
        )

    with handled(dict.fromkeys((*ENDING, ESTOP), stop)):
        yield
