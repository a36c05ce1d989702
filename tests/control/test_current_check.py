"""What is wrong with a current that is not as commanded, in words that name the thing to look at."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from control.current_check import AGREED, compare

LIMITS = (8.0, 8.0, 8.0)
ALLOWED = 1.2
"""15 % of 8 A."""
NOTHING = 0.4
"""5 % of 8 A."""
numbers = st.floats(-10.0, 10.0)
triples = st.tuples(numbers, numbers, numbers)


def look(commanded, sensed, *, supply_is_sensed: bool = True):
    return compare(commanded, sensed, LIMITS, supply_is_sensed=supply_is_sensed)


@given(triples, st.booleans())
def test_currents_that_agree_have_no_cause(commanded, sensed_supply) -> None:
    assert look(commanded, commanded, supply_is_sensed=sensed_supply) is AGREED
    mirrored = tuple(-current for current in commanded)
    assert look(commanded, mirrored) is AGREED, "the sense has no sign of its own"


@given(triples, triples, st.booleans())
def test_they_agree_exactly_within_15_percent_of_the_limit(commanded, sensed, sensed_supply) -> None:
    agree = all(abs(abs(c) - abs(s)) <= ALLOWED for c, s in zip(commanded, sensed, strict=True))
    assert (look(commanded, sensed, supply_is_sensed=sensed_supply) is AGREED) == agree


@pytest.mark.parametrize("coil", [0, 1, 2])
def test_one_coil_that_shows_nothing_is_named(coil: int) -> None:
    sensed = [5.0, 5.0, 5.0]
    sensed[coil] = 0.0
    found = look((5.0, -5.0, 5.0), tuple(sensed))
    assert found.code == "coil"
    assert found.message.startswith(f"coil {'xyz'[coil]} shows no current: check its leads")


def test_two_of_three_that_show_nothing_are_both_named() -> None:
    assert "coil x and z shows no current" in look((5.0, 5.0, 5.0), (0.0, 5.0, 0.0)).message


def test_the_only_coil_that_is_asked_is_a_coil_where_the_supply_is_known_to_be_on() -> None:
    assert look((5.0, 0.0, 0.0), (0.0, 0.0, 0.0)).code == "coil"


def test_the_only_coil_that_is_asked_may_be_the_supply_where_that_is_not_sensed() -> None:
    assert look((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), supply_is_sensed=False).code == "supply"


def test_no_current_anywhere_is_the_supply_where_that_is_not_sensed() -> None:
    found = look((5.0, 5.0, 2.0), (0.0, 0.0, 0.0), supply_is_sensed=False)
    assert (found.code, "is the supply of the coils on?" in found.message) == ("supply", True)


def test_no_current_anywhere_is_the_sense_where_the_supply_is_on() -> None:
    found = look((5.0, 5.0, 2.0), (0.0, 0.0, 0.0))
    assert found.code == "sense"
    assert "although the supply is on" in found.message


def test_two_coils_are_enough_to_blame_the_sense_of_all() -> None:
    assert look((-5.0, 5.0, 0.0), (0.0, 0.0, 0.0)).code == "sense"
    assert look((-5.0, -5.0, 0.0), (0.0, 0.0, 0.0), supply_is_sensed=False).code == "supply"


@pytest.mark.parametrize(("missing", "agrees"), [(1.19, True), (1.21, False)])
def test_a_seventh_of_the_limit_may_be_missing(missing: float, agrees: bool) -> None:
    for sensed in (5.0 - missing, 5.0 + missing):
        assert (look((5.0, 0.0, 0.0), (sensed, 0.0, 0.0)) is AGREED) == agrees


def test_a_coil_that_is_hardly_asked_says_nothing_about_the_supply() -> None:
    """z is asked for less than may be missing, so x and y are all that could show a current."""
    assert look((5.0, 5.0, ALLOWED), (0.0, 0.0, 0.0), supply_is_sensed=False).code == "supply"
    assert look((5.0, 5.0, 1.3), (0.0, 0.0, 1.3), supply_is_sensed=False).code == "coil"


@pytest.mark.parametrize(("sensed", "code"), [
    (0.0, "coil"), (math.nextafter(NOTHING, 0.0), "coil"), (-0.39, "coil"), (NOTHING, "sense"), (3.0, "sense"),
    (9.0, "sense"), (-9.0, "sense"),
])  # fmt: skip
def test_a_coil_shows_nothing_below_5_percent_of_its_limit(sensed: float, code: str) -> None:
    assert look((5.0, 5.0, 5.0), (5.0, sensed, 5.0)).code == code


def test_a_wrong_current_is_told_with_both_values() -> None:
    found = look((5.0, -7.0, 1.0), (5.0, -3.125, 1.0))
    assert found.message.startswith("coil y shows 3.12 A where 7.00 A are commanded")


def test_a_current_that_nobody_asked_for_is_the_senses() -> None:
    assert look((0.0, 0.0, 0.0), (0.0, 0.0, 2.0)).code == "sense"


@pytest.mark.parametrize("value", [math.nan, math.inf])
@pytest.mark.parametrize("supply_is_sensed", [True, False])
def test_a_current_that_is_no_number_never_agrees(value: float, supply_is_sensed: bool) -> None:
    assert look((5.0, 5.0, 5.0), (5.0, 5.0, value), supply_is_sensed=supply_is_sensed) is not AGREED
    assert look((5.0, value, 5.0), (5.0, 5.0, 5.0), supply_is_sensed=supply_is_sensed) is not AGREED
