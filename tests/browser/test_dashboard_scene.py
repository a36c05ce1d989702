"""The 3D scene: what each viewer may choose of it, and that it comes back."""

from __future__ import annotations

from collections.abc import Callable
from urllib.parse import urlsplit

import numpy as np
import pytest
from dashboard_visit import OpenTab, ServedRig, Visit, becomes_true, eventually
from numpy.typing import NDArray
from picture import colours, pixels_in_view, share_like
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.exclusive

ORANGE = (0, 94, 213)
"""The x coils, BGR."""
SLOW = 40.0
"""A scene is drawn within this on two cores without a graphics card, s."""


def scene(page: Page) -> Locator:
    return page.get_by_role("region", name="Scene")


def picture(page: Page) -> Locator:
    return page.get_by_title("3D scene of coils, field and robot")


def look(page: Page) -> NDArray[np.uint8]:
    return pixels_in_view(picture(page))


def layer(page: Page, name: str) -> Locator:
    return (
        scene(page)
        .get_by_role("group", name="Shown in the scene")
        .get_by_role("checkbox", name=name, exact=True)
    )


def view(page: Page, name: str) -> Locator:
    return scene(page).get_by_role("group", name="Look from").get_by_role("button", name=name, exact=True)


def coils_are_seen(page: Page) -> bool:
    return share_like(look(page), ORANGE, within=40) > 1e-3


def is_drawn(page: Page) -> bool:
    return colours(look(page)) > 24


def soon(holds: Callable[[], bool], what: str) -> None:
    eventually(holds, what, SLOW)


def frames_loaded(visit: Visit) -> list[str]:
    pages = [urlsplit(seen) for seen in visit.requests]
    return [page.path for page in pages if page.scheme == "http" and page.path.startswith("/scene/")]


@pytest.fixture(scope="module")
def visit(served: ServedRig, open_lasting_tab: OpenTab) -> Visit:
    """One tab for all tests that look at the same scene."""
    served.rest()
    visit = open_lasting_tab(served.url)
    visit.page.set_default_timeout(SLOW * 1e3)
    if not becomes_true(lambda: is_drawn(visit.page), SLOW):
        visit.page.reload()
        soon(lambda: is_drawn(visit.page), "a drawn scene, after one reload")
    return visit


def test_hidden_coils_are_gone_from_the_picture_and_come_back_without_a_new_page(visit: Visit) -> None:
    page, before = visit.page, len(frames_loaded(visit))
    soon(lambda: coils_are_seen(page), "coils in the scene")
    layer(page, "Coils").uncheck()
    soon(lambda: not coils_are_seen(page), "no coils in the scene")
    layer(page, "Coils").check()
    soon(lambda: coils_are_seen(page), "coils in the scene again")
    assert len(frames_loaded(visit)) == before


def test_the_fields_colours_are_explained_in_millitesla_while_it_is_shown(visit: Visit) -> None:
    legend = scene(visit.page).get_by_role("img", name="Colours of the field: dark is 0 mT, bright is 12 mT")
    expect(legend).to_be_visible()
    expect(legend).to_have_text("0612mT")
    layer(visit.page, "Field").uncheck()
    expect(legend).to_have_count(0)
    layer(visit.page, "Field").check()
    expect(legend).to_be_visible()


def test_a_named_view_shows_something_else_and_following_is_marked(visit: Visit) -> None:
    page = visit.page
    first = look(page)
    view(page, "Follow").click()
    expect(view(page, "Follow")).to_have_attribute("aria-pressed", "true")
    soon(lambda: bool((abs(look(page).astype(int) - first) > 30).mean() > 0.2), "another picture")
    view(page, "Overview").click()
    expect(view(page, "Follow")).to_have_attribute("aria-pressed", "false")


def test_the_scene_turns_dark_with_the_page_and_is_not_loaded_anew(visit: Visit) -> None:
    page, before = visit.page, len(frames_loaded(visit))
    ground = look(page)[2, 2].astype(int)
    page.emulate_media(color_scheme="dark")
    soon(lambda: look(page)[2, 2].astype(int).sum() < 0.4 * ground.sum(), "a dark ground")
    page.emulate_media(color_scheme="light")
    soon(lambda: look(page)[2, 2].astype(int).sum() > 0.9 * ground.sum(), "a light ground")
    assert len(frames_loaded(visit)) == before


def test_an_enlarged_scene_leaves_stop_in_reach(visit: Visit) -> None:
    page = visit.page
    scene(page).get_by_role("button", name="Enlarge the scene").click()
    box = scene(page).bounding_box()
    assert box is not None
    assert box["width"] > 1350
    expect(page.get_by_role("region", name="Camera")).to_be_hidden()
    expect(page.get_by_role("button", name="STOP")).to_be_in_viewport()
    scene(page).get_by_role("button", name="Back to the whole page").click()
    expect(page.get_by_role("region", name="Camera")).to_be_visible()


def test_what_is_hidden_stays_hidden_after_a_reload(dashboard: Visit) -> None:
    page = dashboard.page
    layer(page, "Trail").uncheck()
    page.reload()
    expect(layer(page, "Trail")).not_to_be_checked()
    expect(layer(page, "Field")).to_be_checked()


def test_a_browser_without_webgl_is_told_so(served: ServedRig, open_tab: OpenTab) -> None:
    page = open_tab("about:blank").page
    page.add_init_script(
        "HTMLCanvasElement.prototype.getContext = ((get) => function (kind, ...more) { "
        "return kind.startsWith('webgl') ? null : get.call(this, kind, ...more) })"
        "(HTMLCanvasElement.prototype.getContext)"
    )
    page.goto(served.url)
    expect(scene(page).get_by_text("WebGL 2 is missing")).to_be_visible()
    expect(picture(page)).to_have_count(0)


def test_after_a_restart_of_the_server_the_scene_comes_back_by_itself(
    own_server: ServedRig, open_tab: OpenTab
) -> None:
    page = open_tab(own_server.url).page
    expect(view(page, "Above")).to_be_enabled(timeout=SLOW * 1e3)
    own_server.kill()
    expect(view(page, "Above")).to_be_disabled(timeout=SLOW * 1e3)
    own_server.start()
    expect(view(page, "Above")).to_be_enabled(timeout=SLOW * 1e3)
    soon(lambda: is_drawn(page), "a drawn scene")
