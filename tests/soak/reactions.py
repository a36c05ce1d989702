"""What the rig did about each fault of a soak, held against what it promises."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from server.fault_watch import ALLOWANCE
from tests.soak.broken import InvariantBroken

MS = 1e3
STALL = 0.1
"""A rig that had to wait so long for a processor, s, lets go because of that and not because of the fault: no frame
for 0.1 s is what it holds for."""
STARVED = "starved"
"""The verdict where the machine, and not the rig, has been late."""


@dataclass(slots=True)
class Kept:
    """Of one kind of fault. Times in ms, of those reactions for which a promise is made."""

    verdicts: Counter[str] = field(default_factory=Counter)
    noticed_ms: float | None = None
    gone_ms: float | None = None
    promised_ms: float | None = None


@dataclass(slots=True)
class Reactions:
    """By the kind of fault."""

    kinds: dict[str, Kept] = field(default_factory=dict)

    def judge(self, entry: dict[str, Any], starved: float, is_usual: bool) -> str:
        """The verdict. entry: of the server's list of faults.  starved: how long the rig had to wait for a processor
        meanwhile, s. Raises `InvariantBroken` for a promise that was not kept."""
        reaction, name = entry["reaction"], entry["name"]
        kept = self.kinds.setdefault(name, Kept(promised_ms=entry["promise"]["gone_ms"]))
        verdict = reaction["verdict"]
        if verdict == "broken":
            if not is_excused(entry, starved):
                raise InvariantBroken(_said(entry, starved))
            verdict = STARVED
        kept.verdicts[verdict] += 1
        if is_usual and verdict == "kept":
            kept.noticed_ms = _larger(kept.noticed_ms, reaction["noticed_ms"])
            kept.gone_ms = _larger(kept.gone_ms, reaction["gone_ms"])
        return verdict


def is_excused(entry: dict[str, Any], starved: float) -> bool:
    """Whether it was late by no more than the rig was kept from the processor, or let go because it was."""
    reaction, promise = entry["reaction"], entry["promise"]
    if reaction["became"] not in promise["states"]:
        return starved >= STALL and reaction["became"] == "held"
    due = (promise["noticed_ms"], reaction["noticed_ms"]), (promise["gone_ms"], reaction["gone_ms"])
    allowed = (ALLOWANCE + starved) * MS
    return all(
        promised is None or (took is not None and took <= promised + allowed) for promised, took in due
    )


def _said(entry: dict[str, Any], starved: float) -> str:
    promise, reaction = entry["promise"], entry["reaction"]
    return (
        f"{entry['name']}: promised {' or '.join(promise['states'])}, noticed in {promise['noticed_ms']} ms, "
        f"no current after {promise['gone_ms']} ms; it became {reaction['became']} ({reaction['reason']}), "
        f"noticed in {reaction['noticed_ms']} ms, no current after {reaction['gone_ms']} ms; "
        f"kept from the processor for {starved * MS:.0f} ms meanwhile"
    )


def _larger(known: float | None, new: float | None) -> float | None:
    return new if known is None else known if new is None else max(known, new)
