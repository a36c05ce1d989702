"""The boards that the contract's tests are run against, and the twin and the core side by side."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from board_contact import BoardContact, SteppedContact, real, stepped
from twins import ARMING, CONFIGURE, Twins

from control.link.messages import Hello


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """`any_board` is a real one too where a port was named; `board` is one that can be stepped and harmed."""
    if "board" in metafunc.fixturenames:
        metafunc.parametrize("board", ["twin", "avr"], indirect=True)
    if "any_board" in metafunc.fixturenames:
        named = ["real"] if metafunc.config.getoption("--board") else []
        metafunc.parametrize("any_board", ["twin", "avr", *named], indirect=True)


@pytest.fixture
def board(request: pytest.FixtureRequest) -> Iterator[SteppedContact]:
    with stepped(request.param) as contact:
        yield contact


@pytest.fixture
def any_board(request: pytest.FixtureRequest) -> Iterator[BoardContact]:
    port = request.config.getoption("--board")
    with real(str(port)) if request.param == "real" else stepped(request.param) as contact:
        yield contact


@pytest.fixture
def twins() -> Iterator[Twins]:
    with Twins() as pair:
        yield pair


@pytest.fixture
def ready(twins: Twins) -> Twins:
    twins.say(Hello())
    twins.say(CONFIGURE)
    return twins


@pytest.fixture
def driving(ready: Twins) -> Twins:
    ready.say(ARMING)
    ready.run(20)
    return ready
