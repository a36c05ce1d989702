"""What a person types while a coil is held: read line by line, and never waited for longer than the coil is held."""

import os
import sys
from collections.abc import Iterator

import pytest
import typer

from server.commands.answers import Answers


@pytest.fixture
def keyboard(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The end of a pipe to type into; the other one is the program's standard input."""
    reading, writing = os.pipe()
    with os.fdopen(reading) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        yield writing


def test_lines_that_come_together_are_answers_one_after_the_other(keyboard: int) -> None:
    os.write(keyboard, b"1.5\nno idea\nnan\n-2.25\n")
    os.close(keyboard)
    answers = Answers()
    assert answers.number("first", lambda: True) == 1.5
    assert answers.number("second", lambda: True) == -2.25
    with pytest.raises(typer.Abort):
        answers.number("third", lambda: True)


def test_nobody_is_waited_for_once_the_coil_is_not_held_any_more(keyboard: int) -> None:
    held = iter([True, True, False])
    with pytest.raises(typer.Abort):
        Answers().number("field", lambda: next(held))
    os.close(keyboard)
