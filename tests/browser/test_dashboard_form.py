"""The run panel's forms: made from the schemas, checked beside the field, taken over by the rig."""

from __future__ import annotations

import pytest
from dashboard_visit import ServedRig, Visit, eventually
from playwright.sync_api import expect

pytestmark = pytest.mark.exclusive


def test_a_value_out_of_range_is_refused_beside_its_field_and_stays_on_the_page(
    dashboard: Visit, served: ServedRig
) -> None:
    page = dashboard.page
    before = served.ask("/selection")["gait"]
    page.get_by_role("textbox", name="Sweep").fill("900")
    expect(page.get_by_text("900 is out of range; allowed: 1 to 350°")).to_be_visible()
    page.get_by_role("textbox", name="Tilt").fill("steep")
    expect(page.get_by_text("“steep” is not a number")).to_be_visible()
    assert served.ask("/selection")["gait"] == before


def test_an_edited_value_reaches_the_rig_and_the_defaults_bring_it_back(
    dashboard: Visit, served: ServedRig
) -> None:
    page = dashboard.page
    page.get_by_role("textbox", name="Sweep").fill("22.5")
    eventually(lambda: served.ask("/selection")["gait"]["sweep_deg"] == 22.5, "the rig has the new sweep")
    page.get_by_role("button", name="Gait: back to defaults").click()
    eventually(lambda: served.ask("/selection")["gait"]["sweep_deg"] == 30, "the default is back")


def test_another_trajectory_brings_its_own_form_and_picture(dashboard: Visit, served: ServedRig) -> None:
    page = dashboard.page
    panel = page.get_by_role("region", name="Run", exact=True)
    panel.get_by_role("combobox", name="Trajectory").select_option("circle")
    expect(page.get_by_role("textbox", name="Radius")).to_be_visible()
    expect(page.get_by_role("img", name="The path in the workspace")).to_be_visible()
    eventually(lambda: served.ask("/selection")["trajectory"]["name"] == "circle", "the rig has the circle")
    page.get_by_role("textbox", name="Radius").fill("90")
    expect(panel).to_contain_text("workspace")
    panel.get_by_role("combobox", name="Trajectory").select_option("eight")
    eventually(lambda: served.ask("/selection")["trajectory"]["name"] == "eight", "the eight is back")


def test_a_value_is_stepped_by_arrows_and_slider_takes_a_comma_and_goes_back_by_itself(
    dashboard: Visit, served: ServedRig
) -> None:
    page = dashboard.page
    sweep = page.get_by_role("textbox", name="Sweep")
    sweep.focus()
    expect(page.get_by_text("1 to 350° · default 30°")).to_be_visible()
    page.keyboard.press("ArrowUp")
    expect(sweep).to_have_value("31")
    page.keyboard.press("Shift+ArrowDown")
    expect(sweep).to_have_value("21")
    page.get_by_role("slider", name="Sweep, slider").fill("40")
    expect(sweep).to_have_value("40")
    sweep.fill("22,5")
    eventually(lambda: served.ask("/selection")["gait"]["sweep_deg"] == 22.5, "the comma is understood")
    page.get_by_role("button", name="Reset sweep to 30°").click()
    expect(sweep).to_have_value("30")
    eventually(lambda: served.ask("/selection")["gait"]["sweep_deg"] == 30, "the default is back")
    sweep.fill("900")
    page.get_by_role("button", name="Reset sweep to 30°").click()
    expect(sweep).to_have_value("30")
    expect(page.get_by_text("900 is out of range")).to_have_count(0)


def test_while_the_robot_walks_safe_values_apply_at_once_and_the_others_say_that_they_wait(
    dashboard: Visit, served: ServedRig
) -> None:
    page = dashboard.page
    panel = page.get_by_role("region", name="Run", exact=True)
    page.get_by_text("Label and tags", exact=True).click()
    page.get_by_role("textbox", name="Label", exact=True).fill("live values")
    page.get_by_role("textbox", name="Tags, with commas between").fill("wet, calibrated")
    page.get_by_role("button", name="Arm", exact=True).click()
    page.get_by_role("button", name="Start walking", exact=True).click()
    expect(panel.get_by_text("live values", exact=True)).to_be_visible()
    expect(panel.get_by_text("Gait and gains apply at once, the rest with the next run.")).to_be_visible()

    page.get_by_role("textbox", name="Tilt").fill("27")
    expect(panel.get_by_text("in this run")).to_be_visible()
    assert served.ask("/runs/current")["gait"]["tilt_deg"] == 27
    assert served.ask("/runs/current")["tags"] == ["wet", "calibrated"]

    page.get_by_role("combobox", name="Time law").select_option("constant speed")
    expect(panel.get_by_text("for the next run", exact=True)).to_be_visible()
    assert served.ask("/runs/current")["gait"]["time_law"] == "path_step"
    page.get_by_role("button", name="Apply to this run").click()
    expect(panel.get_by_text("for the next run", exact=True)).to_have_count(0)
    assert served.ask("/runs/current")["gait"]["time_law"] == "constant_speed"


def test_a_value_that_the_rig_does_not_allow_now_is_refused_beside_its_field(
    dashboard: Visit, served: ServedRig
) -> None:
    page = dashboard.page
    served.send("PATCH", "/rig", {"limits": {"rate_deg_s": 200.0}})
    try:
        page.get_by_role("button", name="Arm", exact=True).click()
        page.get_by_role("button", name="Start walking", exact=True).click()
        expect(page.get_by_text("Gait and gains apply at once")).to_be_visible()
        page.get_by_role("textbox", name="Fastest swing").fill("300")
        expect(page.get_by_text("the fastest swing of 300 degrees/s is beyond this rig's")).to_be_visible()
        expect(page.get_by_text("this run has 114.592 °/s")).to_be_visible()
        assert served.ask("/runs/current")["gait"]["max_rate_deg_s"] < 120
    finally:
        served.rest()
        served.send("PATCH", "/rig", {"limits": {"rate_deg_s": 360.0}})
