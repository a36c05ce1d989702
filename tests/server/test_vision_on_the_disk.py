"""Colours and the rig file: what cannot be saved, and edits on the disk."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest
from rig_file_bench import PATIENCE
from vision_bench import BLUE, COMMENTED, RED, bench

from server.atomic_save import previous_of
from server.rig_file import RigStore, load_rig_file

pytestmark = pytest.mark.anyio


@pytest.fixture
async def here(serve, tmp_path: Path):
    path = tmp_path / "rig.toml"
    path.write_text(COMMENTED)
    async with bench(serve, RigStore(path)) as one:
        yield one


async def test_colours_that_cannot_be_saved_are_not_used_either(here):
    await here.ready()
    (previous_of(here.path) / "in the way").mkdir(parents=True)
    assert (await here.change(colour=BLUE)).status_code == 409
    assert (await here.get("/vision"))["colour"] == RED
    assert here.path.read_text() == COMMENTED
    await here.ready()


class Meanwhile(RigStore):
    """A rig file during whose saving something else happens."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.event: Callable[[], object] = lambda: None

    def commit(self, staged, plan) -> None:
        self.event()
        super().commit(staged, plan)


async def test_a_rig_armed_while_its_colours_could_not_be_saved_says_that_they_are_not_in_the_file(
    serve, tmp_path
):
    store = Meanwhile(tmp_path / "rig.toml")
    async with bench(serve, store) as one:
        (previous_of(one.path) / "in the way").mkdir(parents=True)
        await one.ready()
        loop = asyncio.get_running_loop()
        store.event = lambda: asyncio.run_coroutine_threadsafe(one.rig.arm(), loop).result(PATIENCE)
        wider = {**RED, "value": [50, 255]}
        refused = await one.change(colour=wider)
        assert refused.status_code == 409
        assert "values that are not in its file" in refused.json()["detail"]
        assert (await one.get("/vision"))["colour"] == wider == one.in_use()
        store.event = lambda: None
        await one.api.post("/disarm")
        previous_of(one.path).joinpath("in the way").rmdir()
        previous_of(one.path).rmdir()
        assert (await one.change(colour=wider)).status_code == 200
        assert load_rig_file(one.path) == one.rig.settings


async def test_an_edit_on_the_disk_while_a_change_is_made_is_not_overwritten(serve, tmp_path):
    edited = "# my own hand\n[vision]\nvalue = [70, 255]\n"
    store = Meanwhile(tmp_path / "rig.toml")
    async with bench(serve, store) as one:
        await one.ready()
        store.event = lambda: one.path.write_text(edited)
        refused = await one.change(colour=BLUE)
        assert refused.status_code == 409
        assert "reload it first" in refused.json()["detail"]
        assert one.path.read_text() == edited
        assert (await one.get("/vision"))["colour"] == RED == one.in_use()


async def test_an_edit_of_the_colours_on_the_disk_is_taken_without_a_new_machine(here):
    await here.ready()
    machine = here.rig.machine
    here.path.write_text(
        '[vision]\nvalue = [45, 255]\nprofile = "lamp"\n[vision.profiles.lamp]\nvalue = [33, 255]\n'
    )
    answer = await here.api.post("/rig/reload")
    assert answer.status_code == 200, answer.text
    assert answer.json()["rebuilt"] is False
    assert here.rig.machine is machine
    assert (await here.get("/vision"))["colour"]["value"] == [33, 255]
    await here.ready()


async def test_a_change_of_colours_together_with_another_value_builds_the_machine_anew(here):
    await here.ready()
    machine = here.rig.machine
    answer = await here.api.patch("/rig", json={"vision": {"value": [50, 255]}, "robot": {"lift_ratio": 3.0}})
    assert answer.json()["rebuilt"] is True
    assert here.rig.machine is not machine
    assert (await here.get("/vision"))["colour"]["value"] == [50, 255]
