"""Changes of the rig file while the rig runs: from the page, from the disk, and back again.

One change after the other; each is validated whole, tried on simulated devices, and saved only when the rig with
it could be opened. What was running before stays until then.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from control.link.conversion import LinkError
from control.safety import Refused
from control.snapshot import RigState
from server.atomic_save import previous_of
from server.exchange import rehearse
from server.lease.attendance import Permit, free
from server.rig_file import Plan, RigFileError, RigStore, differences
from server.rig_import import exported, listed, plan_of_text
from server.settings import RigFile

if TYPE_CHECKING:
    from server.rig import Rig

log = logging.getLogger(__name__)

LIVE = frozenset(
    {"name", "version", "notifications.webhook_url", "notifications.on", "notifications.timeout_s"}
)
"""Fields that no part of the machine is built from; they change at once, in any state."""

LOOKS = (
    "vision.profile",
    "vision.profiles",
    "vision.hue_deg",
    "vision.saturation",
    "vision.value",
    "vision.end_mark",
    "vision.area_mm2",
    "vision.heading_hint_deg",
)
"""What the robot looks like: the tracker of a disarmed rig takes it without being built anew."""

LOOK_EVERY = 1.0
"""How often the file on the disk is looked at, s."""

EVENT = "rig-file"
"""Code of this module's entries in the event log."""


class NeedsDisarmed(Refused):
    """These fields can only change while the rig is disarmed. fields: their dotted names."""

    def __init__(self, state: RigState, fields: tuple[str, ...]) -> None:
        super().__init__(
            f"{', '.join(fields)} can only be changed while the rig is disarmed, and it is {state}"
        )
        self.fields = fields


class DoNotGoTogether(ValueError):
    """Values that are each allowed, but not together; the text says which and why."""


@dataclass(frozen=True, slots=True)
class Change:
    """What has been done. fields: dotted names.  rebuilt: whether the machine was exchanged."""

    fields: tuple[str, ...]
    rebuilt: bool


