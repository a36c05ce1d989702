"""Driving by hand: the robot moves while something is held, and whatever takes the hand away stops it."""

from __future__ import annotations

import contextlib
import math
import re
import urllib.error
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, becomes_true, eventually, rig_state
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

GAMEPAD = """() => {
  const button = (pressed) => ({ pressed, touched: pressed, value: pressed ? 1 : 0 });
  const pad = {
    id: "Test pad", index: 0, connected: true, mapping: "standard", timestamp: 0,
    axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 }, () => button(false)),
  };
  window.hands = { tilt: (axis, value) => { pad.axes[axis] = value; }, hold: (on) => { pad.buttons[4] = button(on); },
                   pull: () => { pad.connected = false; }, back: () => { pad.connected = true; } };
  navigator.getGamepads = () => [pad, null, null, null];
}"""
"""There is none here: what the browser would say of one, moved by the test's hands."""


STEPS = {"disarmed": "/arm", "held": "/runs/current/resume"}
"""What leads from each state to an armed rig."""
IN_THE_MIDDLE = {"name": "robot_put", "parameters": {"x_mm": 0.0, "y_mm": 0.0, "heading_deg": 90.0}}
"""No swing leads out of the workspace from there."""


@pytest.fixture(scope="module")
def tab(served: ServedRig, open_lasting_tab: OpenTab) -> Visit:
    return open_lasting_tab(served.url, scene=False)


@pytest.fixture
def page(tab: Visit, served: ServedRig) -> Iterator[Page]:
    """An armed rig with the jog switched on."""
    page = tab.page
    served.rest()
    expect(rig_state(page)).to_contain_text("disarmed")
    served.send("POST", "/simulation/faults", IN_THE_MIDDLE)
    eventually(lambda: is_seen_there(served.ask("/state")), "the robot is seen in the middle")
    switch = jog(page).get_by_role("button", name="Jog")
    if switch.get_attribute("aria-expanded") == "false":
        switch.click()
    arm(page, served)
    yield page
    assert tab.complaints == []
    assert tab.foreign(served.url) == []


def arm(page: Page, served: ServedRig) -> None:
    """Not by a click: a computer that is busy just then refuses it, or lets the rig hold."""

    def is_armed() -> bool:
        state = served.ask("/state")["rig"]
        if state in STEPS:
            with contextlib.suppress(urllib.error.HTTPError):
                served.send("POST", STEPS[state])
        return state == "armed"

    eventually(is_armed, "the rig is armed")
    expect(pad(page, "left", "A")).to_be_enabled()


def is_seen_there(state: dict[str, Any]) -> bool:
    """Where it has been put, and not any more where it was."""
    pose = state["pose"]
    return (
        state["tracking"] == "locked" and not state["faults"] and math.hypot(pose["x_mm"], pose["y_mm"]) < 2.0
    )


def jog(page: Page) -> Locator:
    return page.get_by_role("region", name="Jog")


def pad(page: Page, way: str, end: str) -> Locator:
    return jog(page).get_by_role("button", name=f"Turn {way} about {end}")


def rate(served: ServedRig) -> float:
    """Of the field, °/s; positive to the left."""
    return served.ask("/state")["command"]["rate_deg_s"]


def turns(page: Page, served: ServedRig, sign: int = 1) -> None:
    if not becomes_true(lambda: sign * rate(served) > 0, timeout=3.0):
        words = jog(page).get_by_role("status").inner_text()
        pytest.fail(f"the field does not turn: {words!r}, {rig_state(page).inner_text()!r}")


def stands(served: ServedRig) -> None:
    eventually(lambda: rate(served) == 0, "the field stands still", timeout=2.0)


def grip(place: Locator) -> None:
    """Press the mouse on it, and keep it down."""
    box = place.bounding_box()
    assert box is not None
    place.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    place.page.mouse.down()


def test_a_button_that_is_held_swings_the_robot_until_it_is_let_go(page: Page, served: ServedRig) -> None:
    grip(pad(page, "right", "B"))
    turns(page, served, -1)
    assert served.ask("/state")["command"]["pivot"] == -1
    expect(pad(page, "right", "B")).to_have_attribute("aria-pressed", "true")
    expect(jog(page).get_by_role("status")).to_contain_text("Turning right about B at 30 °/s")
    page.mouse.up()
    stands(served)
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))


def test_a_released_key_ends_the_jog(page: Page, served: ServedRig) -> None:
    page.keyboard.down("q")
    turns(page, served)
    page.keyboard.up("q")
    stands(served)


TAKEN_AWAY: dict[str, str] = {
    "the page loses the focus": "dispatchEvent(new Event('blur'))",
    "the page is hidden": "document.dispatchEvent(new Event('visibilitychange'))",
    "the page is left": "dispatchEvent(new Event('pagehide'))",
}


