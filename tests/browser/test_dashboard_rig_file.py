"""The tab of the rig: its values as a form, its file taken along and taken over, and an edit of it on the disk."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, rig_state
from playwright.sync_api import FilePayload, Locator, Page, expect

pytestmark = pytest.mark.exclusive

OTHER = b"""# from the other lab
name = "Bench 4"
[limits]
field_mT = 11.0
"""


@pytest.fixture(scope="module")
def visit(workshop: ServedRig, open_lasting_tab: OpenTab) -> Iterator[Visit]:
    visit = open_lasting_tab(f"{workshop.url}/?tab=rig", scene=False)
    yield visit
    assert visit.complaints == []
    assert visit.foreign(workshop.url) == []


@pytest.fixture
def page(visit: Visit, workshop: ServedRig) -> Page:
    """At rest, and with nothing left to be saved."""
    workshop.rest()
    expect(rig_state(visit.page)).to_contain_text("disarmed")
    return visit.page


def rig(page: Page) -> Locator:
    return page.get_by_role("region", name="Rig", exact=True)


def section(page: Page, name: str) -> None:
    button = rig(page).get_by_role("navigation", name="Settings").get_by_role("button")
    button.filter(has_text=re.compile(f"^{name}")).click()


def field(page: Page, name: str) -> Locator:
    return rig(page).get_by_role("textbox", name=name, exact=True)


def changes(page: Page) -> Locator:
    return rig(page).get_by_role("region", name="Changes")


def test_a_changed_value_says_from_what_to_what_is_saved_and_undone(page: Page, workshop: ServedRig) -> None:
    section(page, "Limits")
    expect(field(page, "Field")).to_have_value("15")
    field(page, "Field").fill("12,5")
    field(page, "Current y").fill("7")
    listed = changes(page).get_by_role("list", name="Not saved yet").get_by_role("listitem")
    expect(listed.filter(has_text="Limits · Field")).to_contain_text("15 mT → 12.5 mT")
    expect(listed.filter(has_text="Limits · Current")).to_contain_text("8, 8, 8 A → 8, 7, 8 A")
    changes(page).get_by_role("button", name="Save 2 changes").click()
    expect(changes(page)).to_contain_text("Saved: 2 values changed.")
    limits = workshop.ask("/rig")["limits"]
    assert (limits["field_mT"], limits["current_A"]) == (12.5, [8.0, 7.0, 8.0])
    changes(page).get_by_role("button", name="Undo", exact=True).click()
    expect(changes(page)).to_contain_text("Undone: 2 values put back.")
    expect(field(page, "Field")).to_have_value("15")
    assert workshop.ask("/rig")["limits"]["field_mT"] == 15.0


def test_what_cannot_be_says_so_beside_its_field_and_changes_nothing(page: Page, workshop: ServedRig) -> None:
    section(page, "Limits")
    field(page, "Field").fill("5000")
    save = changes(page).get_by_role("button", name="Save")
    expect(rig(page).get_by_text("5000 is out of range")).to_be_visible()
    field(page, "Field").fill("15")
    field(page, "Hard margin").fill("1")
    save.click()
    expect(changes(page)).to_contain_text("must not exceed hard_margin_mm")
    assert workshop.ask("/rig")["limits"]["hard_margin_mm"] == 8.0
    changes(page).get_by_role("button", name="Discard").click()
    expect(field(page, "Hard margin")).to_have_value("8")
    expect(changes(page)).to_have_count(0)


def test_an_armed_rig_keeps_its_values_until_it_is_disarmed_but_for_its_name(page: Page) -> None:
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))
    section(page, "Robot")
    field(page, "Length").fill("9.5")
    save = changes(page).get_by_role("button", name="Save the change")
    expect(save).to_be_disabled()
    expect(changes(page)).to_contain_text("This can be saved only while it is disarmed.")
    changes(page).get_by_role("button", name="Take back Robot · Length").click()
    section(page, "General")
    field(page, "Name").fill("Bench 7")
    save.click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Bench 7")
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))


def test_a_setting_is_found_by_its_words_in_all_sections(page: Page) -> None:
    search = rig(page).get_by_role("searchbox", name="Find a setting")
    search.fill("margin")
    expect(field(page, "Soft margin")).to_be_visible()
    search.fill("mT")
    expect(field(page, "Field")).to_be_visible()
    search.fill("no such thing")
    expect(rig(page).get_by_text("No setting has to do with")).to_be_visible()
    search.fill("")


def test_the_file_is_taken_along_and_another_one_is_looked_at_before_it_is_applied(
    page: Page, workshop: ServedRig
) -> None:
    section(page, "Rig file")
    with page.expect_download() as download:
        rig(page).get_by_role("link", name="Export the rig file").click()
    assert download.value.suggested_filename == "rig.toml"
    own = Path(download.value.path()).read_text()
    give = rig(page).get_by_label("Rig file to import")
    give.set_input_files(FilePayload(name="bad.toml", mimeType="text/plain", buffer=b"[limits]\nfield = 3\n"))
    bad = rig(page).get_by_role("region", name="Import of bad.toml")
    expect(bad.get_by_role("alert")).to_contain_text("limits.field")
    bad.get_by_role("button", name="Close").click()
    give.set_input_files(FilePayload(name="other.toml", mimeType="text/plain", buffer=OTHER))
    other = rig(page).get_by_role("region", name="Import of other.toml")
    expect(other.get_by_role("listitem").filter(has_text="Limits · Field")).to_contain_text("15 mT → 11 mT")
    assert workshop.ask("/rig")["limits"]["field_mT"] == 15.0
    other.get_by_role("button", name="Apply the file").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Bench 4")
    assert (workshop.data / "rig.toml").read_bytes() == OTHER
    changes(page).get_by_role("button", name="Undo", exact=True).click()
    expect(changes(page)).to_contain_text("Undone")
    assert (workshop.data / "rig.toml").read_text() == own


def test_the_rig_says_what_it_is_and_what_could_be_connected(page: Page, workshop: ServedRig) -> None:
    section(page, "About")
    expect(rig(page).get_by_role("region", name="Data folder")).to_contain_text(str(workshop.data))
    expect(rig(page).get_by_role("region", name="Board")).to_contain_text("sim://")
    section(page, "Connections")
    expect(rig(page).get_by_role("region", name="Cameras")).to_contain_text("simulated camera")
    expect(rig(page).get_by_role("region", name="Boards")).to_contain_text("In use: the simulated board.")


def test_an_edit_of_the_rig_file_is_offered_and_applied_with_one_click(
    page: Page, workshop: ServedRig
) -> None:
    (workshop.data / "rig.toml").write_text('name = "Bench 20"\n[camera]\nsize_px = [320, 240]\n')
    edited = page.get_by_role("alert").filter(has_text="was changed on disk")
    expect(edited).to_be_visible()
    edited.get_by_role("button", name="Apply", exact=True).click()
    expect(edited).to_have_count(0)
    expect(page.get_by_role("heading", level=1)).to_have_text("Bench 20")
    expect(rig_state(page)).to_contain_text("disarmed")
    page.get_by_role("button", name="Arm", exact=True).click()
    expect(rig_state(page)).to_contain_text(re.compile(r"\barmed"))
