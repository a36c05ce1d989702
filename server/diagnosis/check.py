"""One thing that was looked at, what was found, and what to do about it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Level(StrEnum):
    """INFO: neither good nor bad.  WARNING: works, but look at it.  PROBLEM: the rig will not work like this."""

    OK = "ok"
    INFO = "info"
    WARNING = "warning"
    PROBLEM = "problem"


@dataclass(frozen=True, slots=True)
class Check:
    """name: what was looked at.  finding: in words, with the figures.  advice: what to do, "" for nothing."""

    name: str
    level: Level
    finding: str
    advice: str = ""


def ok(name: str, finding: str) -> Check:
    return Check(name, Level.OK, finding)


def info(name: str, finding: str, advice: str = "") -> Check:
    return Check(name, Level.INFO, finding, advice)


def warning(name: str, finding: str, advice: str) -> Check:
    return Check(name, Level.WARNING, finding, advice)


def problem(name: str, finding: str, advice: str) -> Check:
    return Check(name, Level.PROBLEM, finding, advice)
