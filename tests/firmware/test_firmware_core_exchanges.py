"""Whatever a host, a line or a sense does: the C++ core and the twin never differ by a byte or a step."""

from __future__ import annotations

from exchanges import Exchange
from hypothesis import given, settings
from hypothesis import strategies as st
from twins import Twins


@given(st.integers(0, 2**64 - 1), st.integers(10, 120))
@settings(max_examples=60, deadline=None)
def test_the_core_follows_the_twin_through_any_exchange(seed: int, steps: int) -> None:
    exchanged(seed, steps)


def test_long_exchanges_agree_and_drive(full: bool) -> None:
    """Most of the time in them a drive is obeyed, so that there is something to agree on."""
    count, steps = (100, 600) if full else (12, 300)
    driven = sum(exchanged(seed, steps) for seed in range(count))
    assert driven > 0.3 * count * steps


def exchanged(seed: int, steps: int) -> int:
    """Steps after which the boards were driving."""
    with Twins() as twins:
        exchange = Exchange(twins, seed)
        exchange.begin()
        for _ in range(steps):
            exchange.step()
        return exchange.obeyed
