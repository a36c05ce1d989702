"""The rig file taken along and taken over: whole or not at all, with its comments, and never with a secret."""

import tomllib
from pathlib import Path

import pytest
from test_rig_file_changes import bench

from server import rig_file
from server.rig_file import RigStore
from server.rig_import import UnusableText, exported, listed, plan_of_text
from server.rig_schema import rig_schema
from server.settings import RigFile

KEY = "https://hooks.example.org/services/T0/key-of-the-lab?room=7"
SECRETIVE = f"""# our bench
name = "Bench 4"   # by the window
[camera]
uri = "rtsp://me:secret@10.0.0.2/live"
[link]
port = "/dev/ttyACM0"
[notifications]
webhook_url = "{KEY}"
"""


@pytest.fixture
def secretive(tmp_path: Path) -> RigStore:
    path = tmp_path / "rig.toml"
    path.write_text(SECRETIVE)
    return RigStore(path)


@pytest.fixture
async def here(serve, tmp_path: Path):
    async with bench(serve, tmp_path / "rig.toml") as one:
        yield one


def test_what_is_given_away_has_the_comments_and_no_secret(secretive):
    text = exported(secretive)
    assert "# by the window" in text
    assert "secret" not in text
    assert "key-of-the-lab" not in text
    assert tomllib.loads(text)["notifications"]["webhook_url"] == "https://hooks.example.org/***"


def test_a_secret_that_was_put_out_of_force_is_none_to_give_away_either(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(f'# see https://example.org/\n[notifications]\n#webhook_url = "{KEY}" # the old one\n')
    text = exported(RigStore(path))
    assert text == '# see https://example.org/\n[notifications]\n#webhook_url = "***" # the old one\n'


def test_a_rig_takes_its_own_file_back_with_its_secrets(secretive):
    plan = plan_of_text(secretive, exported(secretive))
    assert plan.changed == ()
    assert plan.text == SECRETIVE


def test_what_another_file_would_change_is_listed_without_secrets(secretive):
    plan = plan_of_text(secretive, '[notifications]\nwebhook_url = "http://10.0.0.9/other-key"\n')
    changes = {change["field"]: (change["from"], change["to"]) for change in listed(secretive.settings, plan)}
    assert changes["notifications.webhook_url"] == ("https://hooks.example.org/***", "http://10.0.0.9/***")
    assert changes["camera.uri"] == ("rtsp://***@10.0.0.2/live", "sim://")
    assert "key" not in str(changes)
    assert "secret" not in str(changes)


def test_a_hidden_address_of_another_lab_leaves_this_one_s(tmp_path):
    other = RigStore(tmp_path / "other.toml")
    plan = plan_of_text(other, '[notifications]\nwebhook_url = "https://hooks.example.org/***"\n')
    assert plan.settings.notifications.webhook_url == ""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name = ", "not TOML"),
        ("[limits]\nfield_mT = 1100.0\nfoo = 1\n", "limits.field_mT"),
        ("version = 7", "needs a newer pivotrig"),
        ("[notifications]\nwebhook_url = 'ftp://x/secret'", "begins with http:// or https://"),
    ],
)
def test_a_text_that_is_no_rig_file_says_what_is_wrong_in_it(tmp_path, text, words):
    with pytest.raises(UnusableText, match=words) as refusal:
        plan_of_text(RigStore(tmp_path / "rig.toml"), text)
    assert "secret" not in str(refusal.value)


def test_another_kind_of_file_is_refused_without_looking_for_each_of_its_values_again(tmp_path, monkeypatch):
    looked = []
    monkeypatch.setattr(
        rig_file, "_lines", lambda text, lines=rig_file._lines: looked.append(text) or lines(text)
    )
    text = "".join(f"package_{number} = 1\n" for number in range(300))
    with pytest.raises(UnusableText, match=r"package_0: .*\(line 1\)(.|\n)* and 200 more$") as refusal:
        plan_of_text(RigStore(tmp_path / "rig.toml"), text)
    assert len(looked) == 1
    assert len(str(refusal.value).splitlines()) < 110


