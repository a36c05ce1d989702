"""The rig file on disk (faults.md row 32): corrupt, newer, changed, killed in the middle of a save."""

import os
import signal
import stat
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from server.atomic_save import STALE, previous_of
from server.rig_file import (
    ChangedOnDisk,
    RigFileError,
    RigStore,
    differences,
    load_rig_file,
    merged,
    settings_in,
    with_settings,
)
from server.settings import RigFile

ROOT = Path(__file__).parent.parent.parent
EXAMPLE = (ROOT / "rig.example.toml").read_text(encoding="utf-8")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "rig.toml"


@pytest.fixture
def store(path: Path) -> RigStore:
    path.write_text(EXAMPLE)
    return RigStore(path)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ('name = "A"\n[robot\n', "line 2"),
        (
            "[robot]\n\nlength_mm = -1\n",
            "robot.length_mm: Input should be greater than 0 (given: -1) (line 3)",
        ),
        ("robot.length_mm = -1\n", "robot.length_mm: Input should be greater than 0 (given: -1) (line 1)"),
        (
            "[robot]\n'lenght_mm' = 1\n",
            "robot.lenght_mm: Extra inputs are not permitted (line 2)",
        ),
        ("\n[coils.x]\ndiameter_mm = 390\n", "coils.x.turns: Field required (line 2)"),
        ("[limits]\ncurrent_A = [8, 8, nan]\n", "limits.current_A.2: Input should be a finite number"),
        ("version = 0\n", "version: Input should be 1 (given: 0) (line 1)"),
    ],
)
def test_a_file_that_cannot_be_used_says_which_field_in_which_line(text: str, complaint: str) -> None:
    with pytest.raises(RigFileError) as refusal:
        settings_in(text, Path("rig.toml"))
    assert complaint in str(refusal.value)
    assert "rig.toml" in str(refusal.value)


def test_a_file_that_is_not_text_is_refused(path: Path) -> None:
    path.write_bytes(b"name = '\xff'\n")
    with pytest.raises(RigFileError, match="not UTF-8 text"):
        load_rig_file(path)


def test_a_newer_file_asks_for_a_newer_program_and_is_left_alone(path: Path) -> None:
    path.write_text("version = 2\n[quantum]\nspin = 0.5\n")
    with pytest.raises(RigFileError, match=r"version = 2.*needs a newer pivotrig"):
        RigStore(path)
    assert path.read_text() == "version = 2\n[quantum]\nspin = 0.5\n"


def test_a_file_without_a_version_has_the_first() -> None:
    assert settings_in("", Path("rig.toml")) == RigFile()


def test_a_change_keeps_every_comment_and_every_other_line(store: RigStore) -> None:
    plan = store.save({"coils": {"x": {"turns": 300}}, "limits": {"current_A": [1, 2, 3]}})
    assert plan.changed == ("coils.x.turns", "limits.current_A")
    lines = zip(EXAMPLE.splitlines(), store.path.read_text().splitlines(), strict=True)
    changed = [(old.partition("#"), new.partition("#")) for old, new in lines if old != new]
    assert [new[0].strip() for _, new in changed] == ["turns = 300", "current_A = [1.0, 2.0, 3.0]"]
    assert all(old[1:] == new[1:] for old, new in changed)


def test_a_change_is_what_the_next_start_reads(store: RigStore) -> None:
    store.save({"name": "Bench 3", "camera": {"size_px": [320, 240]}})
    again = load_rig_file(store.path)
    assert again == store.settings
    assert (again.name, again.camera.size_px) == ("Bench 3", (320, 240))


def test_null_puts_a_default_back(store: RigStore) -> None:
    store.save({"limits": {"field_mT": 9.0}})
    store.save({"limits": {"field_mT": None}})
    assert load_rig_file(store.path) == RigFile()


def test_a_rig_that_was_never_saved_gets_a_file_of_what_differs(path: Path) -> None:
    store = RigStore(path)
    assert not store.is_saved
    store.save({"coils": {"x": {"turns": 300}}})
    values = tomllib.loads(path.read_text())
    assert set(values) == {"version", "coils"}
    assert values["coils"]["x"]["turns"] == 300
    assert load_rig_file(path).coils.x.turns == 300


