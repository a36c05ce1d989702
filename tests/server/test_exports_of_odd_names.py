"""Names that somebody has chosen, in a plug-in or for a path, do not keep a run from being exported."""

import io
from xml.etree import ElementTree

import pytest
from scipy.io import loadmat

from control.runs import Choice, RunRequest, Selection
from control.trajectories import trajectories
from control.trajectories.circle import Circle
from server.archive import Archive
from server.assembly import build_machine
from server.exports.formats import Job, export
from server.headless import Headless
from server.settings import RigFile

NAME = "5 $ of <circle>^ \a\n日本 $"
LONG = "smallest_distance_to_the_edge_of_the_workspace_mm"


class Odd(Circle):
    name = NAME

    class Parameters(Circle.Parameters):
        smallest_distance_to_the_edge_of_the_workspace_mm: float = 7.0


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    trajectories.register(Odd)
    archive = Archive.open(tmp_path_factory.mktemp("odd"), patient=True)
    try:
        walk = Headless(build_machine(RigFile(), realtime=False), recorder=archive.recorder)
        request = RunRequest(Selection(trajectory=Choice(NAME, {LONG: 7.0})), duration=0.5)
        walk.run("odd", request)
    finally:
        archive.close()
        trajectories.forget(NAME)
    return archive.path_of("odd")


def exported(path, format):
    sink = io.BytesIO()
    export(Job(path, format), sink)
    return sink.getvalue()


@pytest.mark.filterwarnings("ignore:Glyph")
def test_a_name_stands_in_the_figure_as_it_is(path):
    drawn = ElementTree.fromstring(exported(path, "svg"))
    assert "5 $ of <circle>^   日本 $" in "\n".join(drawn.itertext())


def test_a_long_name_is_a_field_of_the_mat_file(path):
    found = loadmat(io.BytesIO(exported(path, "mat")), squeeze_me=True, struct_as_record=False)
    trajectory = found["settings"].run.trajectory
    assert trajectory.name == NAME
    assert getattr(trajectory.parameters, LONG) == 7.0
