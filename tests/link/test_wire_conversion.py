"""SI to the wire and back: what fits arrives within a rounding, what is not allowed is refused."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from link_bench import ALLOCATION, COMMAND, CONFIGURATION

from control.link.board_limits import CONFIGURATION_LIMITS, objections
from control.link.conversion import (
    Configuration,
    DriveCommand,
    LinkError,
    configure_message,
    drive_message,
    heading_from,
    phase,
    phase_rate,
)
from control.model import wrap

BAD = (math.nan, math.inf, -math.inf)


@given(st.floats(-1000.0, 1000.0))
@settings(deadline=None)
def test_a_heading_survives_the_wire_up_to_whole_turns(heading: float) -> None:
    back = heading_from(phase(heading))
    assert -math.pi <= back < math.pi
    assert abs(wrap(back - heading)) < 1e-6


@given(st.floats(-20.0, 20.0))
@settings(deadline=None)
def test_a_rate_survives_the_wire(rate: float) -> None:
    assert phase_rate(rate) * 1e3 / 2**32 * math.tau == pytest.approx(rate, abs=1e-6)


def test_a_drive_in_the_units_of_the_wire() -> None:
    message = drive_message(replace(COMMAND, rate=-1.0, heading_goal=-math.pi / 2, pivot=-1), CONFIGURATION)
    assert message.flags == 0
    assert message.pivot == -1
    assert message.rate == -round(2**32 / math.tau / 1000)
    assert message.heading_goal == 3 * 2**30
    assert message.tilt == round(65536 * 25 / 360)
    assert message.field == 10000
    assert message.allocation == (13107, 0, 0, 0, 13107, 0, 0, 0, 13107)
    assert message.time_to_live == 120


def test_a_start_heading_is_the_arm_edge() -> None:
    message = drive_message(replace(COMMAND, start_heading=math.pi), CONFIGURATION)
    assert message.flags == 1
    assert message.start_heading == 2**31


@pytest.mark.parametrize(
    ("name", "allowed", "refused"),
    [
        ("rate", (-2.0, 0.0, 2.0), (-2.001, 2.001)),
        ("tilt", (0.0, math.radians(60)), (-0.001, math.radians(60.1))),
        ("field", (0.0, 0.02), (-1e-6, 0.0201)),
        ("time_to_live", (0.001, 1.0), (0.0, -0.1, 1.01)),
        ("heading_goal", (-500.0, 500.0), (1e7,)),
        ("start_heading", (-500.0, 500.0), (-1e7,)),
    ],
)
def test_a_drive_value_is_refused_outside_its_range_and_when_it_is_no_number(
    name: str, allowed: tuple[float, ...], refused: tuple[float, ...]
) -> None:
    for value in allowed:
        drive_message(replace(COMMAND, **{name: value}), CONFIGURATION)
    for value in (*refused, *BAD):
        with pytest.raises(LinkError, match=f"{name} is .* allowed is"):
            drive_message(replace(COMMAND, **{name: value}), CONFIGURATION)


@pytest.mark.parametrize("pivot", [0, 2, -2, math.nan])
def test_a_pivot_is_one_or_minus_one(pivot: float) -> None:
    with pytest.raises(LinkError, match="pivot"):
        drive_message(replace(COMMAND, pivot=pivot), CONFIGURATION)


@pytest.mark.parametrize("value", [2000.0, -2000.0, *BAD])
@pytest.mark.parametrize("place", range(9))
def test_an_allocation_entry_that_does_not_fit_is_refused(place: int, value: float) -> None:
    rows = [list(row) for row in ALLOCATION]
    rows[place // 3][place % 3] = value
    with pytest.raises(LinkError, match="allocation"):
        drive_message(replace(COMMAND, allocation=tuple(map(tuple, rows))), CONFIGURATION)


@pytest.mark.parametrize("shape", [(), ((1.0, 0.0, 0.0),), ((1.0, 0.0),) * 3, (1.0, 2.0, 3.0)])
def test_an_allocation_of_another_shape_is_refused(shape: tuple) -> None:
    with pytest.raises(LinkError, match="3 rows"):
        drive_message(replace(COMMAND, allocation=shape), CONFIGURATION)


@given(
    st.builds(
        DriveCommand,
        st.sampled_from((1, -1)),
        *[st.floats()] * 4,
        st.just(ALLOCATION),
        st.floats(),
        st.none() | st.floats(),
    )
)
@settings(max_examples=300, deadline=None, derandomize=True)
def test_no_float_gets_through_that_the_limits_forbid(command: DriveCommand) -> None:
    try:
        message = drive_message(command, CONFIGURATION)
    except LinkError:
        return
    limits = configure_message(CONFIGURATION)
    assert abs(message.rate) <= limits.max_rate
    assert message.tilt <= limits.max_tilt
    assert message.field <= limits.max_field
    assert 1 <= message.time_to_live <= 1000


def test_a_configuration_in_the_units_of_the_wire() -> None:
    message = configure_message(CONFIGURATION)
    assert message.current_limits == (8000, 8000, 8000)
    assert (message.dead_man, message.ramp) == (200, 50)
    assert message.field_slew == round(256 * 10000 / 300)
    assert message.resistances == (2500, 2000, 1500)
    assert message.inductances == (12500, 5500, 1400)
    assert (message.supply, message.max_field, message.max_tilt) == (24000, 20000, 10923)
    assert message.sense_gains == (8929,) * 6
    assert message.supply_scale == 55000


def test_each_coil_and_direction_has_its_own_sense_gain() -> None:
    gains = ((0.034, 0.035), (0.036, 0.037), (0.038, 0.039))
    message = configure_message(replace(CONFIGURATION, sense_gains=gains))
    assert message.sense_gains == tuple(round(256e3 * gain) for pair in gains for gain in pair)


@pytest.mark.parametrize("gain", [0.0, -0.034, 0.0174, 0.0437, *BAD])
def test_a_sense_gain_that_the_board_cannot_work_with_is_refused(gain: float) -> None:
    with pytest.raises(LinkError, match="sense gain of coil 2"):
        configure_message(replace(CONFIGURATION, sense_gains=((0.035, 0.035), (0.035, gain), (0.035, 0.035))))


@pytest.mark.parametrize("scale", [-0.1, 65.1, *BAD])
def test_a_supply_scale_outside_the_wire_is_refused(scale: float) -> None:
    with pytest.raises(LinkError, match="supply_scale"):
        configure_message(replace(CONFIGURATION, supply_scale=scale))


def test_a_supply_that_is_not_sensed_is_said_to_be_so() -> None:
    assert configure_message(replace(CONFIGURATION, supply_scale=0.0)).supply_scale == 0


POSITIVE = [
    name for name in Configuration.__dataclass_fields__ if name not in ("sense_gains", "supply_scale")
]


@pytest.mark.parametrize("name", POSITIVE)
@pytest.mark.parametrize("value", [0.0, -1.0, *BAD])
def test_a_configuration_value_that_is_not_positive_is_refused_by_name(name: str, value: float) -> None:
    given_value = (8.0, value, 8.0) if isinstance(getattr(CONFIGURATION, name), tuple) else value
    with pytest.raises(LinkError, match=name):
        configure_message(replace(CONFIGURATION, **{name: given_value}))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"resistances": (2.5, 100.0, 1.5)},
            "resistance of coil 2 of 100 ohm; the board takes 0.1 to 10 ohm",
        ),
        ({"inductances": (0.125, 0.055, 0.2)}, "inductance of coil 3 of 200 mH; the board takes 3 to 160 mH"),
        ({"inductances": (0.006, 0.055, 0.014)}, "coil 1 with L/R = 2.4 ms"),
        (
            {"current_limits": (8.0, 8.0, 12.5)},
            "current limit of coil 3 of 12.5 A; the board takes 0.001 to 12 A",
        ),
        ({"supply": 60.0}, "supply of 60 V; the board takes 5 to 50 V"),
        ({"dead_man": 0.6}, "dead-man time of 600 ms; the board takes 10 to 500 ms"),
    ],
)
def test_a_configuration_that_the_board_would_refuse_is_refused_with_what_it_takes(
    changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(LinkError, match=re.escape(words)):
        configure_message(replace(CONFIGURATION, **changes))


@pytest.mark.parametrize("name", CONFIGURATION_LIMITS)
def test_the_board_takes_what_the_host_may_send(name: str) -> None:
    """Each field at its limits, but for coils that would be too fast."""
    usual = configure_message(CONFIGURATION)
    for number in CONFIGURATION_LIMITS[name]:
        value = getattr(usual, name)
        extreme = replace(usual, **{name: (number,) * len(value) if isinstance(value, tuple) else number})
        assert [wrong for wrong in objections(extreme) if "L/R" not in wrong] == []
