"""Recorded pictures, looked at again."""

import csv
import itertools
import json
import math
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from control.gait import Gait
from control.model import Tracking
from control.runs import Choice, RunRequest, Selection
from server.archive import Archive
from server.assembly import build_machine
from server.commands.runs import app
from server.headless import Headless
from server.recording.reading.recording import Recording
from server.retrack.changes import Changes, RetrackError, changed_rig
from server.retrack.comparison import Seen
from server.retrack.recorded_tick import recorded_ticks
from server.retrack.retracking import retrack
from server.retrack.series import MOST_POINTS, Thinned
from server.settings import RigFile

GAIT = Gait(sweep=math.radians(20.0))
WALKS = {
    "fine": ("geometric", 4.0, {"frames_Hz": 60.0, "quality": 95}),
    "usual": ("star", 3.0, {}),
    "blind": ("straight", 0.5, {"frames_Hz": 0.0}),
}
"""Controller, duration in s, and what of it is recorded."""


def walk(archive, id, controller, duration, recording):
    request = RunRequest(Selection(controller=Choice(controller), gait=GAIT), duration=duration)
    machine = build_machine(RigFile.model_validate({"recording": recording}), realtime=False)
    Headless(machine, recorder=archive.recorder).run(id, request)
    archive.recorder.finish()


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("walked")
    archive = Archive.open(folder, patient=True)
    try:
        for id, how in WALKS.items():
            walk(archive, id, *how)
    finally:
        archive.close()
    return folder


@pytest.fixture
def path_of(data):
    return lambda id: data / "recordings" / f"{id}.mcap"


def test_the_same_settings_find_what_the_rig_knew(path_of):
    """Measured over 10 s: 0.003 mm and 0.04 degrees on average, 0.015 mm and 0.19 degrees at most."""
    found = retrack(path_of("fine"), Changes())["comparison"]
    assert found["ticks"] > 240
    assert found["pictures"] > 0.95 * found["ticks"]
    assert found["position_mm"]["max"] <= 0.1
    assert found["heading_deg"]["max"] <= 0.5
    assert found["locked_share"] == {"then": 1.0, "now": 1.0}
    assert found["times_lost"] == found["sightings_refused"] == {"then": 0, "now": 0}
    assert found["mean_error_mm"]["now"] == pytest.approx(found["mean_error_mm"]["then"], abs=0.01)
    assert found["command"] is None


def test_between_few_pictures_the_filter_carries_the_robot_on(path_of):
    """Ten pictures a second: 0.46 mm and 1.9 degrees at most in 30 s of the eight."""
    found = retrack(path_of("usual"), Changes())["comparison"]
    assert found["pictures"] < 0.2 * found["ticks"]
    assert found["known_share"]["now"] == 1.0
    assert 0.0 < found["position_mm"]["rms"] < 0.3
    assert found["heading_deg"]["max"] < 6.0


def test_a_filter_that_trusts_its_model_too_much_refuses_what_it_sees(path_of):
    stiff = Changes(estimator={"slip_mm": 0.001, "swing_share": 0.001, "loose_share": 0.001})
    found = retrack(path_of("fine"), stiff)["comparison"]
    assert found["sightings_refused"]["now"] > found["sightings_refused"]["then"] == 0
    assert found["position_mm"]["max"] > 0.1


def test_with_a_wrong_colour_the_robot_is_lost_at_once(path_of):
    found = retrack(path_of("fine"), Changes(vision={"hue_deg": [200.0, 240.0]}))["comparison"]
    assert found["locked_share"] == {"then": 1.0, "now": 0.0}
    assert found["times_lost"] == {"then": 0, "now": 1}
    assert found["known_share"]["now"] < 0.1


def test_a_camera_that_sees_a_larger_plate_makes_the_path_larger(path_of):
    rig = RigFile().model_dump(mode="json")
    rig["camera"]["picture_height_mm"] *= 1.01
    series = retrack(path_of("fine"), Changes(rig=rig))["series"]
    last = -1
    assert series["y_mm"][last] == pytest.approx(1.01 * series["then_y_mm"][last], abs=0.05)
    assert abs(series["then_y_mm"][last]) > 20.0


@pytest.mark.parametrize("id", ["fine", "usual"])
def test_the_controller_of_the_run_would_have_commanded_what_it_did(path_of, id):
    found = retrack(path_of(id), Changes(controller=Choice(WALKS[id][0])))["comparison"]["command"]
    assert found["ticks"] > 100
    assert found["same_pivot_share"] == found["same_rate_share"] == found["walked_again_share"] == 1.0
    assert found["rate_deg_s"]["max"] < 1e-6


def test_another_controller_is_asked_and_not_obeyed(path_of):
    found = retrack(path_of("fine"), Changes(controller=Choice("star")))
    command = found["comparison"]["command"]
    assert command["walked_again_share"] == 1.0
    assert command["same_rate_share"] < 0.5
    assert "not obeyed" in command["note"]
    assert found["comparison"]["position_mm"]["max"] <= 0.1


