"""Random exchanges with a board: values dense around every limit, numbers in and out of order, broken frames."""

from __future__ import annotations

import random
from dataclasses import replace

from twins import ARMING, CALM, CONFIGURE, NOMINAL, Twins

from control.link import messages, wire
from control.link.board_limits import CONFIGURATION_LIMITS
from control.link.messages import Configure, Drive, Hello, Message, Stop

FULL_COUNT = 1023


def around(source: random.Random, *places: int, low: int, high: int) -> int:
    """A value at a limit, one beside it, an extreme of the field, or any."""
    near = [place + step for place in places for step in (-1, 0, 1)]
    return source.choice(
        [*(value for value in near if low <= value <= high), low, high, source.randint(low, high)]
    )


def configuration(source: random.Random) -> Configure:
    """Mostly allowed, with a field or two at the edge of its range."""
    changed: dict[str, int | tuple[int, ...]] = {}
    for name in source.sample(sorted(CONFIGURATION_LIMITS), k=source.choice((0, 0, 1, 2))):
        low, high = CONFIGURATION_LIMITS[name]
        top = 2**32 - 1 if name == "max_rate" else 65535
        value = getattr(CONFIGURE, name)
        if isinstance(value, tuple):
            changed[name] = tuple(around(source, low, high, low=0, high=top) for _ in value)
        else:
            changed[name] = around(source, low, high, low=0, high=top)
    return replace(CONFIGURE, **changed)


def drive(source: random.Random, limits: Configure) -> Drive:
    """Mostly one that a board obeys."""
    base = source.choice((CALM, CALM, ARMING))
    rate = min(limits.max_rate, 2**31 - 2)
    ranges = {
        "flags": (0, 255, (0, 1)),
        "pivot": (-128, 127, (-1, 1)),
        "rate": (-(2**31), 2**31 - 1, (-rate, 0, rate)),
        "heading_goal": (0, 2**32 - 1, (0, 2**31)),
        "start_heading": (0, 2**32 - 1, (0, 2**31)),
        "tilt": (0, 65535, (limits.max_tilt,)),
        "field": (0, 65535, (limits.max_field,)),
        "time_to_live": (0, 65535, (limits.dead_man, 1)),
    }
    changed: dict[str, int | tuple[int, ...]] = {"pivot": source.choice((1, -1))}
    for name in source.sample(sorted(ranges), k=source.choice((0, 1, 1, 2))):
        low, high, places = ranges[name]
        changed[name] = around(source, *places, low=low, high=high)
    if source.random() < 0.3:
        changed["allocation"] = tuple(around(source, 0, low=-32768, high=32767) for _ in range(9))
    return replace(base, **changed)


class Exchange:
    """One random conversation of both boards; they are compared after every message and every tick."""

    def __init__(self, twins: Twins, seed: int) -> None:
        self.twins = twins
        self.source = random.Random(seed)
        self.configure = CONFIGURE
        self.obeyed = 0

    def begin(self) -> None:
        """As a host does, or at once."""
        if self.source.random() < 0.8:
            self.twins.say(Hello())
            self.configure = configuration(self.source)
            self.twins.say(self.configure)

    def revive(self) -> None:
        """What an operator does after a stop or a fault."""
        for message in (Hello(), CONFIGURE, ARMING):
            self.twins.say(message)
        self.configure = CONFIGURE

    def step(self) -> None:
        if self.twins.twin.state != messages.BoardCode.DRIVING and self.source.random() < 0.3:
            self.revive()
        kind = self.source.choices((self.command, self.ticks, self.broken, self.condition), (10, 10, 2, 1))[0]
        kind()
        self.obeyed += self.twins.twin.state == messages.BoardCode.DRIVING

    def command(self) -> None:
        kind = self.source.choices(("drive", "configure", "hello", "stop", "other"), (16, 2, 1, 1, 1))[0]
        message: Message
        if kind == "drive":
            message = drive(self.source, self.configure)
        elif kind == "configure":
            message = self.configure = configuration(self.source)
        elif kind == "hello":
            message = Hello()
        elif kind == "stop":
            message = Stop()
        else:
            message = messages.Banner((0, 1, 0), 1, 2)
        self.twins.say(message, **self.header())

    def header(self) -> dict[str, int]:
        """Mostly the right one."""
        source, changed = self.source, {}
        if source.random() < 0.1:
            ahead = source.choice((0, -1, 2, 999, 1000, 1001, 1002, 40000))
            changed["sequence"] = (self.twins.twin._last_sequence + ahead) % 65536
        if source.random() < 0.03:
            changed["boot_id"] = source.choice((0, self.twins.boot_id + 1, 65535))
        if source.random() < 0.02:
            changed["version"] = source.choice((0, 2, 255))
        return changed

    def ticks(self) -> None:
        """With the true currents, or for a moment with senses that show anything."""
        count = self.source.choices((1, 2, 9, 17, 40, 160), (6, 6, 6, 6, 2, 1))[0]
        if self.source.random() < 0.8:
            self.twins.run(count)
            return
        for _ in range(min(count, 9)):
            x, y, z = (self.reading() for _ in range(3))
            self.twins.tick(
                (x, y, z), self.source.choice((NOMINAL, NOMINAL, 0, 1, FULL_COUNT, self.reading()))
            )

    def reading(self) -> int:
        return around(self.source, 286, 287, 335, low=0, high=self.source.choice((20, 200, FULL_COUNT)))

    def broken(self) -> None:
        self.twins.receive(mutated(self.source, wire.encode(CALM, self.twins.sequence + 1 & 0xFFFF, 7)))

    def condition(self) -> None:
        self.twins.set_driver_fault(self.source.random() < 0.1)


def mutated(source: random.Random, frame: bytes) -> bytes:
    """A frame with a few wrong, missing, doubled or foreign bytes."""
    data = bytearray(frame)
    for _ in range(source.choice((1, 1, 2, 5))):
        place = source.randrange(len(data))
        match source.randrange(5):
            case 0:
                data[place] ^= 1 << source.randrange(8)
            case 1:
                del data[place : place + source.choice((1, 1, 7))]
            case 2:
                data[place:place] = source.randbytes(source.choice((1, 1, 30)))
            case 3:
                data[place] = 0
            case _:
                data[place:place] = data[place : place + 20]
        data = data or bytearray(b"\0")
    return bytes(data)
