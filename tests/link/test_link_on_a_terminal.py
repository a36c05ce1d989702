"""The link on a terminal of the operating system instead of `sim://`."""

from __future__ import annotations

import os
import pty
import time
import tty
from collections.abc import Iterator

import pytest
from link_bench import CONFIGURATION, drive_times

from control.link.conversion import LinkError
from control.link.port import Link
from control.link.session import LinkState


@pytest.fixture
def terminal() -> Iterator[tuple[int, str]]:
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    yield ours, os.ttyname(theirs)
    os.close(theirs)
    os.close(ours)


def test_a_real_terminal_that_nobody_reads_is_let_go_of(terminal: tuple[int, str]) -> None:
    """No board here: the session is told that it is ready, the kernel's buffer does the rest."""
    link = Link(terminal[1], 500000, CONFIGURATION, time.monotonic)
    link.open()
    link._session.state = LinkState.READY
    before = time.monotonic()
    with pytest.raises(LinkError, match="jammed"):
        drive_times(link, 100000)
    assert time.monotonic() - before < 2.0
    assert link.status.state == "closed"
    link.close()


def test_a_real_terminal_in_use_is_refused(terminal: tuple[int, str]) -> None:
    first = Link(terminal[1], 500000, CONFIGURATION, time.monotonic)
    second = Link(terminal[1], 500000, CONFIGURATION, time.monotonic)
    first.open()
    with pytest.raises(LinkError, match="the other program that has it open"):
        second.open()
    first.close()


def test_a_real_terminal_that_hangs_up_closes_the_link() -> None:
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    link = Link(os.ttyname(theirs), 500000, CONFIGURATION, time.monotonic)
    link.open()
    os.close(theirs)
    os.close(ours)
    link.poll()
    link.poll()
    assert link.status.state == "closed"
    assert "lost" in link.reason
    link.close()