def test_a_controller_that_is_shown_the_new_estimate_answers_nearly_the_same(path_of):
    asked = Changes(controller=Choice("geometric"), estimate="again")
    command = retrack(path_of("fine"), asked)["comparison"]["command"]
    assert command["same_pivot_share"] > 0.95
    assert 0.0 < command["rate_deg_s"]["rms"] < 10.0


def test_of_a_torn_recording_the_readable_part_is_looked_at(path_of, tmp_path):
    whole = path_of("fine").read_bytes()
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(whole[: len(whole) // 2])
    found = retrack(torn, Changes(controller=Choice("geometric")))["comparison"]
    assert 60 < found["ticks"] < 240
    assert found["position_mm"]["max"] <= 0.1
    assert found["command"]["same_rate_share"] == 1.0


def test_what_cannot_be_looked_at_is_refused_in_words(path_of, tmp_path):
    rubbish = tmp_path / "rubbish.mcap"
    rubbish.write_bytes(b"rubbish")
    with pytest.raises(RetrackError, match="no recording that can be read"):
        retrack(rubbish, Changes())
    with pytest.raises(RetrackError, match="without pictures"):
        retrack(path_of("blind"), Changes())
    with pytest.raises(RetrackError, match="no controller called 'nobody'"):
        retrack(path_of("fine"), Changes(controller=Choice("nobody")))
    with pytest.raises(RetrackError, match=r"estimator\.slip_mm"):
        retrack(path_of("fine"), Changes(estimator={"slip_mm": -1.0}))
    with pytest.raises(RetrackError, match="640 x 480 px"):
        retrack(path_of("fine"), Changes(rig={"camera": {"size_px": [320, 240]}}))


def test_colours_are_those_of_the_profile_in_use():
    lamp = {"hue_deg": [10.0, 30.0], "saturation": [90, 255], "value": [70, 255]}
    then = RigFile.model_validate({"vision": {"profile": "lamp", "profiles": {"lamp": lamp}}})
    rig = changed_rig(then, Changes(vision={"hue_deg": [100.0, 120.0], "heading_hint_deg": 5.0}))
    assert rig.vision.in_use.hue_deg == (100.0, 120.0)
    assert rig.vision.in_use.saturation == (90, 255)
    assert (rig.vision.hue_deg, rig.vision.heading_hint_deg) == (then.vision.hue_deg, 5.0)


def test_what_was_asked_for_survives_its_way_to_another_process():
    changes = Changes({"profile": "lamp"}, {"slip_mm": 0.1}, {}, Choice("star", {"a": 1}), "again")
    assert Changes.from_json(json.loads(json.dumps(changes.to_json()))) == changes
    with pytest.raises(ValueError, match="allowed: recorded, again"):
        Changes.from_json({**changes.to_json(), "estimate": "mine"})


@pytest.mark.parametrize("count", [1, MOST_POINTS, MOST_POINTS + 1, 5 * MOST_POINTS + 3])
def test_however_long_a_run_is_its_series_stays_short_and_even(path_of, count):
    with Recording.open(path_of("blind")) as recording:
        tick = next(recorded_ticks(recording))
    thinned = Thinned()
    for number in range(count):
        thinned.add(Seen(replace(tick, number=number), None, Tracking.LOST, False, False, None))
    numbers = thinned.columns()["tick"]
    steps = {later - earlier for earlier, later in itertools.pairwise(numbers)}
    assert numbers[0] == 0
    assert min(count, MOST_POINTS // 2) <= len(numbers) <= MOST_POINTS
    assert len(steps) <= 1
    assert count - 1 - numbers[-1] < max(steps, default=1)


@pytest.fixture
def command(data):
    return lambda *arguments: CliRunner().invoke(app, ["retrack", *arguments, "--data", str(data)])


def test_the_command_prints_the_comparison_and_writes_every_tick(command, tmp_path):
    out = tmp_path / "again.csv"
    answer = command("fine", "--estimator", "slip_mm=0.4", "--json", "--out", str(out))
    assert answer.exit_code == 0, answer.output
    told = json.loads(answer.stdout)
    assert (told["run_id"], told["changes"]["estimator"]) == ("fine", {"slip_mm": 0.4})
    lines = list(csv.DictReader(out.read_text().splitlines()))
    assert len(lines) == told["comparison"]["ticks"]
    largest = max(float(line["distance_mm"]) for line in lines)
    assert largest == told["comparison"]["position_mm"]["max"]
    assert command("fine", "--out", str(out)).exit_code == 2, "nothing is overwritten"


def test_the_command_shows_then_and_now_for_people(command):
    answer = command("usual", "--controller", "star")
    assert answer.exit_code == 0, answer.output
    rows = {line.split("\t")[0]: line.split("\t")[1:] for line in answer.stdout.splitlines()}
    assert rows["seen in pictures"][:2] == ["100.0 %", "100.0 %"]
    assert rows["same pivot commanded"][1] == "100.0 %"


def test_a_command_that_fails_leaves_nothing(command, tmp_path):
    out = tmp_path / "again.csv"
    answer = command("blind", "--out", str(out))
    assert answer.exit_code == 1
    assert "without pictures" in answer.stderr
    assert list(tmp_path.iterdir()) == []
    for wrong in (("--vision", "hue_deg"), ("--set", "a=1")):
        assert command("fine", *wrong).exit_code == 2
