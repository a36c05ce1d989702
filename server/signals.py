"""What signals mean to whoever drives coils: zero current first, then everything else.

Handlers run on the main thread between two of its instructions; stopping the coils never waits for anything.
"""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import FrameType

ESTOP = signal.SIGUSR1
"""`kill -USR1` is an emergency stop: the coils are off and stay off until a reset, the program lives on."""
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""Ctrl-C, a polite end, and the terminal that was closed."""

Handler = Callable[[int, FrameType | None], None]


@contextmanager
def handled(handlers: Mapping[signal.Signals, Handler | signal.Handlers]) -> Iterator[None]:
    """These handlers while it lasts, the former ones afterwards; on the main thread only."""
    before = {number: signal.signal(number, handler) for number, handler in handlers.items()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def coils_stop_first(stop: Callable[[], None]) -> Iterator[None]:
    """The first signal that ends the program stops the coils and is then an interruption like Ctrl-C.

    A second one changes nothing: what is being closed is closed to the end. An emergency stop stops as well.
    """
    is_ending = False

    def end(_number: int, _frame: FrameType | None) -> None:
        nonlocal is_ending
        stop()
        if not is_ending:
            is_ending = True
            raise KeyboardInterrupt

    def estop(_number: int, _frame: FrameType | None) -> None:
        stop()

    with handled({**dict.fromkeys(ENDING, end), ESTOP: estop}):
        yield


class ProgramEnds(KeyboardInterrupt):
    """Somebody else than the operator ends the program, politely: a computer that shuts down, a closed terminal."""


@contextmanager
def interrupted_once() -> Iterator[None]:
    """The first signal that ends the program is an interruption, by Ctrl-C or `ProgramEnds`; later ones are nothing.

    So what is being closed because of the first one is closed to the end.
    """
    is_ending = False

    def end(number: int, _frame: FrameType | None) -> None:
        nonlocal is_ending
        if not is_ending:
            is_ending = True
            raise KeyboardInterrupt if number == signal.SIGINT else ProgramEnds

    with handled(dict.fromkeys(ENDING, end)):
        yield