class RigChanges:
    """The rig's file and its life. as_run: makes of the file's rig the one that runs (`serve --sim` simulates)."""

    def __init__(self, rig: Rig, store: RigStore, as_run: Callable[[RigFile], RigFile]) -> None:
        self._rig = rig
        self._store = store
        self._as_run = as_run
        self._one_at_a_time = asyncio.Lock()
        self._watch: asyncio.Task[None] | None = None
        self._seen: str | None = None
        """What the file says, where that is another thing than what runs."""

    def public(self) -> dict[str, Any]:
        """The file that the values come from; overridden: what in it this start of the server goes without."""
        store = self._store
        previous = previous_of(store.path)
        return {
            "path": str(store.path),
            "saved": store.is_saved,
            "previous": str(previous) if previous.exists() else None,
            "changed_on_disk": self._seen is not None,
            "overridden": list(differences(store.settings, self._as_run(store.settings))),
        }

    async def patch(self, changes: Mapping[str, Any], permit: Permit = free) -> Change:
        """Apply nested changes and save them; raises ValidationError, `RigFileError`, `Refused`."""
        return await self.alter(lambda _: changes, permit)

    async def alter(self, changes: Callable[[RigFile], Mapping[str, Any]], permit: Permit = free) -> Change:
        """The same with changes that depend on what the file has: told when no other change is under way."""
        async with self._one_at_a_time:
            plan = self._store.plan(changes(self._store.settings))
            return await self._apply_and_save(plan, permit)

    async def undo(self, permit: Permit = free) -> Change:
        """Back to the file as it was before the last save, which becomes the previous one itself."""
        async with self._one_at_a_time:
            return await self._apply_and_save(await asyncio.to_thread(self._store.plan_of_previous), permit)

    def exported(self) -> str:
        """The file's text as it may be given away."""
        return exported(self._store)

    async def look_at(self, text: str) -> list[dict[str, Any]]:
        """What the text of another rig file would change; raises `RigFileError`."""
        plan = await asyncio.to_thread(plan_of_text, self._store, text)
        return listed(self._store.settings, plan)

    async def take(self, text: str, permit: Permit = free) -> Change:
        """Take another rig file's text over whole; raises `RigFileError`, `Refused`."""
        async with self._one_at_a_time:
            plan = await asyncio.to_thread(plan_of_text, self._store, text)
            return await self._apply_and_save(plan, permit)

    async def reload(self, permit: Permit = free) -> Change:
        """Take the file as it is on the disk; raises `RigFileError`, `Refused`."""
        async with self._one_at_a_time:
            plan = await asyncio.to_thread(self._store.plan_of_disk)
            change = await self._apply(plan, permit)
            await asyncio.to_thread(self._store.take_disk, plan)
            return self._done(change, f"the rig file {self._store.path} was read again")

    async def _apply_and_save(self, plan: Plan, permit: Permit) -> Change:
        if plan.text == self._store.text:
            return Change((), rebuilt=False)
        staged = await asyncio.to_thread(self._store.stage, plan)
        with staged:
            before = self._rig.settings
            change = await self._apply(plan, permit)
            try:
                await asyncio.to_thread(self._store.commit, staged, plan)
            except RigFileError as error:
                await self._put_back(before, error)
                raise
        return self._done(change, f"the rig file {self._store.path} was saved")

    async def _apply(self, plan: Plan, permit: Permit) -> Change:
        return Change(plan.changed, rebuilt=await self._run_with(self._as_run(plan.settings), permit))

    async def _run_with(self, wanted: RigFile, permit: Permit = free) -> bool:
        """Whether the machine was rebuilt for it. What differs counts, not what was asked."""
        permit()
        fields = differences(self._rig.settings, wanted)
        bound = tuple(sorted(set(fields) - LIVE))
        rebuild = not all(map(_is_of_looks, bound)) or self._rig.is_lost
        if rebuild:
            await self._exchange(wanted, bound, permit)
        elif bound:
            self._require_disarmed(bound)
            await self._rig.retune(wanted, permit)
        elif fields:
            self._rig.take_settings(wanted)
        return rebuild

    def _require_disarmed(self, fields: tuple[str, ...]) -> None:
        state = self._rig.snapshot.rig
        if state is not RigState.DISARMED and not self._rig.is_lost:
            raise NeedsDisarmed(state, fields)

    async def _exchange(self, wanted: RigFile, fields: tuple[str, ...], permit: Permit) -> None:
        self._require_disarmed(fields)
        try:
            await asyncio.to_thread(rehearse, wanted)
        except (ValueError, LinkError) as error:
            raise DoNotGoTogether(str(error)) from error
        await self._rig.rebuild(wanted, permit)

    async def _put_back(self, before: RigFile, failure: RigFileError) -> None:
        """The rig as it was; one that somebody has armed in the meantime keeps what is not saved, and it is told."""
        try:
            await self._run_with(before)
        except Refused as refusal:
            reason = (
                f"{failure}, but the rig runs with values that are not in its file, since {refusal}. Disarm it, and "
                "reload the rig file or save the values again"
            )
            self._rig.announce("warn", EVENT, reason)
            raise RigFileError(reason) from failure

    def _done(self, change: Change, what: str) -> Change:
        self._seen = None
        self._tell_of_file()  # later than the rig has told of its settings: the file was not in force then
        self._rig.announce("info", EVENT, f"{what}: {_listed(change.fields)}")
        return change

    # The file on the disk ------------------------------------------------------------------------

    def start(self) -> None:
        """Begin to look at the file; ends with `stop`."""
        self._watch = asyncio.create_task(self._look_for_ever(), name="rig file")

    async def stop(self) -> None:
        if self._watch is not None:
            self._watch.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._watch

    async def _look_for_ever(self) -> None:
        while True:
            await asyncio.sleep(LOOK_EVERY)
            try:
                await self._look()
            except Exception:  # a watcher that fails does not disturb the rig (faults.md, rule 8)
                log.exception("the rig file could not be looked at")

    async def _look(self) -> None:
        """Tell once of each edit, whoever made it; the running settings are kept until somebody reloads."""
        async with self._one_at_a_time:
            text = await asyncio.to_thread(self._text_on_disk)
            edited = None if text == self._store.text else text
            if edited != self._seen:
                self._seen = edited
                if edited is not None:
                    self._tell_of_edit()
                self._tell_of_file()

    def _text_on_disk(self) -> str:
        """A file that is gone says nothing new: what it said is kept, and saved again with the next change."""
        try:
            return self._store.path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            return self._store.text

    def _tell_of_file(self) -> None:
        """To whoever shows it."""
        self._rig.announcements.publish({"type": "rig", "file": self.public()})

    def _tell_of_edit(self) -> None:
        path = self._store.path
        try:
            plan = self._store.plan_of_disk()
        except RigFileError as error:
            self._rig.announce(
                "warn",
                EVENT,
                f"the rig file was changed on disk and cannot be used; the rig is as it was. {error}",
            )
        else:
            self._rig.announce(
                "info",
                EVENT,
                f"the rig file {path} was changed on disk ({_listed(plan.changed)}); reload it to apply",
            )


def _is_of_looks(field: str) -> bool:
    return any(field == known or field.startswith(f"{known}.") for known in LOOKS)


def _listed(fields: Iterable[str]) -> str:
    return ", ".join(fields) or "no value differs"
