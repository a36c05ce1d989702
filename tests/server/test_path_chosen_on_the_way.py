"""A run whose path was changed while it walked is shown with the path of each instant: page, scene and film."""

from dataclasses import replace

import numpy as np
import pytest

from control.runs import Choice, Run, RunRequest, RunState, Selection
from server.archive import Archive
from server.assembly import build_machine
from server.exports.overlay import Overlay
from server.recording.conditions import reference_points
from server.recording.reading.paths import MM, path_at, paths_of
from server.recording.reading.recording import Recording
from server.replay.overview import overview_of
from server.replay.shown import robot_of
from server.replay.staging import course_of
from server.settings import RigFile
from tests.server.recordings_bench import RecordingsBench, Walk

BEGUN, CHOSEN = Selection(), Selection(trajectory=Choice("line"))
WALK = Walk(2.0, frame_rate=0.0)
CHANGED = 1.0
"""When the other path is chosen, s since the run's start."""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    archive = Archive.open(tmp_path_factory.mktemp("changed"), patient=True)
    run = Run(WALK.id, RunRequest(CHOSEN, duration=WALK.duration), RunState.RUNNING, WALK.started)
    gait_only = replace(CHOSEN, gait=replace(CHOSEN.gait, sweep=0.2))

    def change(snapshot):
        if snapshot.tick == round(CHANGED * WALK.rate):
            archive.recorder.change(run)
            archive.recorder.change(replace(run, request=replace(run.request, selection=gait_only)))

    try:
        RecordingsBench().record_in(archive, WALK, change)
    finally:
        archive.close()
    return archive.path_of(WALK.id)


@pytest.fixture
def recording(path):
    with Recording.open(path) as opened:
        yield opened


def metres(selection):
    return np.array(reference_points(selection)) * MM


def test_each_path_holds_from_when_it_was_chosen(recording):
    paths = paths_of(recording)
    assert [time for time, _ in paths] == pytest.approx([0.0, CHANGED])
    for time, selection in ((-1.0, BEGUN), (0.0, BEGUN), (CHANGED - 0.1, BEGUN), (CHANGED + 0.1, CHOSEN)):
        assert path_at(paths, time) == pytest.approx(metres(selection))


def test_the_page_is_told_of_both(recording):
    told = overview_of(recording)
    assert told["reference_points_mm"] == reference_points(BEGUN)
    assert [each["time_s"] for each in told["paths"]] == pytest.approx([0.0, CHANGED])
    for each, selection in zip(told["paths"], (BEGUN, CHOSEN), strict=True):
        assert np.array(each["points_mm"]) == pytest.approx(np.array(reference_points(selection)))


def test_the_scene_shows_the_one_that_is_walked(recording):
    course = course_of(recording)
    for at, selection in ((CHANGED - 0.1, BEGUN), (CHANGED + 0.1, CHOSEN)):
        assert robot_of(None, course, at).path == pytest.approx(metres(selection))


def test_the_film_shows_the_one_that_is_walked(path):
    model = build_machine(RigFile(), realtime=False).camera_model
    places = [metres(selection)[index] for selection, index in ((BEGUN, rightmost(BEGUN)), (CHOSEN, 150))]
    spots = [tuple(round(value) for value in model.to_pixel(place[0], place[1], 0.0)) for place in places]
    with Overlay.of(path) as overlay:
        for at, shown in ((CHANGED - 0.1, [True, False]), (CHANGED + 0.1, [False, True])):
            drawn = overlay.drawn(np.zeros((480, 640, 3), np.uint8), at)
            assert [bool(drawn[v - 2 : v + 3, u - 2 : u + 3].any()) for u, v in spots] == shown


def rightmost(selection):
    """The place of the path's point that is farthest from the line, which is the y axis."""
    return int(metres(selection)[:, 0].argmax())
