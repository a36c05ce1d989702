"""Help beside each parameter: plain words, the paper's symbol, a figure; for the keyboard as for the mouse."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, rig_state
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

WITHOUT_HELP = """async (catalogue) => {
  const main = document.querySelector('script[src*="main.js"]').src;
  const { helpFor } = await import(main.replace("main.js", "help/help.js"));
  return catalogue.filter(([of, name]) => {
    const help = helpFor(of, name);
    return !help || !help.Figure || help.words.length === 0;
  });
}"""


@pytest.fixture(scope="module")
def visit(served: ServedRig, open_lasting_tab: OpenTab) -> Iterator[Visit]:
    served.rest()
    visit = open_lasting_tab(served.url, scene=False)
    yield visit
    assert visit.complaints == []


def help_on(page: Page, title: str) -> Locator:
    return page.get_by_role("dialog", name=title, exact=True)


def test_every_parameter_of_gait_controllers_and_trajectories_has_words_and_a_figure(
    visit: Visit, served: ServedRig
) -> None:
    catalogue = [["gait", name] for name in served.ask("/gait")["properties"]]
    for part, path in (("controller", "/controllers"), ("trajectory", "/trajectories")):
        entries: list[Any] = list(served.ask(path))
        for entry in entries:
            names = entry["parameters"].get("properties", {})
            catalogue += [[f"{part}.{entry['name']}", name] for name in names]
    assert len(catalogue) > 60
    assert visit.page.evaluate(WITHOUT_HELP, catalogue) == []


def test_a_click_shows_symbol_words_and_figure_and_a_click_elsewhere_closes(visit: Visit) -> None:
    page = visit.page
    page.get_by_role("button", name="What is tilt?").click()
    tilt = help_on(page, "Tilt")
    expect(tilt).to_contain_text("α")
    expect(tilt).to_contain_text("24.5°")
    expect(tilt.get_by_role("img", name="The robot from the side")).to_be_visible()
    page.get_by_role("heading", name="Camera").click()
    expect(tilt).to_have_count(0)


def test_by_keyboard_the_focus_goes_in_and_comes_back_and_escape_is_stop_as_well(visit: Visit) -> None:
    page = visit.page
    opener = page.get_by_role("button", name="What is sweep?")
    opener.focus()
    page.keyboard.press("Enter")
    sweep = help_on(page, "Sweep")
    expect(sweep).to_be_focused()
    page.keyboard.press("Tab")
    expect(sweep.get_by_role("button", name="Close")).to_be_focused()
    page.keyboard.press("Enter")
    expect(sweep).to_have_count(0)
    expect(opener).to_be_focused()
    page.keyboard.press("Enter")
    expect(sweep).to_be_visible()
    page.keyboard.press("Escape")
    expect(sweep).to_have_count(0)
    expect(rig_state(page)).to_contain_text("fault")


def test_the_help_covers_neither_the_bar_nor_its_own_field(visit: Visit) -> None:
    page = visit.page
    for title in ("Gain k", "Fastest swing"):
        field = page.get_by_role("textbox", name=title)
        page.get_by_role("button", name=f"What is {title[0].lower()}{title[1:]}?").click()
        box, bar, own = (
            place.bounding_box() for place in (help_on(page, title), page.get_by_role("banner"), field)
        )
        assert box is not None
        assert bar is not None
        assert own is not None
        assert box["y"] >= bar["y"] + bar["height"]
        assert box["x"] + box["width"] <= own["x"] or box["y"] >= own["y"] + own["height"]
        help_on(page, title).get_by_role("button", name="Close").click()
