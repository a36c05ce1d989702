"""What happens in a soak: an endless list of acts that follows from its seed alone.

Acts are dealt as from shuffled decks, so every kind of fault and everything else that an operator does comes once in
each round of some minutes, in an order that nobody has thought of.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from control.simulation.faults.injection import KINDS
from tests.faults.promises import PROMISES


class What(StrEnum):
    """An act of the operator, but for `fault`, which is the world's."""

    FAULT = "fault"
    TWO_FAULTS = "two faults"
    PAUSE = "pause"
    STOP = "stop"
    ESTOP = "e-stop"
    JOG = "jog"
    SELECT = "selection"
    CHANGE = "change while it walks"
    REFUSED = "refused requests"
    EXPORT = "exports"
    REPLAY = "replay"
    DELETE = "runs deleted"
    SILENCE = "operator silent"
    WALK = "walk"


@dataclass(frozen=True, slots=True)
class Walk:
    """A run that is started where an act needs one. attended: held when its operator is silent."""

    controller: str
    trajectory: str
    attended: bool


@dataclass(frozen=True, slots=True)
class Fault:
    """As `POST /simulation/faults` takes it. is_usual: the promise of its kind is for this."""

    name: str
    is_usual: bool
    more: Mapping[str, Any] = field(default_factory=dict)

    @property
    def body(self) -> dict[str, Any]:
        return {"name": self.name, "parameters": dict(PROMISES[self.name].parameters), **self.more}


@dataclass(frozen=True, slots=True)
class Act:
    """number: in the schedule, from 1.  seconds: how long it goes on."""

    number: int
    what: What
    walk: Walk
    seconds: float
    faults: tuple[Fault, ...] = ()

    @property
    def title(self) -> str:
        return " and ".join(fault.name for fault in self.faults) or self.what.value


CONTROLLERS = "geometric", "gradient", "planner"
TRAJECTORIES = "eight", "circle", "line", "polygon", "spiral", "lissajous", "letter"
LOOKS_FOR = 2.3
"""A fault stays at least so long, s: a rig that carries on has kept its promise after 2 s."""
USUAL = 0.75
"""Share of the faults that stay until they are taken away, for which the promises are made."""
PER_ROUND = {
    What.TWO_FAULTS: 3, What.PAUSE: 2, What.STOP: 2, What.ESTOP: 2, What.JOG: 2, What.SELECT: 2, What.CHANGE: 3,
    What.REFUSED: 3, What.EXPORT: 3, What.REPLAY: 2, What.DELETE: 2, What.SILENCE: 1, What.WALK: 3,
}  # fmt: skip
"""How often each act comes in a round, in which each fault comes once."""


def acts(seed: int) -> Iterator[Act]:
    """Without end; the same for the same seed."""
    chance = random.Random(seed)
    number = 0
    while True:
        deck: list[What | str] = [*KINDS, *(what for what, often in PER_ROUND.items() for _ in range(often))]
        chance.shuffle(deck)
        for card in deck:
            number += 1
            yield _act(number, card, chance)


def _act(number: int, card: What | str, chance: random.Random) -> Act:
    walk = Walk(chance.choice(CONTROLLERS), chance.choice(TRAJECTORIES), chance.random() < 0.5)
    seconds = LOOKS_FOR + chance.uniform(0.0, 1.5)
    if card is What.TWO_FAULTS:
        pair = tuple(Fault(name, is_usual=False) for name in chance.sample(sorted(KINDS), 2))
        return Act(number, card, walk, seconds, pair)
    if isinstance(card, What):
        return Act(number, card, walk, seconds)
    longer = PROMISES[card].watch - 1.0
    return Act(number, What.FAULT, walk, seconds + longer, (_fault(card, chance),))


def _fault(name: str, chance: random.Random) -> Fault:
    """As its promise has it, or for a moment, or coming and going."""
    if KINDS[name].happens_once or chance.random() < USUAL:
        return Fault(name, is_usual=True)
    if chance.random() < 0.5:
        return Fault(name, False, {"duration_s": round(chance.uniform(0.05, 1.5), 2)})
    on, off = round(chance.uniform(0.05, 0.6), 2), round(chance.uniform(0.05, 0.6), 2)
    return Fault(name, False, {"intermittent": {"on_s": on, "off_s": off}})
