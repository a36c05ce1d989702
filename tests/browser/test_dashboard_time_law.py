"""Choices and switches of the gait: the page takes every kind of field from the schema."""

from __future__ import annotations

import pytest
from dashboard_visit import ServedRig, Visit, eventually
from playwright.sync_api import expect

pytestmark = pytest.mark.exclusive


def test_a_time_law_and_the_approach_are_chosen_on_the_page(dashboard: Visit, served: ServedRig) -> None:
    page = dashboard.page
    law = page.get_by_role("combobox", name="Time law")
    expect(law).to_have_value("path step")
    expect(page.get_by_text("2:05 min a pass")).to_be_visible()
    law.select_option("constant speed")
    page.get_by_role("textbox", name="Path speed").fill("5")
    page.get_by_role("checkbox", name="Approach").check()
    expected = {"time_law": "constant_speed", "speed_mm_s": 5, "approach": True}
    eventually(lambda: served.ask("/selection")["gait"].items() >= expected.items(), "the rig has the law")
    expect(page.get_by_text("1:15 min a pass")).to_be_visible()
    page.get_by_role("button", name="Gait: back to defaults").click()
    eventually(lambda: served.ask("/selection")["gait"]["time_law"] == "path_step", "the default is back")
