import json

import pytest

pytestmark = pytest.mark.anyio

GAIT = {"sweep_deg": 30.0, "tilt_deg": 25.0, "field_mT": 10.0, "max_rate_deg_s": 100.0, "path_step_s": 0.1}


def selection(**changes):
    whole = {"controller": {"name": "geometric"}, "trajectory": {"name": "eight"}, "gait": GAIT}
    return {**whole, **changes}


async def refused(api, method, path, body, status=422):
    """Send raw text or a value; the answer's problem, after checking that nothing has changed."""
    before = (await api.get("/selection")).json()
    content = body if isinstance(body, str | bytes) else json.dumps(body)
    answer = await api.request(method, path, content=content, headers={"Content-Type": "application/json"})
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert (await api.get("/selection")).json() == before
    return answer.json()


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999", "-1e999", "9" * 400])
@pytest.mark.parametrize(
    "template",
    [
        '{"controller": {"name": "geometric", "parameters": {"gain": %s}}}',
        '{"trajectory": {"name": "eight", "parameters": {"width_mm": %s}}}',
        '{"gait": {"tilt_deg": %s}}',
        '{"passes": %s}',
        '{"label": %s}',
    ],
)
async def test_a_number_that_is_not_finite_is_refused_wherever_it_stands(api, template, number):
    problem = await refused(api, "POST", "/runs", template % number)
    assert problem["detail"]
    assert problem["errors"]


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"colour": "red"}, "colour"),
        ({"gait": {**GAIT, "speed": 1.0}}, "gait.speed"),
        ({"controller": {"name": "geometric", "gain": 3.0}}, "controller.gain"),
        ({"controller": {"name": "geometric", "parameters": {"gian": 3.0}}}, "controller.parameters.gian"),
        ({"controller": {"name": "geometric", "parameters": {"gain": -1.0}}}, "controller.parameters.gain"),
        ({"controller": {"name": "geometric", "parameters": {"gain": "3"}}}, "controller.parameters.gain"),
        ({"controller": {"name": "magic"}}, "controller.name"),
        ({"trajectory": {"name": "nine"}}, "trajectory.name"),
        ({"trajectory": {"name": "eight", "parameters": {"width_mm": 300.0}}}, "trajectory.parameters"),
        ({"gait": {**GAIT, "tilt_deg": 45.5}}, "gait.tilt_deg"),
        ({"gait": {**GAIT, "tilt_deg": -0.1}}, "gait.tilt_deg"),
        ({"gait": {**GAIT, "tilt_deg": "25"}}, "gait.tilt_deg"),
        ({"gait": {**GAIT, "tilt_deg": True}}, "gait.tilt_deg"),
        ({"gait": {**GAIT, "tilt_deg": None}}, "gait.tilt_deg"),
        ({"gait": {**GAIT, "sweep_deg": 351.0}}, "gait.sweep_deg"),
        ({"gait": {**GAIT, "field_mT": 0.0}}, "gait.field_mT"),
        ({"gait": {**GAIT, "field_mT": 15.0}}, "gait.field_mT"),
        ({"gait": {**GAIT, "path_step_s": 1.0}}, "gait.path_step_s"),
        ({"gait": None}, "gait"),
    ],
)
async def test_a_bad_selection_names_the_field_and_changes_nothing(api, changes, field):
    problem = await refused(api, "PUT", "/selection", selection(**changes))
    assert [error["field"] for error in problem["errors"]] == [field]
    assert problem["errors"][0]["message"]


async def test_a_problem_says_what_came_and_what_is_allowed(api):
    problem = await refused(api, "PUT", "/selection", selection(gait={**GAIT, "tilt_deg": 75.5}))
    error = problem["errors"][0]
    assert error["loc"] == ["gait", "tilt_deg"]
    assert "75.5" in error["message"]
    assert "45" in error["allowed"]


