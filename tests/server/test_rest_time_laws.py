"""Time laws and smooth paths over REST."""

import httpx
import pytest

pytestmark = pytest.mark.anyio


async def gait_of(api: httpx.AsyncClient) -> dict[str, object]:
    return (await api.get("/selection")).json()["gait"]


async def put_gait(api: httpx.AsyncClient, **changes: object) -> httpx.Response:
    whole = (await api.get("/selection")).json()
    return await api.put("/selection", json={**whole, "gait": {**whole["gait"], **changes}})


async def test_a_time_law_comes_back_as_it_was_chosen(api):
    chosen = {
        "time_law": "wait",
        "speed_mm_s": 4.2,
        "acceleration_mm_s2": 1.5,
        "wait_mm": 3.0,
        "approach": True,
    }
    before = await gait_of(api)
    assert (await put_gait(api, **chosen)).status_code == 200
    assert (await gait_of(api)).items() >= chosen.items()
    assert (await put_gait(api, **before)).status_code == 200


@pytest.mark.parametrize(
    ("field", "value", "allowed"),
    [
        ("time_law", "fast", "'path_step', 'constant_speed', 'trapezoidal' or 'wait'"),
        ("time_law", None, "'wait'"),
        ("speed_mm_s", 0.0, "at least 0.001"),
        ("speed_mm_s", 50.1, "at most 50"),
        ("acceleration_mm_s2", -1.0, "at least 0.001"),
        ("wait_mm", 0.0, "at least 0.5"),
        ("approach", 1, ""),
    ],
)
async def test_a_time_law_that_cannot_be_is_refused_beside_its_field(api, field, value, allowed):
    before = await gait_of(api)
    answer = await put_gait(api, **{field: value})
    assert answer.status_code == 422
    (error,) = answer.json()["errors"]
    assert error["field"] == f"gait.{field}"
    assert allowed in error.get("allowed", "")
    assert await gait_of(api) == before


async def test_a_smooth_path_can_be_saved_and_is_longer_than_its_chords(api):
    points = [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0]]
    lengths = []
    for kind in ("polyline", "spline"):
        body = {"name": f"bow as {kind}", "points_mm": points, "closed": False, "kind": kind}
        answer = await api.post("/trajectories", json=body)
        assert answer.status_code == 201
        assert answer.json()["kind"] == kind
        preview = await api.post("/trajectories/preview", json={"name": body["name"], "parameters": {}})
        lengths.append(preview.json()["length_mm"])
    assert lengths[0] == pytest.approx(40.0, rel=1e-3)
    assert 41.0 < lengths[1] < 50.0


async def test_a_smooth_path_that_swings_out_of_the_workspace_is_refused(api):
    body = {"name": "too wide", "points_mm": [[-59, -59], [-59, 59], [59, 59], [59, -59]], "kind": "spline"}
    answer = await api.post("/trajectories", json=body)
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "points_mm"
    assert (await api.post("/trajectories", json={**body, "kind": "polyline"})).status_code == 201
