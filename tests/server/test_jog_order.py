"""Jogs that overtake each other on their way: a late one starts nothing again."""

import pytest

from control.safety import Refused
from server.jog_order import HANDS, JogOrder
from tests.server.rig_visit import act, arm, until

pytestmark = pytest.mark.anyio

SWING = {"pivot": 1, "rate_deg_s": 20.0}


def test_a_number_counts_once_and_only_upwards() -> None:
    order = JogOrder()
    order.take("a", 3)
    for late in (0, 2, 3):
        with pytest.raises(Refused, match="overtaken by a newer one"):
            order.take("a", late)
    order.take("a", 4)


def test_each_hand_has_its_own_numbers() -> None:
    order = JogOrder()
    order.take("a", 10)
    order.take("b", 1)
    with pytest.raises(Refused):
        order.take("a", 9)


def test_hands_that_have_been_away_for_long_are_forgotten() -> None:
    order = JogOrder()
    for number in range(10 * HANDS):
        order.take(f"hand {number}", 1)
    order.take("hand 0", 1)
    with pytest.raises(Refused):
        order.take(f"hand {10 * HANDS - 1}", 1)


async def test_a_jog_that_comes_after_its_own_stop_does_not_move_the_robot(api) -> None:
    await api.post("/disarm", json={})
    await until(api, tracking="locked")
    await arm(api)
    await act(api, "/manual", **SWING, hand="page", number=1)
    await act(api, "/manual", pivot=1, rate_deg_s=0.0, hand="page", number=3)
    late = await api.post("/manual", json={**SWING, "hand": "page", "number": 2})
    assert late.status_code == 409
    assert "overtaken" in late.json()["detail"]
    assert (await api.get("/state")).json()["command"]["rate_deg_s"] == 0.0


async def test_a_number_without_a_hand_is_refused_in_words(api) -> None:
    answer = await api.post("/manual", json={**SWING, "number": 2})
    assert answer.status_code == 422
    assert "hand and number come together" in answer.text