async def test_an_unknown_name_is_answered_with_the_known_ones(api):
    problem = await refused(api, "PUT", "/selection", selection(controller={"name": "magic"}))
    assert "geometric" in problem["errors"][0]["allowed"]


@pytest.mark.parametrize(
    "body",
    [
        "",
        "{",
        "[]",
        "null",
        "3",
        '"x"',
        b"\xff\xfe",
        '{"label": "\\ud800"}',
        '{"controller": {"name": "geometric", "parameters": {"gain": "\\udfff"}}}',
        "[" * 100_000,
        '{"a":' * 50_000,
    ],
)
async def test_a_body_that_is_no_json_object_is_refused(api, body):
    problem = await refused(api, "PUT", "/selection", body)
    assert "Traceback" not in json.dumps(problem)


@pytest.mark.parametrize("field", ["controller", "trajectory", "gait"])
async def test_a_selection_is_replaced_whole_or_not_at_all(api, field):
    body = selection()
    del body[field]
    problem = await refused(api, "PUT", "/selection", body)
    assert problem["errors"] == [{"loc": [field], "field": field, "message": "is missing"}]


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"name": ""}, 422),
        ({"name": "../etc"}, 422),
        ({"name": "x" * 61}, 422),
        ({"name": "eight"}, 409),
        ({"points_mm": [[0.0, 0.0]]}, 422),
        ({"points_mm": [[0.0, 0.0], [0.0, 0.0]]}, 422),
        ({"points_mm": [[0.0, 0.0], [61.0, 0.0]]}, 422),
        ({"points_mm": [[0.0, 0.0], [1.0]]}, 422),
        ({"points_mm": [[0.0, 0.0], [1.0, 2.0, 3.0]]}, 422),
        ({"points_mm": [[0.0, 0.0], ["1", 2.0]]}, 422),
        ({"points_mm": [[0.0, 0.0]] * 10_001}, 422),
        ({"speed_mm_s": 0.0}, 422),
        ({"speed_mm_s": 51.0}, 422),
        ({"closed": "yes"}, 422),
    ],
)
async def test_a_path_that_cannot_be_walked_is_not_saved(api, changes, status):
    body = {"name": "new", "points_mm": [[0.0, 0.0], [10.0, 0.0]], **changes}
    names = [entry["name"] for entry in (await api.get("/trajectories")).json()]
    await refused(api, "POST", "/trajectories", body, status)
    assert [entry["name"] for entry in (await api.get("/trajectories")).json()] == names


@pytest.mark.parametrize(
    "query", ["rate_Hz=0", "rate_Hz=31", "rate_Hz=nan", "rate_Hz=inf", "rate_Hz=x", "rate_Hz=-1"]
)
async def test_a_senseless_rate_of_telemetry_is_refused_before_the_socket_opens(at, query):
    from websockets.exceptions import InvalidStatus

    with pytest.raises(InvalidStatus) as refusal:
        await at.socket(f"/api/v1/telemetry?{query}")
    assert refusal.value.response.status_code == 422
    assert b"rate_Hz" in refusal.value.response.body


async def test_an_unknown_view_of_the_camera_is_refused(api):
    for path in ("/camera/snapshot.jpg?view=x-ray", "/camera/stream.mjpg?view=x-ray"):
        answer = await api.get(path)
        assert answer.status_code == 422
        assert answer.json()["errors"][0]["field"] == "view"


@pytest.mark.parametrize("query", ["cursor=nobody", "limit=0", "limit=501", "limit=x"])
async def test_a_page_of_runs_that_cannot_be_is_refused(api, query):
    answer = await api.get(f"/runs?{query}")
    assert answer.status_code in (404, 422)
    assert answer.headers["content-type"] == "application/problem+json"


async def test_a_missing_body_is_named_as_such(api):
    problem = await refused(api, "PUT", "/selection", "")
    assert problem["errors"] == [{"loc": ["body"], "field": "body", "message": "is missing"}]
