"""The board: who answers, what it says of itself, its supply and its sensors at zero current."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from control.axes import AXES
from control.link.conversion import BoardState, LinkError, Telemetry
from control.link.port import Link
from control.link.probe import PortState, probe
from server.diagnosis.check import Check, info, ok, problem, warning
from server.settings import RigFile

READY_WITHIN = 6.0
"""A board has answered and taken its configuration by then, s: 2 s of an old bootloader, and three questions."""
REPORTS = 20
"""Reports that are averaged, 10 ms each."""
OFFSET = 0.1
"""Sensed current at zero that is still fine, A: three counts of the ADC. Beyond, the regulator is misled."""
SUPPLY_OFF = 0.1
"""Deviation from the rig file's supply that is still fine, as a share."""
SLOW = 20e-3
"""Round trip that is longer than this, s, is no quiet line (5 ms were measured on one)."""

Wait = Callable[[], None]
"""Lets a few milliseconds pass, on the clock that the link reads."""


@dataclass(frozen=True, slots=True)
class Heard:
    """What a board said. ready_after: from the opening to ready, s, None: never.  reason: why not."""

    ready_after: float | None
    reason: str
    firmware: str
    reports: tuple[Telemetry, ...]


def identify(port: str, baud: int) -> Check:
    """Ask a real board who it is, which resets it."""
    found = probe(port, baud)
    identity = found.identity
    if found.state is not PortState.OURS or identity is None:
        return problem("board", f"{port}: {found.message}", ADVICE[found.state])
    text = (
        f"{port}: firmware {identity.firmware}, protocol {identity.protocol}, boot id {identity.boot_id}, "
        f"last reset: {identity.reset_cause}, configuration {identity.configuration_hash:#06x}, "
        f"round trip {identity.round_trip * 1e3:.1f} ms"
    )
    if not identity.round_trip <= SLOW:
        return warning("board", text, "use a USB port of the computer itself, without a hub")
    if identity.reset_cause in ("watchdog", "brown out"):
        return warning(
            "board", text, "the board did not reset of its own free will: check its supply and cabling"
        )
    return ok("board", text)


ADVICE = {
    PortState.OURS: "",
    PortState.UNKNOWN: "check the cable",
    PortState.OTHER_VERSION: "flash the firmware of this program: pivotrig firmware flash",
    PortState.FOREIGN: "check link.port and link.baud, or flash the firmware: pivotrig firmware flash",
    PortState.BUSY: "close the other program: a serial monitor, or a running pivotrig (then ask its dashboard)",
    PortState.FORBIDDEN: "see the permission above",
    PortState.MISSING: "connect the board, or correct link.port",
    PortState.FAILED: "check the cable, then connect it anew",
}


def listen(link: Link, clock: Callable[[], float], wait: Wait) -> Heard:
    """Greet the board, configure it, hear it for a moment, and leave it at zero; raises `LinkError`.

    No drive command is ever sent, so that no current can flow.
    """
    opened = clock()
    ready_after: float | None = None
    reports: list[Telemetry] = []
    link.open()
    while len(reports) < REPORTS and clock() - opened < READY_WITHIN:
        wait()
        report = link.poll()
        if link.is_ready and ready_after is None:
            ready_after = clock() - opened
        if report is not None:
            reports.append(report)
    return Heard(ready_after, link.reason, link.status.firmware, tuple(reports))


def examine(link: Link, clock: Callable[[], float], wait: Wait, settings: RigFile) -> Iterator[Check]:
    try:
        heard = listen(link, clock, wait)
    except LinkError as error:
        yield problem("handshake", str(error), "see the board and the permission above")
        return
    finally:
        link.close()
    yield handshake(heard)
    if heard.reports:
        yield state(heard.reports[-1])
        yield supply(heard.reports[-1], settings.coils.supply_V)
        yield offsets(heard.reports)


def handshake(heard: Heard) -> Check:
    if heard.ready_after is None or not heard.reports:
        reason = heard.reason or "it took its configuration and says nothing"
        return problem("handshake", reason, "press the board's reset button, or flash its firmware anew")
    report = heard.reports[-1]
    return ok(
        "handshake",
        f"firmware {heard.firmware}, boot id {report.boot_id}, configured after {heard.ready_after * 1e3:.0f} ms "
        f"(hash {report.configuration_hash:#06x}); {report.bad} broken messages",
    )


def state(report: Telemetry) -> Check:
    if report.state in (BoardState.BOOTED, BoardState.READY, BoardState.EXPIRED, BoardState.STOPPED):
        faults = [fault for fault in report.faults if fault != "supply_low"]
        if not faults and not any(report.duty):
            return ok("board state", f"{report.state}, no driver fault, drive at zero")
    said = ", ".join(report.faults) or f"{report.state}, duty {report.duty}"
    return problem(
        "board state", said, "check the drivers' EN/DIAG lines and the wiring (control/firmware/README.md)"
    )


def supply(report: Telemetry, nominal: float) -> Check:
    if "supply_low" in report.faults:
        return problem("supply voltage", f"{report.supply:.1f} V: low or off", "switch the coils' supply on")
    if report.supply <= 0.0:
        return info(
            "supply voltage", f"not sensed; {nominal:g} V are assumed", "wire the divider to A5 to sense it"
        )
    found = f"{report.supply:.1f} V, {nominal:g} V in the rig file"
    if not abs(report.supply - nominal) <= SUPPLY_OFF * nominal:
        return warning(
            "supply voltage", found, "set the supply, or correct coils.supply_V and supply_full_scale_V"
        )
    return ok("supply voltage", found)


def offsets(reports: tuple[Telemetry, ...]) -> Check:
    """What the current sense shows while nothing is driven."""
    means = [sum(report.measured_currents[coil] for report in reports) / len(reports) for coil in range(3)]
    found = ", ".join(f"{axis} {mean:+.3f} A" for axis, mean in zip(AXES, means, strict=True))
    if not all(abs(mean) <= OFFSET for mean in means):
        return warning(
            "current sense", f"at zero drive: {found}", "check the sense wires, CS to A0 to A2, and ground"
        )
    return ok("current sense", f"at zero drive: {found}")
