"""Studies through REST: counted before they begin, computed beside the live rig, stopped, resumed, taken away."""

import asyncio
import csv
import io
import json
import zipfile

import httpx
import pytest

from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.settings import RigFile
from server.studies.store import StudyStore

pytestmark = pytest.mark.anyio

DONE_WITHIN = 60.0
"""Of a busy computer, s; it takes about 5."""
SHORT = {
    "name": "sweeps on a small circle",
    "repeats": 2,
    "trajectory": {"name": "circle", "parameters": {"radius_mm": 5.0}},
    "duration_s": 4.0,
    "gait": {"time_law": "wait"},
    "plant": {"name": "noslip"},
    "axes": [{"of": "gait.sweep_deg", "values": [10, 20, 30]}],
}
"""By a time law that is not compiled: nobody waits for a compiler."""
LONG = {**SHORT, "name": "long", "repeats": 50_000, "duration_s": 20.0}


async def made(api, **body):
    answer = await api.post("/studies", json=body)
    assert answer.status_code == 201, answer.text
    return answer.json()


async def test_a_study_is_counted_before_it_begins(api):
    answer = (await api.post("/studies/preview", json={"definition": SHORT})).json()
    assert (answer["sets"], answer["runs"], answer["problems"]) == (3, 6, [])
    assert answer["rig_seconds"] == pytest.approx(6 * 4.0)
    assert answer["seconds"] > 0.0
    assert answer["axes"] == [
        {"name": "gait.sweep_deg", "title": "Sweep", "unit": "°", "values": [10, 20, 30]}
    ]
    again = (await api.post("/studies/preview", json={"toml": answer["toml"]})).json()
    assert again == answer
    assert (await api.get("/studies")).json() == {"studies": []}


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"repeats": 0}, "repeats", "greater than or equal to 1"),
        ({"repeats": "three"}, "repeats", "integer"),
        ({"axes": [{"of": "gait.tilt_deg", "values": [200]}]}, "", "tilt_deg"),
        ({"axes": [{"of": "legs", "values": [2]}]}, "axes.0.of", "nothing is called"),
        ({"axes": [{"of": "gait.tilt_deg", "from": 10, "to": 20}]}, "", "needs a step"),
        ({"trajectory": {"name": "circle", "parameters": {"radius_mm": 90.0}}}, "", "workspace"),
        ({"controller": {"name": "nobody"}}, "", "nobody"),
        ({"colour": "blue"}, "colour", "not a known field"),
    ],
)
async def test_what_is_wrong_with_a_study_is_said_beside_its_field_and_nothing_is_made(
    api, change, field, words
):
    definition = {**SHORT, **change}
    told = (await api.post("/studies/preview", json={"definition": definition})).json()["problems"]
    assert any(problem["field"] == field and words in problem["message"] for problem in told), told
    refused = await api.post("/studies", json={"definition": definition})
    assert refused.status_code == 422
    assert refused.headers["content-type"] == "application/problem+json"
    assert words in refused.json()["detail"]
    assert (await api.get("/studies")).json() == {"studies": []}


async def test_a_text_that_is_no_toml_and_a_body_that_says_both_are_refused_in_words(api):
    told = (await api.post("/studies/preview", json={"toml": "name = "})).json()["problems"]
    assert "no TOML" in told[0]["message"]
    both = await api.post("/studies/preview", json={"toml": "", "definition": {}})
    assert both.status_code == 422


@pytest.mark.parametrize(
    "toml",
    [
        "seed = 1979-05-27",
        f"seed = {'9' * 5000}",
        f"seed = {'[' * 5000}{']' * 5000}",
        f"{'.'.join('a' * 50_000)} = 1",
        f"""{'."b c"'.join("a" * 5_000)} = 1""",
    ],
    ids=["a date", "an endless number", "endless nesting", "an endless key", "an endless quoted key"],
)
async def test_a_hostile_toml_is_refused_in_words_and_at_once(api, toml):
    told = (await api.post("/studies/preview", json={"toml": toml})).json()["problems"]
    assert told[0]["message"].startswith("this is no")
    assert (await api.post("/studies", json={"toml": toml})).status_code == 422


async def test_a_batch_is_watched_to_its_end_and_taken_away(api, at, full):
    async with at.socket("/api/v1/telemetry?rate_Hz=1") as telemetry:
        study = await made(api, definition=SHORT)
        assert (study["name"], study["on"], study["done"], study["total"]) == (SHORT["name"], "batch", 0, 6)
        told = await heard(telemetry, study["id"])
    assert told[0]["event"] == "created"
    assert told[1]["study"]["state"] == "running"
    assert told[-1]["study"]["state"] == "finished"
    assert [news["study"]["done"] for news in told[1:]][-1] == 6

    whole = (await api.get(f"/studies/{study['id']}")).json()
    assert (whole["done"], whole["failed"], whole["rows"], whole["metric"]) == (
        6,
        0,
        6,
        "normalized_mean_error",
    )
    assert [(each["values"], each["runs"]) for each in whole["sets"]] == [
        ({"gait.sweep_deg": sweep}, 2) for sweep in (10, 20, 30)
    ]
    assert all(each["low"] <= each["mean"] <= each["high"] for each in whole["sets"])
    assert whole["best"]["mean"] == min(each["mean"] for each in whole["sets"])
    assert whole["best"]["words"].startswith("sweep ")
    assert (whole["answer"], whole["surface"]) == (None, None)
    in_mm = (await api.get(f"/studies/{study['id']}?metric=mean_error_mm")).json()["sets"]
    assert [each["mean"] for each in in_mm] == pytest.approx([10 * each["mean"] for each in whole["sets"]])
    assert (await api.get(f"/studies/{study['id']}?metric=beauty")).status_code == 422
    if full:
        figure = await api.get(f"/studies/{study['id']}/plot.png", timeout=DONE_WITHIN)
        assert figure.content.startswith(b"\x89PNG")
    await taken_away(api, study["id"], at.archive.folder.parent / "studies" / study["id"])


