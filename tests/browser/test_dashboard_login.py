"""A rig that asks for a token, as a person meets it; and what pages of other sites get of any rig."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from axe import bring_axe, examined
from dashboard_visit import ServedRig, eventually, rig_state
from other_site import site_against
from playwright.sync_api import Browser, Page, expect

from server.access import tokens
from server.access.roles import Role

pytestmark = pytest.mark.exclusive

REFUSED = {
    "read": "TypeError",
    "act": "TypeError",
    "picture": "refused",
    "stream": "refused",
    "module": "refused",
    "telemetry": "refused",
    "camera": "refused",
    "scene": "refused",
    "stop": "TypeError",
    "beacon": True,
    "done": True,
}
"""What a page of another site gets. What it may send without asking (a plain request, a beacon, a form) is sent, and
refused: the rig shows that nothing came of it."""

ROOMS: dict[str, tuple[int, int]] = {"desk": (1440, 900), "phone": (390, 844)}


class Lab:
    def __init__(self, data: Path) -> None:
        self.tokens = {role: tokens.make(data / tokens.FILE, role) for role in Role}
        self.rig = ServedRig(data, "--sim", "--demand-token", token=self.tokens[Role.ADMIN])


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    lab = Lab(tmp_path_factory.mktemp("lab"))
    lab.rig.start()
    yield lab
    lab.rig.stop()


def log_in(page: Page, token: str) -> None:
    page.get_by_label("Token").fill(token)
    page.get_by_role("button", name="Log in").click()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", ROOMS)
def test_a_person_logs_in_and_comes_to_the_rig(browser: Browser, lab: Lab, size: str, scheme: str) -> None:
    width, height = ROOMS[size]
    context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=scheme)  # type: ignore[arg-type]
    page = context.new_page()
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(f"{lab.rig.url}/")
    expect(page).to_have_url(re.compile(r"/login\?next=/$"))
    bring_axe(page)
    assert examined(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    log_in(page, "wrong")
    expect(page.get_by_role("alert")).to_contain_text("no token of this rig")
    page.keyboard.type(lab.tokens[Role.OPERATOR])  # what was wrong is chosen, and typed over
    page.keyboard.press("Enter")
    expect(rig_state(page)).to_contain_text("disarmed")
    expect(page).to_have_url(re.compile(r"^http://[^/]+/(#.*)?$"))
    assert lab.tokens[Role.OPERATOR] not in page.url
    assert complaints == []
    context.close()


def test_a_viewer_watches_may_stop_and_is_told_why_nothing_else(browser: Browser, lab: Lab) -> None:
    context = browser.new_context(viewport={"width": 1440, "height": 900})
    context.add_init_script('localStorage.setItem("pivotrig.tour", "done")')
    page = context.new_page()
    page.goto(lab.rig.url)
    log_in(page, lab.tokens[Role.VIEWER])
    expect(rig_state(page)).to_contain_text("locked")
    expect(page.get_by_role("button", name="Arm", exact=True)).to_be_disabled()
    page.get_by_role("button", name="STOP").first.click()
    expect(rig_state(page)).to_contain_text("fault")
    lab.rig.send("POST", "/reset")
    expect(rig_state(page)).to_contain_text("disarmed")
    context.close()


def test_a_session_whose_token_was_replaced_leads_back_to_the_login(browser: Browser, lab: Lab) -> None:
    context = browser.new_context(viewport={"width": 1440, "height": 900})
    page = context.new_page()
    page.goto(lab.rig.url)
    log_in(page, lab.tokens[Role.VIEWER])
    expect(rig_state(page)).to_contain_text("disarmed")
    lab.tokens[Role.VIEWER] = tokens.make(lab.rig.data / tokens.FILE, Role.VIEWER)
    expect(page).to_have_url(re.compile(r"/login\?next="))
    expect(page.get_by_label("Token")).to_be_visible()
    context.close()


@pytest.mark.parametrize(
    "where", ["https://evil.example/", "//evil.example", "javascript:alert(1)", "/login?next=/login"]
)
def test_a_login_leads_nowhere_else(browser: Browser, lab: Lab, where: str) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.goto(f"{lab.rig.url}/login?next={where}")
    log_in(page, lab.tokens[Role.OPERATOR])
    expect(rig_state(page)).to_contain_text("disarmed")
    assert page.url.startswith(lab.rig.url)
    context.close()


def attacked(browser: Browser, rig: ServedRig, *, logged_in: str = "") -> None:
    """What a page of another site gets in a browser that knows the rig, and that nothing has come of it."""
    context = browser.new_context()
    if logged_in:
        page = context.new_page()
        page.goto(rig.url)
        log_in(page, logged_in)
        expect(rig_state(page)).to_contain_text("disarmed")
    with site_against(rig.url) as site:
        page = context.new_page()
        page.goto(site)
        eventually(lambda: page.evaluate("window.got?.done === true"), "all has been tried", 60.0)
        assert page.evaluate("window.got") == REFUSED
    context.close()
    assert rig.ask("/state")["rig"] == "disarmed"
    assert all(event["code"] != "estop" for event in rig.ask("/events")["events"])


def test_a_page_of_another_site_gets_nothing_of_a_rig_without_tokens(
    browser: Browser, own_server: ServedRig
) -> None:
    attacked(browser, own_server)


def test_a_page_of_another_site_gets_nothing_of_the_session_beside_it(
    browser: Browser, tmp_path: Path
) -> None:
    lab = Lab(tmp_path)
    lab.rig.start()
    try:
        attacked(browser, lab.rig, logged_in=lab.tokens[Role.ADMIN])
    finally:
        lab.rig.stop()
