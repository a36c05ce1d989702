"""STOP, and the two deliberate acts that lead back."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from dashboard_visit import ServedRig, Visit, eventually, rig_state
from playwright.sync_api import expect

pytestmark = pytest.mark.exclusive

LAYOUT_FAULTS = (Path(__file__).parent / "layout_faults.js").read_text(encoding="utf-8")
WIDTHS = (360, 390, 700, 720, 899, 900, 999, 1000, 1024, 1149, 1150, 1279, 1280, 1440, 1599, 1600)
HEIGHTS = (450, 800)
"""Where the bar changes, on both sides, CSS px."""


def arm(visit: Visit) -> None:
    visit.page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(visit.page)).to_contain_text(re.compile(r"\barmed"))


@pytest.mark.parametrize("how", ["Escape", "Space", "click"])
def test_stop_leads_to_a_fault_that_only_reset_and_arm_leave(dashboard: Visit, how: str) -> None:
    page = dashboard.page
    arm(dashboard)
    if how == "click":
        page.get_by_role("button", name="STOP", exact=True).click()
    else:
        page.keyboard.press(how)
    expect(rig_state(page)).to_contain_text("fault")
    expect(rig_state(page)).to_contain_text("stop")
    expect(page.get_by_role("button", name="Arm", exact=True)).to_have_count(0)
    page.get_by_role("button", name="Reset", exact=True).click()
    expect(rig_state(page)).to_contain_text("disarmed")
    expect(page.get_by_role("button", name="Arm", exact=True)).to_be_enabled()


def test_a_key_stops_from_every_tab(dashboard: Visit) -> None:
    """The focus is on the tab, which the space bar would press anywhere else."""
    page = dashboard.page
    tabs = ["Runs", "Studies", "Calibration", "Rig", "Log", "Faults"]
    expect(page.get_by_role("tab")).to_have_count(len(tabs))
    for tab, key in zip(tabs, itertools.cycle(["Escape", "Space"]), strict=False):
        arm(dashboard)
        page.get_by_role("tab", name=tab).click()
        expect(page.get_by_role("tabpanel", name=tab)).to_be_visible()
        page.keyboard.press(key)
        expect(rig_state(page)).to_contain_text("fault")
        page.get_by_role("button", name="Reset", exact=True).click()
        expect(rig_state(page)).to_contain_text("disarmed")


def test_escape_stops_while_the_scene_has_the_focus(dashboard_with_scene: Visit) -> None:
    page = dashboard_with_scene.page
    arm(dashboard_with_scene)
    scene = page.get_by_title("3D scene of coils, field and robot")
    expect(page.get_by_text("Loading the 3D scene")).to_be_hidden()
    scene.click()
    page.keyboard.press("Escape")
    expect(rig_state(page)).to_contain_text("fault")


def test_space_types_inside_a_text_field_and_stops_outside(dashboard: Visit, served: ServedRig) -> None:
    page = dashboard.page
    sweep = page.get_by_role("textbox", name="Sweep")
    sweep.fill("25")
    sweep.press("Space")
    expect(sweep).to_have_value("25 ")
    assert served.ask("/state")["rig"] == "disarmed"
    page.get_by_role("button", name="Arm", exact=True).focus()
    page.keyboard.press("Space")
    eventually(lambda: served.ask("/state")["rig"] == "fault", "the space bar stops and presses nothing")


def test_the_question_mark_shows_the_keys_and_leaves_stop_in_reach(dashboard: Visit) -> None:
    page = dashboard.page
    expect(rig_state(page)).to_contain_text("disarmed")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("Escape")
    page.get_by_role("button", name="STOP", exact=True).click()
    expect(rig_state(page)).to_contain_text("fault")
    page.get_by_role("dialog").get_by_role("button", name="Close").click()
    expect(page.get_by_role("dialog")).to_be_hidden()


def test_stop_stays_in_the_window_whatever_else_the_bar_says(dashboard: Visit, served: ServedRig) -> None:
    """A robot that walks, is recorded, and has something put in its way: the bar has never more to say."""
    page = dashboard.page
    arm(dashboard)
    page.get_by_role("button", name="Start walking", exact=True).click()
    expect(rig_state(page)).to_contain_text("running")
    page.get_by_role("tab", name="Faults").click()
    page.get_by_role("button", name=re.compile("^Scatter debris")).click()
    expect(page.get_by_role("button", name=re.compile("^1 fault"))).to_be_visible()
    found: dict[str, list[str]] = {}
    for width, height in itertools.product(WIDTHS, HEIGHTS):
        page.set_viewport_size({"width": width, "height": height})
        found[f"{width}x{height}"] = page.evaluate(LAYOUT_FAULTS)
    served.send("DELETE", "/simulation/faults")
    assert {window: faults for window, faults in found.items() if faults} == {}
