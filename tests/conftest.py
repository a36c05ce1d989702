"""What every test is held to: no thread is left behind. And how many repetitions a test takes."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator

import pytest
from hypothesis import settings

settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("elsewhere", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") == "true" else "elsewhere")
"""What decides whether a change lands tries the same examples each time; everywhere else they are new ones. How long
one example takes says more about what else the computer does than about the code."""

GRACE = 2.0
"""A thread that is ending may take this long, s."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--board", metavar="PORT", help="also put a real board, on this port, to the contract's tests"
    )


@pytest.fixture(autouse=True)
def no_thread_is_left_behind(request: pytest.FixtureRequest) -> Iterator[None]:
    before = set(threading.enumerate())
    yield
    if request.node.get_closest_marker("leaves_threads"):
        return
    deadline = time.monotonic() + GRACE
    while (left := _alive(before)) and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not left, f"threads left behind: {left}"


def _alive(before: set[threading.Thread]) -> list[threading.Thread]:
    return [thread for thread in threading.enumerate() if thread not in before and not _is_shared(thread)]


def _is_shared(thread: threading.Thread) -> bool:
    """asyncio's default executor and playwright's driver live as long as the session."""
    return thread.name.startswith(("asyncio_", "AnyIO worker thread", "Dummy"))


@pytest.fixture(scope="session", autouse=True)
def _nobody_s_own_data_is_used(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The rig file that the person who tests has saved is no part of the tests."""
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("XDG_DATA_HOME", str(tmp_path_factory.mktemp("data")))
        yield


@pytest.fixture(scope="session")
def full() -> bool:
    """Whether the stated numbers of repetitions are asked for (`make test-full`)."""
    return os.environ.get("PIVOTRIG_FULL") == "1"