async def test_what_a_search_has_learned_is_told_by_a_process_of_its_own(api, at):
    definition = {
        **SHORT,
        "design": "tune",
        "repeats": 1,
        "axes": [{"of": "gait.sweep_deg", "from": 10, "to": 40}],
        "tune": {"budget": 6, "first": 4, "at_once": 1, "confirm": 1},
    }
    async with at.socket("/api/v1/telemetry?rate_Hz=1") as telemetry:
        study = await made(api, definition=definition)
        await heard(telemetry, study["id"])
    whole = (await api.get(f"/studies/{study['id']}", timeout=DONE_WITHIN)).json()
    assert (whole["rows"], whole["answer"]["runs"], whole["answer"]["left"]) == (6, 1, 0)
    assert whole["surface"]["axes"] == ["gait.sweep_deg"]
    assert len(whole["surface"]["mean"]) == len(whole["surface"]["marks"][0])
    assert [sample["values"] for sample in whole["surface"]["samples"]][-1] == whole["answer"]["values"]
    assert (await api.delete(f"/studies/{study['id']}")).status_code == 204


async def heard(telemetry, id):
    told = []
    async with asyncio.timeout(DONE_WITHIN):
        while not told or told[-1]["event"] != "ended":
            message = json.loads(await telemetry.recv())
            if message["type"] == "study" and message["study"]["id"] == id:
                told.append(message)
    return told


async def taken_away(api, id, folder):
    table = (await api.get(f"/studies/{id}/table.csv")).text
    rows = list(csv.DictReader(io.StringIO(table)))
    assert [int(row["index"]) for row in rows] == list(range(6))
    report = await api.get(f"/studies/{id}/report", timeout=DONE_WITHIN)
    assert SHORT["name"] in report.text
    assert "style-src 'unsafe-inline'" in report.headers["content-security-policy"]
    made_of, page = (folder / name for name in ("results.jsonl", "report/report.html"))
    assert page.stat().st_mtime_ns == made_of.stat().st_mtime_ns, "rows that come while it is made are seen"
    packed = await api.get(f"/studies/{id}/report.zip")
    with zipfile.ZipFile(io.BytesIO(packed.content)) as file:
        assert file.read("table.csv").decode() == table
        assert {"report.html", "definition.toml"} <= set(file.namelist())
    toml = (await api.get(f"/studies/{id}/definition.toml")).text
    assert (await api.post("/studies/preview", json={"toml": toml})).json()["runs"] == 6

    assert (await api.post(f"/studies/{id}/resume")).status_code == 409
    assert (await api.delete(f"/studies/{id}")).status_code == 204
    assert (await api.get(f"/studies/{id}")).status_code == 404
    assert (await api.get("/studies")).json() == {"studies": []}


async def test_a_batch_is_stopped_and_resumed(api):
    study = await made(api, definition=LONG, jobs=1)
    refused = await api.post("/studies", json={"definition": SHORT})
    assert refused.status_code == 409
    assert "'long'" in refused.json()["detail"]
    assert (await api.delete(f"/studies/{study['id']}")).status_code == 409
    done = (await until_more(api, study["id"], 0))["done"]

    stopped = (await api.post(f"/studies/{study['id']}/stop", timeout=DONE_WITHIN)).json()
    assert stopped["state"] == "stopped"
    assert done <= stopped["done"] < stopped["total"]
    resumed = (await api.post(f"/studies/{study['id']}/resume", json={"jobs": 1})).json()
    assert resumed["state"] == "running"
    await api.post(f"/studies/{study['id']}/stop", timeout=DONE_WITHIN)
    assert (await api.delete(f"/studies/{study['id']}")).status_code == 204


async def test_a_batch_that_its_server_leaves_behind_is_interrupted_and_keeps_its_runs(tmp_path, serve):
    async with serve(application(tmp_path)) as at, client_of(at) as api:
        study = await made(api, definition=LONG, jobs=1)
        done = (await until_more(api, study["id"], 0))["done"]
    left = StudyStore(tmp_path).open(study["id"])
    assert left.state == "interrupted"
    assert left.tally().done >= done


def application(data):
    archive = Archive.open(data)
    return create_app(Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder), archive)


async def until_more(api, id, done):
    """Until it has more runs than so many."""
    async with asyncio.timeout(DONE_WITHIN):
        while (study := (await api.get(f"/studies/{id}")).json())["done"] <= done:
            await asyncio.sleep(0.1)
    return study


def client_of(at):
    return httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=DONE_WITHIN)


async def test_a_study_may_be_made_without_being_begun(api):
    study = await made(api, definition=SHORT, begin=False)
    assert study["state"] == "planned"
    assert (await api.get(f"/studies/{study['id']}/plot.png")).status_code == 409
    assert (await api.delete(f"/studies/{study['id']}")).status_code == 204


async def test_the_plants_of_a_batch_are_listed_with_their_parameters(api):
    plants = {plant["name"]: plant for plant in (await api.get("/plants")).json()}
    assert {"slip", "noslip", "rigid"} <= plants.keys()
    assert "slip_scale" in plants["slip"]["parameters"]["properties"]
