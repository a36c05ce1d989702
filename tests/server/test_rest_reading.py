import math

import httpx
import pytest

from control.controllers import controllers

pytestmark = pytest.mark.anyio

STATE = {
    "rig", "reason", "faults", "simulated", "tick", "time_s", "captured_s", "pose", "pose_sigma",
    "measurement", "window_px", "tracking", "tracking_age_s", "command", "reference", "error_mm",
    "currents_A", "measured_currents_A", "field_mT", "saturated", "limited_by", "coil_heat", "refused",
    "body_tilt_deg", "run", "loop", "link", "recording", "operator",
    "camera", "tracking_reason", "rivals_px",
}  # fmt: skip


async def test_health_says_ok_and_which_version(api):
    answer = (await api.get("/health")).json()
    assert answer["status"] == "ok"
    assert answer["version"]


async def test_the_state_has_every_promised_field(api):
    state = (await api.get("/state")).json()
    assert set(state) == STATE
    assert state["simulated"] is True
    assert set(state["command"]) == {
        "controller", "pivot", "rate_deg_s", "heading_goal_deg", "tilt_deg", "field_mT",
    }  # fmt: skip
    assert set(state["loop"]) == {
        "rate_Hz", "period_p99_ms", "latency_p50_ms", "latency_p99_ms", "dropped_frames",
    }  # fmt: skip


async def test_the_rig_tells_its_values_in_lab_units(api):
    rig = (await api.get("/rig")).json()
    assert rig["simulated"] is True
    assert rig["robot"]["length_mm"] == 10.0


async def test_the_selection_starts_with_a_geometric_eight_and_all_parameters(api):
    selection = (await api.get("/selection")).json()
    assert selection["controller"] == {
        "name": "geometric",
        "parameters": controllers["geometric"].Parameters().model_dump(),
    }
    assert selection["trajectory"]["name"] == "eight"
    assert selection["trajectory"]["parameters"]["width_mm"] == 80.0
    assert selection["gait"]["sweep_deg"] == 30.0


@pytest.mark.parametrize("path", ["/controllers", "/trajectories"])
async def test_each_choice_comes_with_a_schema_that_makes_a_form(api, path):
    entries = (await api.get(path)).json()
    assert {"geometric", "eight"} & {entry["name"] for entry in entries}
    for entry in entries:
        assert entry["title"]
        assert entry["summary"]
        for field in entry["parameters"]["properties"].values():
            assert field["title"]
            assert "default" in field


async def test_the_gait_schema_gives_each_field_its_unit_and_range(api):
    fields = (await api.get("/gait")).json()["properties"]
    paper = ["sweep_deg", "tilt_deg", "field_mT", "max_rate_deg_s", "path_step_s"]
    assert list(fields) == [*paper, "time_law", "speed_mm_s", "acceleration_mm_s2", "wait_mm", "approach"]
    assert fields["time_law"]["enum"] == ["path_step", "constant_speed", "trapezoidal", "wait"]
    assert fields["approach"]["type"] == "boolean"
    for field in fields.values():
        assert field["title"]
        assert field["description"]
    for field in (field for field in fields.values() if field["type"] == "number"):
        assert field["unit"]
        assert "maximum" in field or "exclusiveMaximum" in field


async def test_a_preview_is_the_path_in_millimetres(api):
    answer = (
        await api.post("/trajectories/preview", json={"name": "circle", "parameters": {"radius_mm": 20.0}})
    ).json()
    assert answer["length_mm"] == pytest.approx(2 * math.pi * 20.0, rel=1e-3)
    assert answer["duration_s"] == pytest.approx(2 * math.pi * 20.0 / 3.0, rel=1e-3)
    assert all(math.hypot(x, y) == pytest.approx(20.0, abs=0.01) for x, y in answer["points_mm"])


async def test_a_preview_outside_the_workspace_says_where_and_what_is_allowed(api):
    answer = await api.post(
        "/trajectories/preview", json={"name": "circle", "parameters": {"radius_mm": 99.0}}
    )
    assert answer.status_code == 422
    assert "mm" in answer.json()["detail"]
    assert "60 mm" in answer.json()["errors"][0]["allowed"]


async def test_the_camera_gives_its_calibration(api):
    camera = (await api.get("/camera")).json()
    assert camera["size"] == [640, 480]
    assert len(camera["model"]["rotation"]) == 9
    assert len(camera["model"]["distortion"]) == 5
    assert camera["model"]["translation_mm"] == [0.0, 0.0, pytest.approx(350.0)]


async def test_the_page_the_files_and_the_documentation_come_from_here_and_are_never_stale(at):
    async with httpx.AsyncClient(base_url=at.url) as client:
        for path, kind in (
            ("/", "text/html"),
            ("/docs", "text/html"),
            ("/scene/", "text/html"),
            ("/static/vendor/swagger/swagger-ui-bundle.js", "javascript"),
        ):
            answer = await client.get(path)
            assert answer.status_code == 200
            assert kind in answer.headers["content-type"]
            assert answer.headers["cache-control"] == "no-cache"
            again = await client.get(path, headers={"If-None-Match": answer.headers["etag"]})
            assert again.status_code == 304 or path in ("/", "/docs")
        docs = (await client.get("/docs")).text
        assert "http://" not in docs
        assert "https://" not in docs


async def test_the_scene_without_its_slash_is_sent_to_it(at):
    async with httpx.AsyncClient(base_url=at.url, follow_redirects=True) as client:
        answer = await client.get("/scene")
    assert answer.status_code == 200
    assert answer.url.path == "/scene/"


async def test_the_openapi_document_names_every_call(at):
    async with httpx.AsyncClient(base_url=at.url) as client:
        paths = (await client.get("/openapi.json")).json()["paths"]
    for call in (
        "state",
        "selection",
        "controllers",
        "trajectories",
        "trajectories/preview",
        "arm",
        "estop",
        "runs",
    ):
        assert f"/api/v1/{call}" in paths


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nowhere", 404),
        ("GET", "/runs/nobody", 404),
        ("DELETE", "/state", 405),
        ("GET", "/estop", 405),
        ("GET", "/arm", 405),
        ("PUT", "/runs", 405),
    ],
)
async def test_what_is_not_there_is_answered_in_words(api, method, path, status):
    answer = await api.request(method, path)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert path in answer.json()["detail"] or "nobody" in answer.json()["detail"]


async def test_a_file_outside_the_page_is_not_served(at):
    async with httpx.AsyncClient(base_url=at.url) as client:
        for path in (
            "/static/../pyproject.toml",
            "/static/%2e%2e/pyproject.toml",
            "/static/..%2fpyproject.toml",
        ):
            assert (await client.get(path)).status_code == 404
