"""Asks a disk something that it may never answer: a folder of another computer can hang for ever."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future

from control.safety import Refused

WITHIN = 3.0
"""A disk that takes longer to make an empty file is in no state to be recorded to, s."""
NO_ANSWER = (
    f"the folder of the recordings has not answered for {WITHIN:.0f} s; see to its disk, or switch recording off in "
    "the rig file"
)


class DiskAnswer:
    """One question at a time, in a thread that nobody has to wait for, not even the program's end."""

    def __init__(self) -> None:
        self._asking = threading.Lock()

    def wait_for(self, question: Callable[[], None]) -> None:
        """Raises what `question` raises, or `Refused` when it, or one before it, is not over in time."""
        if not self._asking.acquire(timeout=WITHIN):
            raise Refused(NO_ANSWER)
        answer: Future[None] = Future()
        threading.Thread(
            target=self._ask, args=(question, answer), name="recorder's question", daemon=True
        ).start()
        try:
            answer.result(WITHIN)
        except TimeoutError:
            raise Refused(NO_ANSWER) from None

    def _ask(self, question: Callable[[], None], answer: Future[None]) -> None:
        try:
            answer.set_result(question())
        except Exception as error:  # noqa: BLE001 (it goes to who has asked)
            answer.set_exception(error)
        finally:
            self._asking.release()
