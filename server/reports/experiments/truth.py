"""Whether the data bear a statement out: yes, no, or they do not tell; only intervals decide."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from control.studies.analysis.comparison import Order, pair
from control.studies.analysis.intervals import Interval
from server.reports.findings import Finding, Verdict

Array = NDArray[np.float64]
UNDECIDED = "the intervals of these runs do not tell"


class Truth(StrEnum):
    YES = "yes"
    NO = "no"
    OPEN = "open"


VERDICTS = {
    Truth.YES: Verdict.REPRODUCED,
    Truth.NO: Verdict.NOT_REPRODUCED,
    Truth.OPEN: Verdict.NOT_COMPARABLE,
}


def of(holds: bool) -> Truth:
    return Truth.YES if holds else Truth.NO


def below(one: Array, other: Array) -> Truth:
    """Whether the mean of `one` lies below that of `other` (finished runs), by Welch's interval of the difference."""
    if not (len(one) and len(other)):
        return Truth.OPEN
    if _exact(one) and _exact(other):
        return of(float(one[0]) < float(other[0]))
    order = pair(one, other).order
    return {Order.LOWER: Truth.YES, Order.HIGHER: Truth.NO, Order.OPEN: Truth.OPEN}[order]


def _exact(values: Array) -> bool:
    """A plant without scatter gives the same figure each time."""
    return len(values) > 1 and float(np.ptp(values)) == 0.0


def lies_below(one: Interval, other: Interval) -> Truth:
    """By two intervals that do not overlap."""
    if one.high < other.low:
        return Truth.YES
    return Truth.NO if one.low > other.high else Truth.OPEN


def all_of(truths: Iterable[Truth]) -> Truth:
    """No where one is no; open where nothing was asked."""
    found = set(truths)
    if Truth.NO in found:
        return Truth.NO
    return Truth.YES if found == {Truth.YES} else Truth.OPEN


def most_of(truths: Sequence[Truth]) -> Truth:
    """Yes or no where more than half of all say so."""
    for truth in (Truth.YES, Truth.NO):
        if 2 * sum(one is truth for one in truths) > len(truths):
            return truth
    return Truth.OPEN


def counted(truths: Sequence[Truth]) -> str:
    """yes in 3 of 21, no in 16, open in 2."""
    numbers = {truth: sum(one is truth for one in truths) for truth in Truth}
    words = f"yes in {numbers[Truth.YES]} of {len(truths)}, no in {numbers[Truth.NO]}"
    return f"{words}, not told in {numbers[Truth.OPEN]}" if numbers[Truth.OPEN] else words


def finding(section: str, paper: str, ours: str, truth: Truth, note: str = "") -> Finding:
    """What the data do not tell is not comparable, and says so."""
    if truth is Truth.OPEN:
        note = f"{UNDECIDED}; {note}" if note else UNDECIDED
    return Finding(section, paper, ours, VERDICTS[truth], note)
