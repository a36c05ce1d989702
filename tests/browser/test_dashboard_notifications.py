"""Who is away is told: by the browser when its page is hidden, and through a webhook."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.error import HTTPError

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually, rig_state
from playwright.sync_api import Locator, Page, expect

from tests.listening_ear import Ear, listening

pytestmark = pytest.mark.exclusive

SHOWN = """
window.shown = [];
window.Notification = class {
  static permission = "default";
  static async requestPermission() { window.asked = true; return (Notification.permission = "granted"); }
  constructor(title, options) { window.shown.push(`${title}: ${options.body}`); }
  close() {}
};
window.away = false;
Document.prototype.hasFocus = () => !window.away;
"""
"""A browser's notifications, as the page sees them: none is put before whoever runs the tests."""


@pytest.fixture(scope="module")
def ear() -> Iterator[Ear]:
    with listening() as one:
        yield one


@pytest.fixture(scope="module")
def visit(workshop: ServedRig, open_lasting_tab: OpenTab) -> Iterator[Visit]:
    visit = open_lasting_tab(f"{workshop.url}/?tab=rig", scene=False)
    visit.page.add_init_script(SHOWN)
    visit.page.reload()
    expect(rig_state(visit.page)).to_contain_text("disarmed")
    rig(visit.page).get_by_role("button", name="Notifications", exact=True).click()
    yield visit
    assert visit.foreign(workshop.url) == []


@pytest.fixture
def page(visit: Visit, workshop: ServedRig) -> Page:
    workshop.rest()
    return visit.page


def rig(page: Page) -> Locator:
    return page.get_by_role("region", name="Rig", exact=True)


def test_nothing_is_asked_for_before_a_click_and_only_who_is_away_is_told(
    page: Page, workshop: ServedRig
) -> None:
    device = rig(page).get_by_role("region", name="On this device")
    expect(device.get_by_role("status")).to_have_text("Off for this browser")
    assert page.evaluate("window.asked") is None
    device.get_by_role("button", name="Turn notifications on").click()
    expect(device.get_by_role("status")).to_have_text("On for this browser")
    fault(workshop)
    expect(rig_state(page)).to_contain_text("fault")
    assert page.evaluate("window.shown") == []
    page.evaluate("window.away = true")
    mend(workshop)
    fault(workshop)
    eventually(lambda: page.evaluate("window.shown.length") > 0, "a notification")
    assert page.evaluate("window.shown[0]").startswith("Fault – The paper's rig: ")
    page.evaluate("window.away = false")
    mend(workshop)
    device.get_by_role("button", name="Turn notifications off").click()
    expect(device.get_by_role("status")).to_have_text("Off for this browser")


def fault(workshop: ServedRig) -> None:
    """A motor driver of the armed rig shuts itself off."""
    eventually(lambda: armed(workshop), "the rig is armed")
    workshop.send("POST", "/simulation/faults", {"name": "driver_fault"})


def armed(workshop: ServedRig) -> bool:
    try:
        workshop.send("POST", "/arm")
    except HTTPError:
        return False
    return True


def mend(workshop: ServedRig) -> None:
    workshop.send("DELETE", "/simulation/faults")
    workshop.rest()


def test_a_webhook_is_saved_tested_and_never_shown_whole_again(
    page: Page, workshop: ServedRig, ear: Ear
) -> None:
    webhook = rig(page).get_by_role("textbox", name="Webhook")
    test = rig(page).get_by_role("button", name="Send a test")
    expect(test).to_be_disabled()
    webhook.fill("ftp://elsewhere/")
    rig(page).get_by_role("button", name="Save the change").click()
    expect(rig(page).get_by_text("begins with http:// or https://").first).to_be_visible()
    webhook.fill(ear.url)
    rig(page).get_by_role("button", name="Save the change").click()
    expect(webhook).to_have_value(ear.url.split("/hooks")[0] + "/***")
    test.click()
    expect(rig(page).get_by_text("Delivered; the other side answered 204.")).to_be_visible()
    (told,) = ear.wait_for(1)
    assert (told["event"], told["rig"], told["url"]) == ("test", "The paper's rig", workshop.url)
    ear.answers = [403]
    test.click()
    expect(rig(page).get_by_text("the other side answered 403 Forbidden").first).to_be_visible()
