"""The boards that the contract's tests are run against."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from board_contact import BoardContact, SteppedContact, real, stepped


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
