"""The studies of a server: one campaign on its rig and one batch beside it at a time, begun, watched and ended here.

A batch is a process of its own; a campaign is a thread that asks the rig like anybody else. Both belong to the
server, not to a page; what they have done is in the study's folder, so a server that ends leaves studies that can
be resumed.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import time
from collections.abc import Coroutine, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from control.studies.checking import Survey, runs_at_most, survey
from control.studies.definition import StudyDefinition
from server.lease.attendance import Permit, free
from server.occupation import Stop
from server.own_thread import in_a_thread
from server.rig_life import ENDED
from server.studies.campaign import Activity, Campaign
from server.studies.child import Child, ChildFailed, Verb
from server.studies.errors import StudyBusy, StudyStoreError
from server.studies.store import StudyStore
from server.studies.study import Study

if TYPE_CHECKING:
    from server.archive import Archive
    from server.rig import Rig

log = logging.getLogger(__name__)

BY_A_PERSON = "stopped by the operator"
LAST_WORD = 2.0
"""At the end a campaign is waited for, but not for ever, s (gone within 5 s, faults.md row 16)."""
DRAWN_AT_ONCE = 1
"""Reports and figures that are made at the same time; and definitions that are looked at."""


@dataclass(slots=True)
class Work:
    """What is done on one study just now. current: in words.  seconds_left: None while nobody can tell.

    begun_with: rows that were there before.  began: monotonic, s.  is_unwanted: somebody has stopped it.
    """

    study: Study
    done: int
    total: int
    failed: int
    begun_with: int
    began: float
    current: str = "getting ready"
    seconds_left: float | None = None
    is_unwanted: bool = False
    child: Child | None = None
    campaign: Campaign | None = None
    task: asyncio.Task[None] | None = None


@dataclass(frozen=True, slots=True)
class Asked:
    """How a person wants a study carried out.

    consent: a campaign may put current through real coils.  jobs: processes of a batch; 0: one a core.  heard: the
    newest stop of the rig at that time; one that comes later counts against the study, too.
    permit: asked when it begins.
    """

    consent: bool
    jobs: int
    heard: Stop | None
    permit: Permit = free


class StudyDesk:
    """Belongs to the event loop."""

    def __init__(self, rig: Rig, archive: Archive) -> None:
        self._rig = rig
        self._archive = archive
        self._data: Path = archive.folder.parent
        self.store = StudyStore(self._data, archive.catalogue)
        self._works: dict[str, Work] = {}
        self._seats = asyncio.Semaphore(DRAWN_AT_ONCE)
        self._looks = asyncio.Semaphore(DRAWN_AT_ONCE)

    def work_on(self, id: str) -> Work | None:
        """What is done on that study just now, if anything."""
        return self._works.get(id)

    async def surveyed(self, definition: StudyDefinition) -> Survey:
        """What it asks for, set by set, with what cannot be done. One at a time: thousands of sets take seconds of
        the interpreter that the rig's loop needs."""
        workspace = self._rig.coils.workspace if definition.on == "rig" else None
        async with self._looks:
            return await asyncio.to_thread(survey, definition, workspace)

    def require_free(self, on: str) -> None:
        """Raises `StudyBusy` where a campaign, or a batch, goes on already."""
        other = next((work for work in self._works.values() if work.study.definition.on == on), None)
        if other is None:
            return
        where = "has the rig" if on == "rig" else "is being computed"
        raise StudyBusy(
            f"the study {other.study.definition.name!r} {where}; wait until it has finished, or stop it first"
        )

    def campaign_along(self, trajectory: str) -> str | None:
        """The name of the campaign that goes on and has runs along that trajectory, if there is one."""
        going_on = (work.study.definition for work in self._works.values())
        found = (each.name for each in going_on if each.on == "rig" and each.walks_along(trajectory))
        return next(found, None)

    def asked(self, *, consent: bool, jobs: int) -> Asked:
        """To be called first of all, so that no stop is missed while a study is made ready."""
        return Asked(consent, jobs, self._rig.occupation.latest_stop)

    async def begin(self, study: Study, asked: Asked) -> None:
        """Go on with what is left of a study. Raises `StudyBusy`."""
        on = study.definition.on
        self.require_free(on)
        tally = await asyncio.to_thread(study.tally)
        self.require_free(on)  # somebody else may have come first
        asked.permit()
        total = runs_at_most(study.definition)
        work = Work(study, tally.done, total, tally.failed, begun_with=tally.done, began=time.monotonic())
        self._works[study.id] = work
        carry = self._walk(work, asked) if on == "rig" else self._compute(work, asked.jobs)
        work.task = asyncio.create_task(self._carried(work, carry), name=f"study {study.id}")
        self._tell("started", work)

    async def _carried(self, work: Work, carry: Coroutine[Any, Any, None]) -> None:
        try:
            await carry
        except (StudyStoreError, ChildFailed) as error:
            if not work.is_unwanted:
                self._rig.announce("warn", "study", f"{work.study.definition.name}: {error}")
        except Exception:
            log.exception("the study %s ended by a mistake of the program's own", work.study.id)
            self._rig.announce("error", "study", f"{work.study.definition.name}: the program failed at it")
        finally:
            self._works.pop(work.study.id, None)
            work.current = ""
            self._tell("ended", work)

    def _tell(self, event: str, work: Work) -> None:
        """Everybody who watches the rig."""
        condition = work.study.condition
        news = {
            "id": work.study.id,
            "name": work.study.definition.name,
            "on": work.study.definition.on,
            "state": "running" if event != "ended" else condition.state,
            "reason": "" if event != "ended" else condition.reason,
            "done": work.done,
            "total": work.total,
            "failed": work.failed,
            "seconds_left": work.seconds_left if event != "ended" else None,
            "current": work.current,
        }
        self._rig.announcements.publish({"type": "study", "event": event, "study": news})

    def tell_of(self, event: str, study: Study) -> None:
        """A study that is new, or gone; nobody works on it."""
        news = {"id": study.id, "name": study.definition.name}
        self._rig.announcements.publish({"type": "study", "event": event, "study": news})

    # A batch -------------------------------------------------------------------------------------

    async def _compute(self, work: Work, jobs: int) -> None:
        work.child = await Child.started("carry-out", self._data, work.study.id, jobs)
        if work.is_unwanted:  # one that has just begun may not hear it
            await work.child.stop()
        await work.child.lines(lambda line: self._heard(work, line))

    def _heard(self, work: Work, line: bytes) -> None:
        said: Mapping[str, Any] = json.loads(line)
        work.done, work.total, work.failed = said["done"], said["total"], said["failed"]
        work.seconds_left = said["seconds_left"]
        work.current = f"{said['runs_per_s']:.3g} runs a second"
        self._tell("progress", work)

    # A campaign ----------------------------------------------------------------------------------

    async def _walk(self, work: Work, asked: Asked) -> None:
        from server.studies.campaign.on_rig import RigOperator

        events = asyncio.get_running_loop()
        operator = RigOperator(self._rig, consent=asked.consent, heard=asked.heard)

        def tell(activity: Activity) -> None:
            with contextlib.suppress(RuntimeError):  # the server has ended meanwhile
                events.call_soon_threadsafe(self._seen, work, activity)

        work.campaign = Campaign(work.study, operator, self._archive.catalogue, tell)
        if work.is_unwanted:
            work.campaign.stop(BY_A_PERSON)
        outcome = await in_a_thread(work.campaign.run, "campaign")
        severity = "info" if outcome.state in ("finished", "stopped") else "warn"
        reason = f": {outcome.reason}" if outcome.reason else ""
        self._rig.announce(severity, "study", f"{work.study.definition.name} {outcome.state}{reason}")

    def _seen(self, work: Work, activity: Activity) -> None:
        work.current, work.done, work.total = activity.words, activity.done, activity.total
        if activity.row is not None:
            work.failed += activity.row.state == "failed"
            walked = work.done - work.begun_with
            pace = (time.monotonic() - work.began) / walked if walked > 0 else 0.0
            work.seconds_left = pace * (work.total - work.done) if walked > 0 else None
        self._tell("progress", work)

    # The end -------------------------------------------------------------------------------------

    async def stop(self, id: str) -> None:
        """It ends in good order, and can be resumed; returns when it has. Nothing where nothing goes on."""
        work = self._works.get(id)
        if work is None or work.task is None:
            return
        work.is_unwanted = True
        if work.campaign is not None:
            work.campaign.stop(BY_A_PERSON)
        elif work.child is not None:
            await work.child.stop()
        await asyncio.shield(work.task)

    async def close(self) -> None:
        """The server ends: what goes on is interrupted, and resumed only when somebody asks for that."""
        works = list(self._works.values())
        for work in works:
            work.is_unwanted = True
            if work.campaign is not None:
                work.campaign.stop(ENDED, is_end=True)
            elif work.child is not None:
                await work.child.kill()
        tasks = [work.task for work in works if work.task is not None]
        if tasks:
            await asyncio.wait(tasks, timeout=LAST_WORD)

    # Figures and reports -------------------------------------------------------------------------

    async def drawn(self, verb: Verb, study: Study) -> bytes:
        """What the child writes; of a report nothing: it is in the study's folder then. Raises `ChildFailed`."""
        async with self._seats:
            child = await Child.started(verb, self._data, study.id)
            return await child.output()
