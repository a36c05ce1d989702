"""`pivotrig study` with a rig: a campaign in this process, which ends with a signal, coils first."""

from __future__ import annotations

import signal
from pathlib import Path
from types import FrameType

from server.archive import Archive
from server.assembly import Machine, build_machine
from server.headless import Watch
from server.settings import RigFile
from server.signals import ENDING, ESTOP, handled
from server.studies.campaign.activity import Tell, tell_nobody
from server.studies.campaign.campaign import Campaign, Outcome
from server.studies.campaign.headless import HeadlessOperator
from server.studies.study import Study


def walk_campaign(
    study: Study, rig_file: RigFile, data: Path, tell: Tell = tell_nobody, watch: Watch | None = None
) -> Outcome:
    """Carry a study out on the rig of a rig file, on the main thread; a person has agreed that it is armed.

    tell: of what the campaign does.  watch: of every tick. Raises what `build_machine`, `Archive.open` and
    `Campaign.run` raise.
    """
    archive = Archive.open(data, patient=rig_file.is_simulated)
    try:
        machine = build_machine(rig_file, realtime=not rig_file.is_simulated)
        campaign = Campaign(
            study, HeadlessOperator(machine, archive.recorder, watch), archive.catalogue, tell
        )
        ends = _Ends(machine, campaign)
        with handled({**dict.fromkeys(ENDING, ends.end), ESTOP: ends.estop}):
            return campaign.run()
    finally:
        archive.close()


class _Ends:
    """What signals do: the coils first, and then the campaign. Ctrl-C is a person's stop, others are the program's
    end; a second one ends also what hangs."""

    def __init__(self, machine: Machine, campaign: Campaign) -> None:
        self._machine = machine
        self._campaign = campaign
        self._is_ending = False

    def end(self, number: int, _frame: FrameType | None) -> None:
        self._machine.stop_coils()
        is_person = number == signal.SIGINT
        reason = "stopped by the operator" if is_person else f"ended by {signal.Signals(number).name}"
        self._campaign.stop(reason, is_end=not is_person)
        if self._is_ending:
            raise KeyboardInterrupt
        self._is_ending = True

    def estop(self, _number: int, _frame: FrameType | None) -> None:
        self._machine.stop_coils()
        self._campaign.stop("emergency stop")
