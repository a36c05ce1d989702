"""The figures for Prometheus: what they are called, what they count, and that they are right."""

import asyncio

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families
from rig_visit import act, arm, until, until_gone

pytestmark = pytest.mark.anyio

UNITS = ("seconds", "meters", "radians", "hertz", "amperes", "teslas", "volts", "bytes", "ratio", "celsius")
"""Base units of Prometheus; a name ends in one, or counts or tells a state."""
PLAIN = {
    "pivotrig_build_info", "pivotrig_rig_state", "pivotrig_rig_simulated", "pivotrig_rig_faults", "pivotrig_run_active",
    "pivotrig_clients", "pivotrig_tracking_state", "pivotrig_link_ready", "pivotrig_field_limited",
    "pivotrig_recorder_state", "pivotrig_recorder_waiting_ticks", "pivotrig_recorder_left_out_frames",
    "pivotrig_process_open_fds", "pivotrig_process_threads",
}  # fmt: skip


async def figures(at):
    await asyncio.sleep(0.6)  # an answer is kept for half a second
    async with httpx.AsyncClient(base_url=at.url) as client:
        answer = await client.get("/metrics")
    assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
    return {family.name: family for family in text_string_to_metric_families(answer.text)}


def value(families, name, **labels):
    [found] = [
        sample.value
        for sample in families[name].samples
        if sample.labels == labels and not sample.name.endswith("_created")
    ]
    return found


async def test_every_figure_is_named_after_its_unit_and_says_what_it_is(at):
    families = await figures(at)
    assert len(families) > 35
    for name, family in families.items():
        assert name.startswith("pivotrig_")
        assert family.documentation.endswith(".")
        assert family.type == "counter" or name in PLAIN or name.endswith(UNITS), name


async def test_a_walk_is_seen_in_the_figures(at, api):
    before = await figures(at)
    await until(api, tracking="locked")
    await arm(api)
    await act(api, "/runs", 201, unattended=True)
    await until_gone(api, 1.0)
    during = await figures(at)
    assert value(during, "pivotrig_rig_state", state="running") == 1.0
    assert value(during, "pivotrig_tracking_state", state="locked") == 1.0
    assert value(during, "pivotrig_run_active") == 1.0
    assert value(during, "pivotrig_link_ready") == 1.0
    assert 20.0 < value(during, "pivotrig_loop_rate_hertz") < 70.0
    assert 0.0 < sum(value(during, "pivotrig_field_teslas", axis=axis) ** 2 for axis in "xyz") ** 0.5 < 0.02
    assert value(during, "pivotrig_recorder_state", state="recording") == 1.0
    await act(api, "/disarm")
    after = await figures(at)
    assert value(after, "pivotrig_run_active") == 0.0
    ticks = [value(each, "pivotrig_loop_ticks") for each in (before, during, after)]
    assert ticks == sorted(set(ticks))
    entered = [value(each, "pivotrig_rig_state_entered", state="running") for each in (before, during, after)]
    assert entered[0] < entered[1] <= entered[2]
    for name in before:
        for sample in before[name].samples:
            if before[name].type == "counter":
                assert value(after, name, **sample.labels) >= sample.value, name


async def test_clients_requests_and_events_are_counted(at, api):
    before = await figures(at)
    async with at.socket("/api/v1/telemetry") as one, at.socket("/api/v1/telemetry") as two:
        await one.recv()
        await two.recv()
        await api.get("/nowhere")
        await act(api, "/estop")
        during = await figures(at)
    open_before = value(before, "pivotrig_clients", kind="telemetry")
    assert value(during, "pivotrig_clients", kind="telemetry") == open_before + 2
    assert value(during, "pivotrig_http_responses", status="4xx") > value(
        before, "pivotrig_http_responses", status="4xx"
    )
    codes = {sample.labels["code"] for sample in during["pivotrig_events"].samples}
    assert "estop" in codes
    await act(api, "/reset")
    assert value(await figures(at), "pivotrig_clients", kind="telemetry") == open_before


async def test_who_asks_often_gets_what_was_made_for_all(at):
    exposition = at.server.config.app.state.exposition
    assert exposition.text() is exposition.text()
