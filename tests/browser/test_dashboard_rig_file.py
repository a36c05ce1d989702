"""The rig file edited on the disk while somebody looks at the page."""

from __future__ import annotations

from pathlib import Path

import pytest
from dashboard_visit import OpenTab, ServedRig, rig_state
from playwright.sync_api import expect

pytestmark = pytest.mark.exclusive


def test_an_edit_of_the_rig_file_is_offered_and_applied_with_one_click(
    own_server: ServedRig, open_tab: OpenTab, tmp_path: Path
) -> None:
    visit = open_tab(own_server.url, scene=False)
    page = visit.page
    expect(page.get_by_role("heading", level=1)).to_have_text("The paper's rig")
    (tmp_path / "rig.toml").write_text('name = "Bench 20"\n[camera]\nsize_px = [320, 240]\n')
    edited = page.get_by_role("alert").filter(has_text="was changed on disk")
    expect(edited).to_be_visible()
    expect(page.get_by_role("heading", level=1)).to_have_text("The paper's rig")
    page.get_by_role("button", name="Apply", exact=True).click()
    expect(edited).to_have_count(0)
    expect(page.get_by_role("heading", level=1)).to_have_text("Bench 20")
    expect(rig_state(page)).to_contain_text("disarmed")
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text("armed")
    assert visit.complaints == []
