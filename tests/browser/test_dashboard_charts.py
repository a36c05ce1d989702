"""The charts: pause and zoom while data keeps flowing, one cursor, curves and charts that come and go."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, eventually, rig_state
from picture import pixels
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

PHONE = (390, 844)
ALL = ("Error", "Pose", "Currents", "Latency")


@pytest.fixture(scope="module")
def walking(served: ServedRig, open_lasting_tab: OpenTab) -> Iterator[Visit]:
    """A robot that walks, and a page that shows it."""
    served.rest()
    visit = open_lasting_tab(served.url, scene=False)
    expect(rig_state(visit.page)).to_contain_text("disarmed")
    visit.page.get_by_role("button", name="Arm", exact=True).click()
    visit.page.get_by_role("button", name="Start walking", exact=True).click()
    expect(rig_state(visit.page)).to_contain_text("running")
    yield visit
    served.rest()
    assert visit.complaints == []


@pytest.fixture
def page(walking: Visit) -> Page:
    """Live, with a minute of everything."""
    page = walking.page
    page.mouse.move(0, 0)
    page.get_by_text("1 min", exact=True).click()
    expect(tools(page).get_by_role("button", name="Pause", exact=True)).to_be_visible()
    return page


def tools(page: Page) -> Locator:
    return page.get_by_role("toolbar", name="Charts")


def chart(page: Page, title: str) -> Locator:
    return page.get_by_role("img", name=re.compile(f"^{title} (over the last|of the part|up to)"))


def drag_across(page: Page, place: Locator) -> None:
    """From 60 to 80 % of its width."""
    place.scroll_into_view_if_needed()
    box = place.bounding_box()
    assert box is not None
    y = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.6 * box["width"], y)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.8 * box["width"], y, steps=4)
    page.mouse.up()


def seconds_behind(page: Page) -> int:
    words = tools(page).get_by_role("note").inner_text()
    found = re.search(r"(\d+) s behind", words)
    assert found is not None, words
    return int(found[1])


def test_a_paused_chart_stands_still_while_new_data_come_and_p_goes_on_with_them(page: Page) -> None:
    tools(page).get_by_role("button", name="Pause", exact=True).click()
    expect(chart(page, "Pose")).to_have_accessible_name("Pose up to when they were paused")
    page.mouse.move(0, 0)
    before = pixels(chart(page, "Pose"))
    eventually(lambda: seconds_behind(page) >= 2, "two seconds behind")
    assert (pixels(chart(page, "Pose")) == before).all()
    page.keyboard.press("p")
    expect(tools(page).get_by_role("note")).to_be_hidden()
    eventually(lambda: bool((pixels(chart(page, "Pose")) != before).any()), "the chart moves")


def test_a_drag_looks_closer_in_all_charts_and_a_double_click_leaves(page: Page) -> None:
    drag_across(page, chart(page, "Pose"))
    for title in ALL:
        expect(chart(page, title)).to_have_accessible_name(f"{title} of the part that is looked at")
    expect(tools(page).get_by_role("button", name="Leave zoom")).to_be_visible()
    eventually(lambda: seconds_behind(page) >= 12, "as far behind as the part ends before now")
    chart(page, "Pose").dblclick()
    expect(chart(page, "Error")).to_have_accessible_name("Error over the last 60 seconds")


def test_the_keys_of_a_focused_chart_point_and_look_closer(page: Page) -> None:
    place = chart(page, "Currents")
    place.focus()
    page.keyboard.press("ArrowLeft")
    expect(tools(page).get_by_text(" s ago")).to_be_visible()
    page.keyboard.press("+")
    expect(place).to_have_accessible_name("Currents of the part that is looked at")
    page.keyboard.press("0")
    expect(place).to_have_accessible_name("Currents over the last 60 seconds")


def test_what_happened_is_said_where_one_points(page: Page) -> None:
    page.get_by_text("10 min", exact=True).click()
    tools(page).get_by_role("button", name="Pause", exact=True).click()
    place = chart(page, "Error")
    place.focus()

    def said() -> bool:
        page.keyboard.press("ArrowRight")
        return tools(page).get_by_text("run began").is_visible()

    eventually(said, "the begin of the run, at its time")


def test_a_curve_is_hidden_and_shown_by_its_name_in_the_legend(page: Page) -> None:
    currents = page.get_by_role("region", name="Currents")
    name = currents.get_by_role("button", name="x", exact=True)
    expect(name).to_have_attribute("aria-pressed", "true")
    name.focus()
    page.keyboard.press("Enter")
    expect(name).to_have_attribute("aria-pressed", "false")
    name.click()
    expect(name).to_have_attribute("aria-pressed", "true")


def test_a_chart_is_put_away_and_fetched_back(page: Page) -> None:
    chip = tools(page).get_by_role("button", name="Latency")
    chip.click()
    expect(chart(page, "Latency")).to_be_hidden()
    chip.click()
    expect(chart(page, "Latency")).to_be_visible()


def test_what_is_shown_is_downloaded_as_a_table(page: Page, tmp_path: Path) -> None:
    tools(page).get_by_role("button", name="Pause", exact=True).click()
    with page.expect_download() as download:
        tools(page).get_by_role("button", name="Download").click()
    download.value.save_as(tmp_path / "charts.csv")
    head, *rows = (tmp_path / "charts.csv").read_text().splitlines()
    names = head.split(",")
    assert names[:3] == ["time_s", "error_mm", "x_mm"]
    assert "current_x_A" in names
    times = [float(row.split(",")[0]) for row in rows]
    assert times == sorted(times)
    assert 1.0 < times[-1] - times[0] <= 60.0


def test_a_phone_shows_one_chart_and_reaches_them_all(served: ServedRig, open_tab: OpenTab) -> None:
    page = open_tab(served.url, *PHONE, scene=False).page
    expect(chart(page, "Error")).to_be_visible()
    for title in ALL[1:]:
        expect(chart(page, title)).to_be_hidden()
        tools(page).get_by_role("button", name=title, exact=True).click()
        expect(chart(page, title)).to_be_visible()


def test_a_part_of_the_page_that_does_not_come_says_so_and_is_asked_for_again(
    served: ServedRig, open_tab: OpenTab
) -> None:
    page = open_tab(served.url, scene=False).page
    module = re.compile(r"/static/[0-9a-f]+/studies/studies\.js$")
    page.route(module, lambda route: route.abort())
    page.get_by_role("tab", name="Studies").click()
    alert = page.get_by_role("alert").filter(has_text="The server did not send the studies.")
    expect(alert).to_be_visible()
    page.unroute(module)
    alert.get_by_role("button", name="Try again").click()
    expect(page.get_by_role("button", name="New study").first).to_be_visible()