def test_the_file_before_the_last_save_is_kept_beside_it(store: RigStore) -> None:
    store.save({"name": "second"})
    store.save({"name": "third"})
    assert load_rig_file(previous_of(store.path)).name == "second"
    assert store.plan_of_previous().changed == ("name",)


def test_permissions_and_a_symbolic_link_survive_a_save(tmp_path: Path) -> None:
    kept = tmp_path / "kept" / "bench.toml"
    kept.parent.mkdir()
    kept.write_text(EXAMPLE)
    kept.chmod(0o640)
    link = tmp_path / "rig.toml"
    link.symlink_to(kept)
    RigStore(link).save({"name": "Bench 4"})
    assert link.is_symlink()
    assert load_rig_file(kept).name == "Bench 4"
    assert stat.S_IMODE(kept.stat().st_mode) == 0o640
    assert sorted(file.name for file in kept.parent.iterdir()) == ["bench.toml", "bench.toml.previous"]


@pytest.mark.parametrize(
    "changes",
    [
        {"limits": {"field_mT": -1}},
        {"limits": {"soft_margin_mm": 20.0}},
        {"limits": 3},
        {"quantum": {"spin": 1}},
        {"coils": {"x": {"turns": None}}},
        {"version": 2},
        {"camera": {"uri": "v4l://0"}},
    ],
)
def test_a_change_that_makes_no_valid_rig_changes_nothing(store: RigStore, changes: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        store.save(changes)
    assert store.settings == RigFile()
    assert os.listdir(store.path.parent) == ["rig.toml"]
    assert store.path.read_text() == EXAMPLE


def test_an_edit_by_somebody_else_is_not_overwritten(store: RigStore) -> None:
    edited = EXAMPLE.replace("field_mT = 15.0", "field_mT = 7.0")
    store.path.write_text(edited)
    with pytest.raises(ChangedOnDisk, match="was edited since it was read"):
        store.save({"name": "Bench 5"})
    assert store.path.read_text() == edited


def test_a_file_that_was_deleted_comes_back_whole_with_the_next_change(store: RigStore) -> None:
    store.path.unlink()
    store.save({"name": "Bench 6"})
    assert store.path.read_text() == EXAMPLE.replace('"The paper\'s rig"', '"Bench 6"')


def test_a_folder_that_takes_no_file_is_named(tmp_path: Path) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.write_text("")
    store = RigStore(in_the_way / "rig.toml")
    with pytest.raises(RigFileError, match=r"cannot be saved: .*nothing was changed"):
        store.save({"name": "Bench 7"})


def test_what_a_killed_save_has_left_is_removed_later(store: RigStore) -> None:
    left = store.path.with_name(".rig.toml.0badcafe.new")
    left.write_text("half")
    store.save({"name": "young"})
    assert left.exists(), "it may be somebody's who is still saving"
    long_ago = time.time() - 2 * STALE
    os.utime(left, (long_ago, long_ago))
    store.save({"name": "old"})
    assert not left.exists()


SAVER = """
import sys
from pathlib import Path
from server.rig_file import RigStore
store = RigStore(Path(sys.argv[1]))
for number in range(10**9):
    store.save({"name": f"rig {number}", "limits": {"field_mT": 1.0 + number % 10}})
    if number == 1:
        print("two are saved", flush=True)
"""


def test_a_save_that_is_killed_at_any_instant_leaves_a_whole_file_and_the_one_before(
    store: RigStore, full: bool
) -> None:
    for attempt in range(20 if full else 5):
        with subprocess.Popen(
            [sys.executable, "-c", SAVER, str(store.path)], stdout=subprocess.PIPE, cwd=ROOT
        ) as saver:
            assert saver.stdout is not None
            assert saver.stdout.readline() == b"two are saved\n"
            time.sleep(0.003 * attempt)
            saver.send_signal(signal.SIGKILL)
        now, before = load_rig_file(store.path), load_rig_file(previous_of(store.path))
        for rig in (now, before):
            number = int(rig.name.removeprefix("rig "))
            assert rig.limits.field_mT == 1.0 + number % 10, "each file is of one save"
        assert int(now.name.removeprefix("rig ")) - int(before.name.removeprefix("rig ")) in (0, 1)


numbers = st.floats(0.1, 20.0)
spans = st.tuples(st.integers(0, 255), st.just(255))
marks = st.none() | st.fixed_dictionaries({}, optional={"value": spans})
colours: dict[str, st.SearchStrategy[Any]] = {"saturation": spans, "end_mark": marks}
profiles = st.dictionaries(
    st.sampled_from(["lamp", "a dim day", "7"]), st.none() | st.fixed_dictionaries({}, optional=colours)
)
change_sets = st.fixed_dictionaries(
    {},
    optional={
        "name": st.text(min_size=1, max_size=80),
        "limits": st.fixed_dictionaries(
            {}, optional={"field_mT": numbers, "current_A": st.lists(numbers, min_size=3, max_size=3)}
        ),
        "coils": st.fixed_dictionaries(
            {},
            optional={
                "supply_V": numbers,
                "x": st.fixed_dictionaries({}, optional={"turns": st.integers(1, 999)}),
                "z": st.fixed_dictionaries({}, optional={"inductance_mH": numbers}),
            },
        ),
        "vision": st.fixed_dictionaries({}, optional={**colours, "profiles": profiles}),
        "simulation": st.fixed_dictionaries({}, optional={"seed": st.integers(0, 2**31 - 1)}),
    },
)
LAYOUTS = [
    "",
    EXAMPLE,
    "limits.field_mT = 3.0\ncoils.supply_V = 12 # dotted\n",
    "limits = { field_mT = 3.0 } # inline\n[coils]\n# nothing\n",
    "[vision.profiles.lamp]\nvalue = [3, 99] # dim\n[vision.profiles.lamp.end_mark]\n[vision.end_mark]\n[robot]\n",
    "[vision]\nprofiles = { lamp = { value = [3, 99] }, 7 = {} }\n[vision.end_mark]\nvalue = [1, 2]\n",
    "[simulation]\nseed = 4\n\n[coils.z]\ndiameter_mm = 225\nseparation_mm = 110\nturns = 154\n"
    "resistance_ohm = 1.5\ninductance_mH = 14\n[limits]\n[coils.x]\ndiameter_mm = 390\nseparation_mm = 240\n"
    "turns = 314\nresistance_ohm = 2.5\ninductance_mH = 125\n",
]


@settings(deadline=None)  # tomlkit takes 60 ms for the whole example, and longer on a busy computer
@given(changes=change_sets, layout=st.sampled_from(LAYOUTS))
def test_whatever_the_layout_the_text_says_what_was_asked(changes: dict[str, Any], layout: str) -> None:
    before = settings_in(layout, Path("rig.toml"))
    wanted = RigFile.model_validate(merged(before.model_dump(mode="json"), changes))
    text = with_settings(layout, before, wanted)
    assert settings_in(text, Path("rig.toml")) == wanted
    assert (differences(before, wanted) == ()) == (before == wanted)


def test_a_path_that_cannot_be_looked_at_is_an_error_that_names_it(tmp_path: Path) -> None:
    with pytest.raises(RigFileError, match=r"cannot read the rig file .*File name too long"):
        RigStore(tmp_path / ("a" * 300))


def test_a_file_is_taken_over_although_what_it_was_cannot_be_kept(path: Path) -> None:
    path.write_text('name = "before"\n')
    store = RigStore(path)
    path.write_text('name = "after"\n')
    (previous_of(path) / "in the way").mkdir(parents=True)
    with pytest.raises(RigFileError, match=r"is in force, but what it was before cannot be kept"):
        store.take_disk(store.plan_of_disk())
    assert (store.settings.name, store.is_as_read) == ("after", True)
    assert sorted(each.name for each in path.parent.iterdir()) == [path.name, previous_of(path).name]


@pytest.mark.parametrize("port", ["/dev/ttyACM0", "/dev/serial/by-id/usb-Arduino", "auto"])
def test_a_real_board_is_not_driven_by_a_simulated_camera(port: str) -> None:
    with pytest.raises(ValueError, match="a robot that nobody sees"):
        RigFile.model_validate({"link": {"port": port}, "simulation": {"board": "tcp://127.0.0.1:5000"}})
