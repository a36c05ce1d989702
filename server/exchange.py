"""One machine in place of another: a camera and a port can be open only once, so the old one goes first."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

from control.coil_heat import CoilHeat
from control.link.conversion import LinkError
from control.safety import Refused
from control.snapshot import RigState
from server.assembly import Machine, build_machine
from server.settings import RigFile
from vision.sources.opening import CameraError

log = logging.getLogger(__name__)

EXPECTED = (ValueError, LinkError, CameraError, OSError)
"""How a machine fails that is all right but for its settings or its devices."""

Build = Callable[[RigFile], Machine]


class NoMachine(Refused):
    """Neither the new machine nor the old one can be opened."""


@dataclass(frozen=True, slots=True)
class Exchange:
    """machine: the one that is open now.  failure: why it is the old one again; None when it is the new one."""

    machine: Machine
    failure: Exception | None


def require_disarmed(state: RigState, what: str = "the rig") -> None:
    """Raises `Refused` unless nothing is going on."""
    if state is not RigState.DISARMED:
        raise Refused(f"{what} can only be changed while it is disarmed; it is {state}: disarm it first")


def rehearse(settings: RigFile) -> None:
    """Build the rig with its devices simulated, so that values which do not go together are found before anything
    is closed; raises ValueError or `LinkError`."""
    build_machine(without_devices(settings), realtime=False).close()


def without_devices(settings: RigFile) -> RigFile:
    """The same rig in memory only: nothing of this computer's is opened or written."""
    return without_traffic_log(settings.as_simulated())


def without_traffic_log(settings: RigFile) -> RigFile:
    """The same rig, of whose traffic nothing is kept: the log belongs to who drives it."""
    whole = settings.model_dump(mode="json")
    whole["link"]["traffic_log"] = False
    return RigFile.model_validate(whole)


def exchange(old: Machine, settings: RigFile, build: Build) -> Exchange:
    """Close the old machine, with its coils at zero, and open one with other settings, or else the old one again.

    A board or a camera that was not there before need not be there afterwards. Blocks for as long as a camera takes
    to open. Raises `NoMachine`.
    """
    had_no_board, had_no_camera = not old.link.is_ready, bool(old.camera.trouble)
    old.close()
    try:
        machine, failure = _opened(settings, build, had_no_board, had_no_camera), None
    except Exception as error:
        failure = error
        log.warning(
            "the changed rig could not be opened: %s", error, exc_info=not isinstance(error, EXPECTED)
        )
        machine = _restored(old.settings, build, error)
    if machine.camera.simulated == old.camera.simulated:
        machine.loop.coil_heat = carried_heat(old, machine.settings)
    return Exchange(machine, failure)


def carried_heat(old: Machine, settings: RigFile) -> CoilHeat:
    """The same coils, as hot as they are; their shares change with the current that they are said to bear."""
    heat = old.loop.coil_heat
    bore, bear = old.settings.limits.continuous_A, settings.limits.continuous_A
    one, two, three = (
        share * (before / now) ** 2 for share, before, now in zip(heat.shares, bore, bear, strict=True)
    )
    return CoilHeat((one, two, three), heat.is_too_hot)


def _restored(settings: RigFile, build: Build, failure: Exception) -> Machine:
    try:
        return _opened(settings, build, board_may_come=True, camera_may_come=True)
    except Exception as error:
        raise NoMachine(
            f"the changed rig could not be opened ({failure}), and the rig as it was cannot be opened any more "
            f"({error}); see to its devices, then reload the rig file or restart pivotrig"
        ) from error


def _opened(settings: RigFile, build: Build, board_may_come: bool, camera_may_come: bool) -> Machine:
    machine = build(settings)
    try:
        machine.open(patiently=board_may_come, camera_may_come=camera_may_come)
    except BaseException:
        machine.close()
        raise
    return machine
