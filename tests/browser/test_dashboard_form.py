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