@pytest.mark.parametrize("how", TAKEN_AWAY)
def test_a_key_that_is_still_down_drives_no_more_once(page: Page, served: ServedRig, how: str) -> None:
    """The key goes on repeating, as it does on a keyboard, and starts nothing again."""
    page.keyboard.down("e")
    turns(page, served, -1)
    page.evaluate("Object.defineProperty(document, 'hidden', { value: true, configurable: true })")
    page.evaluate(TAKEN_AWAY[how])
    page.evaluate("delete document.hidden")
    stands(served)
    page.keyboard.down("e")
    page.wait_for_timeout(300)
    assert rate(served) == 0
    page.keyboard.up("e")


def test_a_finger_that_the_system_takes_away_has_let_go(page: Page, served: ServedRig) -> None:
    button = pad(page, "left", "A")
    button.evaluate("element => { element.setPointerCapture = () => {}; }")
    finger = {"pointerId": 7, "pointerType": "touch", "isPrimary": True, "bubbles": True, "button": 0}
    button.dispatch_event("pointerdown", finger)
    turns(page, served)
    button.dispatch_event("pointercancel", finger)
    stands(served)


def test_a_question_on_the_page_ends_the_jog(page: Page, served: ServedRig) -> None:
    page.keyboard.down("q")
    turns(page, served)
    page.keyboard.press("?")
    stands(served)
    expect(page.get_by_role("dialog", name="Keys")).to_contain_text("Hold: turn left about A")
    page.keyboard.up("q")
    page.get_by_role("dialog", name="Keys").get_by_role("button", name="Close").click()


def test_stop_ends_the_jog_and_the_key_that_is_down_does_not_go_on_after_arming(
    page: Page, served: ServedRig
) -> None:
    page.keyboard.down("a")
    turns(page, served)
    page.keyboard.press("Escape")
    expect(rig_state(page)).to_contain_text("fault")
    expect(jog(page).get_by_role("status")).to_contain_text("Reset the rig")
    page.get_by_role("button", name="Reset", exact=True).click()
    arm(page, served)
    page.keyboard.down("a")
    page.wait_for_timeout(300)
    assert rate(served) == 0
    page.keyboard.up("a")


def test_a_connection_that_breaks_lets_the_robot_stand(page: Page, tab: Visit, served: ServedRig) -> None:
    """Nothing of the page arrives any more: the rig stops by itself."""
    page.keyboard.down("q")
    turns(page, served)
    page.context.set_offline(True)
    stands(served)
    page.context.set_offline(False)
    page.keyboard.up("q")
    expect(page.get_by_role("alert").filter(has_text="No connection")).to_have_count(0)
    tab.complaints.clear()  # the browser notes what did not get through


def test_a_gamepad_drives_only_while_its_shoulder_button_is_held(page: Page, served: ServedRig) -> None:
    page.evaluate(GAMEPAD)
    expect(jog(page)).to_contain_text("Gamepad: Test pad.")
    page.evaluate("hands.tilt(0, -1)")
    page.wait_for_timeout(300)
    assert rate(served) == 0
    page.evaluate("hands.tilt(0, 0)")
    page.evaluate("hands.hold(true); hands.tilt(0, -1)")
    turns(page, served)
    page.evaluate("hands.hold(false)")
    stands(served)
    page.evaluate("hands.tilt(0, 0)")


ENDS: dict[str, Callable[[Page], object]] = {
    "pulled out": lambda page: page.evaluate("hands.pull()"),
    "let go": lambda page: page.evaluate("hands.tilt(2, 0)"),
}


@pytest.mark.parametrize("how", ENDS)
def test_a_gamepad_stops_the_robot_when_it_is(page: Page, served: ServedRig, how: str) -> None:
    page.evaluate(GAMEPAD)
    expect(jog(page)).to_contain_text("Gamepad: Test pad.")
    page.evaluate("hands.hold(true); hands.tilt(2, 0.8)")
    turns(page, served, -1)
    assert served.ask("/state")["command"]["pivot"] == -1
    ENDS[how](page)
    stands(served)


def test_a_rig_that_walks_is_not_jogged_and_says_why(page: Page, served: ServedRig) -> None:
    page.get_by_role("button", name="Start walking", exact=True).click()
    expect(jog(page).get_by_role("status")).to_have_text(
        re.compile("^(A run is on: stop it|The rig is on hold)")
    )
    expect(pad(page, "left", "A")).to_be_disabled()
    page.keyboard.press("q")
    assert served.ask("/state")["command"]["controller"] != "manual"
