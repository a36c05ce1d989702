"""Why a board is not ready, in sentences for people: what was received, what is allowed, what to do."""

from __future__ import annotations

from control.link import messages, wire

FLASH = "flash the firmware that belongs to this program (`pivotrig firmware flash`)"


def other_version(firmware: str, version: int) -> str:
    return (
        f"the board's firmware {firmware} speaks protocol version {version}, this program speaks "
        f"{wire.PROTOCOL_VERSION}: {FLASH}"
    )


def other_configuration(received: int, sent: int) -> str:
    """The hashes of the configuration that the board took, and of the one that was sent."""
    return (
        f"the board took another configuration than was sent (hash {received:#06x}, not {sent:#06x}): {FLASH}"
    )


def refused_configuration(refusal: int) -> str:
    """Why a board that is being configured refused a message last; "" when that explains nothing."""
    if refusal == messages.Refusal.CONFIGURATION:
        return "the board refuses the configuration: a limit or coil constant is outside its range"
    if refusal == messages.Refusal.STATE:
        return "the board refuses the configuration in its present state"
    return ""


def no_answer(has_heard_noise: bool) -> str:
    heard = "something speaks that is not our firmware" if has_heard_noise else "nothing answers"
    return (
        f"{heard} on this port: check the port and the baud rate, or flash the board "
        "(`pivotrig firmware flash`); `pivotrig doctor` looks closer"
    )


def was_reset(before: int, now: int) -> str:
    return f"the board was reset (boot id {before} -> {now})"


def hears_late(late: float, allowed: float) -> str:
    """late, allowed: age of a command that the board has not heard, s."""
    return (
        f"the board has not heard a command for {late:.2f} s, at most {allowed} s are allowed: the line is too slow "
        "or loses too much; check the cable and what else uses its USB hub"
    )
