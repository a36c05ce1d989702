"""The page's own policy, as the browser keeps it: nothing foreign runs, shows or is asked for."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually, rig_state
from playwright.sync_api import expect

pytestmark = pytest.mark.exclusive

INTRUSIONS = {
    "a script in the page": (
        "const script = document.createElement('script');"
        "script.append('window.intruder = true'); document.body.append(script)",
        "script-src-elem require-trusted-types-for",
    ),
    "a script in an attribute": (
        "const image = document.createElement('img'); image.setAttribute('onerror', 'window.intruder = true');"
        "image.src = '/nothing.png'; document.body.append(image)",
        "script-src-attr require-trusted-types-for",
    ),
    "a picture from elsewhere": (
        "const image = document.createElement('img');"
        "image.src = 'http://elsewhere.example/look.png'; document.body.append(image)",
        "img-src",
    ),
    "a message to elsewhere": ("fetch('http://elsewhere.example/tell').catch(() => {})", "connect-src"),
    "a style in an attribute": (
        "const place = document.createElement('p'); place.setAttribute('style', 'color: red');"
        "document.body.append(place)",
        "style-src-attr",
    ),
    "a frame from elsewhere": (
        "const frame = document.createElement('iframe');"
        "frame.src = 'http://elsewhere.example/'; document.body.append(frame)",
        "frame-src",
    ),
    "text that becomes markup": (
        "document.createElement('p').innerHTML = '<b>bold</b>'",
        "require-trusted-types-for",
    ),
}
"""What a page that has been talked into something might try, and which rules refuse it."""


@pytest.fixture(scope="module")
def tab(served: ServedRig, open_lasting_tab: OpenTab) -> Visit:
    return open_lasting_tab(served.url, scene=False)


@pytest.fixture
def visit(tab: Visit) -> Iterator[Visit]:
    """Afterwards what was tried is forgotten, and the page is as it was."""
    expect(rig_state(tab.page)).not_to_contain_text("connecting")
    yield tab
    assert tab.page.evaluate("window.intruder") is None
    assert tab.elsewhere() == []
    tab.refused.clear()


@pytest.mark.parametrize("what", INTRUSIONS)
def test_the_page_refuses(visit: Visit, what: str) -> None:
    attempt, rules = INTRUSIONS[what]
    assert visit.refused == []
    visit.page.evaluate(f"() => {{ try {{ {attempt} }} catch {{}} }}")

    def is_refused() -> bool:
        visit.page.evaluate("0")  # what the page has told is heard while one talks with it
        return any(refusal.split(":")[0] in rules.split() for refusal in visit.refused)

    eventually(is_refused, f"{what} is refused")


def test_no_other_page_can_frame_this_one_and_no_form_leaves_it(served: ServedRig, tab: Visit) -> None:
    headers = tab.page.request.get(served.url).headers
    assert "frame-ancestors 'none'" in headers["content-security-policy"]
    assert "form-action 'none'" in headers["content-security-policy"]
    assert headers["cross-origin-opener-policy"] == "same-origin"


def test_the_description_of_the_interface_keeps_to_a_policy_of_its_own(
    served: ServedRig, open_tab: OpenTab
) -> None:
    visit = open_tab(f"{served.url}/docs")
    expect(visit.page.get_by_role("heading", name="pivotrig").first).to_be_visible()
    assert visit.complaints == []
