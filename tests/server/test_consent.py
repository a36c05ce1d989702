"""A real rig puts no current into its coils before a person has said so; a simulated one does not ask."""

from pathlib import Path

import httpx
import pytest
from typer.testing import CliRunner

from control.coil_heat import ASSUMED_AT_START
from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.cli import app
from server.rig import Rig
from server.rig_file import load_rig_file
from server.settings import RigFile
from tests.real_rig import real_rig

pytestmark = pytest.mark.anyio


def client(at) -> httpx.AsyncClient:
    return httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=10.0)


@pytest.fixture(scope="module")
async def real(serve, tmp_path_factory: pytest.TempPathFactory):
    """An HTTP client of a real rig."""
    with real_rig(tmp_path_factory.mktemp("bench")) as path:
        archive = Archive.open(tmp_path_factory.mktemp("data"))
        rig = Rig(build_machine(load_rig_file(path), realtime=True), recorder=archive.recorder)
        async with serve(create_app(rig, archive)) as at, client(at) as api:
            yield api


@pytest.mark.parametrize("body", [None, {}, {"consent": False}])
async def test_a_real_rig_does_not_arm_without_consent_and_says_why(real, body):
    answer = await (real.post("/arm", json=body) if body is not None else real.post("/arm"))
    assert answer.status_code == 409
    assert "this rig is real: arming puts current into its coils" in answer.json()["detail"]
    assert (await real.get("/state")).json()["rig"] == "disarmed"


async def test_with_consent_everything_else_still_has_to_be_right(real):
    answer = await real.post("/arm", json={"consent": True})
    assert answer.status_code == 409
    assert "this rig is real" not in answer.json()["detail"]
    assert (await real.get("/state")).json()["rig"] == "disarmed"


@pytest.mark.parametrize(
    "body", [{"consent": "yes"}, {"consent": 1}, {"consent": None}, {"agreed": True}, [True]]
)
async def test_nothing_but_true_is_consent(real, body):
    answer = await real.post("/arm", json=body)
    assert answer.status_code == 422


async def test_a_real_rig_counts_its_coils_as_warm_after_a_start_and_says_so(real):
    heat = (await real.get("/state")).json()["coil_heat"]
    assert heat == pytest.approx([ASSUMED_AT_START] * 3, abs=0.02)
    lines = [e["message"] for e in (await real.get("/events")).json()["events"] if e["code"] == "heat"]
    assert lines == ["what the coils carried before this start is not known: they count as 80% hot"]


async def test_a_simulated_rig_arms_without_being_asked_and_starts_cold(serve, tmp_path):
    archive = Archive.open(tmp_path)
    rig = Rig(build_machine(RigFile(), realtime=True), recorder=archive.recorder)
    async with (
        serve(create_app(rig, archive)) as at,
        httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=10.0) as api,
    ):
        answer = await api.post("/arm")
        for _ in range(200):
            if answer.status_code == 200:
                break
            answer = await api.post("/arm")
        assert answer.json()["rig"] == "armed"
        assert max(answer.json()["coil_heat"]) < 0.01


def walk(folder: Path, *options: str, said: str = ""):
    """A walk on a rig whose devices are not there."""
    rig_file = folder / "rig.toml"
    rig_file.write_text('[camera]\nuri = "v4l:///dev/nothing0"\n[link]\nport = "/dev/nothing1"\n')
    return CliRunner().invoke(app, ["run", "--rig", str(rig_file), *options], input=said)


@pytest.mark.parametrize("said", ["", "n\n", "\n", "maybe\n"])
def test_a_run_on_a_real_rig_asks_first_and_takes_only_yes(tmp_path: Path, said: str) -> None:
    done = walk(tmp_path, said=said)
    assert done.exit_code == 3
    assert "This puts current through the coils of a real rig." in done.stderr
    assert "nothing was driven; agree when asked, or say --yes" in done.stderr
    assert done.stdout == ""


@pytest.mark.parametrize(("options", "said"), [(["--yes"], ""), ([], "y\n"), ([], "Yes\n")])
def test_a_run_with_consent_goes_on_to_open_the_rig(tmp_path: Path, options: list[str], said: str) -> None:
    done = walk(tmp_path, *options, said=said)
    assert done.exit_code == 3
    assert "nothing was driven" not in done.stderr
    assert "/dev/nothing0" in done.stderr
