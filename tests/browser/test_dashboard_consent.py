"""Before current flows through real coils the page asks, calmly; a simulated rig does not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from axe import bring_axe, examined
from dashboard_visit import OpenTab, ServedRig, Visit, rig_state
from playwright.sync_api import expect

from tests.real_rig import real_rig

pytestmark = pytest.mark.exclusive


@pytest.fixture
def visit(tmp_path: Path, open_tab: OpenTab) -> Iterator[Visit]:
    """A page of a rig that is not simulated."""
    with real_rig(tmp_path) as rig_file:
        rig = ServedRig(tmp_path / "data", "--rig", str(rig_file))
        rig.start()
        yield open_tab(rig.url, scene=False)
        rig.stop()


def test_a_real_rig_is_armed_only_after_the_question(visit: Visit) -> None:
    page = visit.page
    arm = page.get_by_role("button", name="Arm", exact=True)
    question = page.get_by_role("dialog", name="Arm Bench 3?")
    expect(page.get_by_text("SIM", exact=True)).to_have_count(0)

    arm.click()
    expect(question).to_contain_text("This rig is real: arming puts current into its coils.")
    expect(question.get_by_role("button", name="Not now")).to_be_focused()
    bring_axe(page)
    assert examined(page) == []
    question.get_by_role("button", name="Not now").click()
    expect(question).to_be_hidden()
    expect(page.get_by_role("alert")).to_have_count(0)

    arm.click()
    page.keyboard.press("Escape")
    expect(question).to_be_hidden()
    expect(rig_state(page)).to_contain_text("fault")
    page.get_by_role("button", name="Reset", exact=True).click()

    arm.click()
    question.get_by_role("button", name="Arm with current").click()
    expect(question).to_be_hidden()
    expect(page.get_by_role("alert").filter(has_text=re.compile("no frame|not seen")).first).to_be_visible()
    expect(rig_state(page)).to_contain_text("disarmed")