@pytest.mark.parametrize(
    "url",
    [
        "file:///etc/passwd",
        "http://",
        "http://me:pw@host/",
        "http://host:99999/",
        "https://hést/",
        "http://a b/",
    ],
)
def test_only_an_address_that_can_be_asked_is_taken(url):
    with pytest.raises(ValueError, match="webhook_url"):
        RigFile.model_validate({"notifications": {"webhook_url": url}})
    assert RigFile.model_validate({"notifications": {"webhook_url": "http://[::1]:8080/x?y=1"}})


def test_no_recording_of_a_run_has_the_address(secretive):
    assert "notifications" not in secretive.settings.to_recorded()
    assert "key-of-the-lab" not in str(secretive.settings.to_public())


def test_every_value_of_the_schema_has_a_title_and_the_default_of_the_program():
    values = dict(leaves("", rig_schema()))
    defaults = RigFile().model_dump(mode="json")
    for path, node in values.items():
        assert node["title"], path
        wanted = defaults
        for name in path.split("."):
            wanted = wanted[name]
        assert node["default"] == wanted, path
    assert values["limits.field_mT"]["unit"] == "mT"
    assert values["limits.current_A"]["labels"] == ["x", "y", "z"]
    assert values["limits.current_slew_A_s"]["unit"] == "A/s"
    assert [path for path, node in values.items() if node["live"]] == [
        "version", "name", "notifications.webhook_url", "notifications.on", "notifications.timeout_s",
    ]  # fmt: skip


def leaves(path, node):
    for name, child in node["properties"].items():
        own = f"{path}.{name}".lstrip(".")
        yield from leaves(own, child) if "properties" in child else [(own, child)]


@pytest.mark.anyio
async def test_a_file_is_looked_at_first_and_then_applied_whole_and_can_be_undone(here):
    await here.ready()
    text = '# from the other lab\nname = "Bench 4"\n[limits]\nfield_mT = 11.0\n'
    look = await here.api.post("/rig/import", json={"toml": text})
    assert look.json()["differences"] == [
        {"field": "name", "from": "The paper's rig", "to": "Bench 4"},
        {"field": "limits.field_mT", "from": 15.0, "to": 11.0},
    ]
    assert (await here.get("/rig"))["name"] == "The paper's rig"
    done = (await here.api.post("/rig/import", json={"toml": text, "apply": True})).json()
    assert (done["changed"], done["name"], done["rebuilt"]) == (["name", "limits.field_mT"], "Bench 4", True)
    assert here.path.read_text() == text
    given = await here.api.get("/rig/file.toml")
    assert given.text == text
    assert given.headers["content-disposition"] == 'attachment; filename="rig.toml"'
    await here.ready()
    await here.api.post("/arm")
    refusal = await here.api.post("/rig/import", json={"toml": "", "apply": True})
    assert refusal.status_code == 409
    await here.api.post("/disarm")
    await here.api.post("/rig/undo")
    assert (await here.get("/rig"))["limits"]["field_mT"] == 15.0


@pytest.mark.anyio
async def test_a_bad_file_changes_nothing_and_names_every_wrong_value(here):
    refusal = await here.api.post(
        "/rig/import", json={"toml": "[limits]\nfield_mT = -1\nfoo = 2\n", "apply": True}
    )
    assert refusal.status_code == 422
    assert "limits.field_mT" in refusal.json()["detail"]
    assert "limits.foo" in refusal.json()["detail"]
    assert not here.path.exists()


@pytest.mark.anyio
async def test_the_page_learns_what_there_is(here):
    schema = await here.get("/rig/schema")
    assert schema["properties"]["limits"]["properties"]["field_mT"]["default"] == 15.0
    about = await here.get("/about")
    assert about["data"]["folder"] == str(here.path.parent)
    assert about["data"]["free_bytes"] > 0
    assert about["camera"]["size_px"] == [640, 480]
    assert about["program"]["version"]
