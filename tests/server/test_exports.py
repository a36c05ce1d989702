"""A recorded run of the simulated rig in each form, compared with what the public readers find in its recording."""

import csv
import io
import itertools
import json
import math
import re
import struct
import tracemalloc
from typing import Any, cast

import av
import cv2
import numpy as np
import pytest
from mcap.reader import make_reader
from pyarrow import parquet
from scipy.io import loadmat

from control.model import PIVOT_A, Pose, pivot_point
from server.assembly import build_machine
from server.exports import table as export_table
from server.exports.columns import COLUMNS, Kind, named
from server.exports.formats import ExportError, Job, export, export_file
from server.exports.naming import file_name
from server.exports.overlay import Overlay
from server.exports.run_film import in_order
from server.recording.reading.recording import Picture, Recording
from server.settings import RigFile
from tests.server.recordings_bench import RecordingsBench, Walk
from tests.server.walked_run import walk
from vision.camera_model import CameraModel
from vision.overlay import END_A

MM = 1e-3
NUMBERS = [column for column in COLUMNS if column.kind in (Kind.NUMBER, Kind.COUNT)]


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    return walk(tmp_path_factory.mktemp("walked"))


@pytest.fixture(scope="module")
def recorded(walked):
    """All that the recording says of each tick, by the public reader: a dict of topics a tick."""
    ticks = {}
    with open(walked.path, "rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            if channel.topic not in ("/camera", "/camera/calibration", "/events", "/selection", "/link"):
                ticks.setdefault(message.log_time, {})[channel.topic] = json.loads(message.data)
    return [ticks[time] for time in sorted(ticks)]


@pytest.fixture(scope="module")
def exported(walked):
    """The bytes of the run in a format."""

    def made(format, overlay=False):
        sink = io.BytesIO()
        export(Job(walked.path, format, overlay), sink)
        return sink.getvalue()

    return made


@pytest.fixture(scope="module")
def rows(exported):
    return list(csv.DictReader(io.StringIO(exported("csv").decode())))


@pytest.fixture(scope="module")
def table(exported):
    return parquet.read_table(io.BytesIO(exported("parquet")))


@pytest.fixture(scope="module")
def matlab(exported):
    return loadmat(io.BytesIO(exported("mat")), squeeze_me=True, struct_as_record=False)


def said(tick, column):
    """What the tick's messages say, None where they say nothing."""
    value = tick.get(column.topic)
    for step in column.path:
        if value is None or (isinstance(step, str) and step not in value):
            return None
        value = value[step]
    return value


def bits(value):
    """The 64 bits of a number, so that -0.0 and the last digit count; None for what is unknown."""
    return None if value is None or math.isnan(value) else struct.pack("<d", value)


def test_csv_parquet_mat_and_mcap_agree_to_the_last_digit(rows, table, matlab, recorded):
    assert len(rows) == table.num_rows == len(recorded) > 200
    for column in NUMBERS:
        truth = [bits(said(tick, column)) for tick in recorded]
        assert [bits(float(row[column.name] or "nan")) for row in rows] == truth, column.name
        assert [bits(value) for value in table[column.name].to_pylist()] == truth, column.name
        assert [bits(value) for value in matlab[column.name]] == truth, column.name


def test_words_are_the_same_everywhere(rows, table, matlab, recorded):
    for column in (column for column in COLUMNS if column.kind is Kind.WORD):
        truth = [said(tick, column) for tick in recorded]
        assert [row[column.name] for row in rows] == truth
        assert table[column.name].to_pylist() == truth
        assert [word if isinstance(word, str) else "" for word in matlab[column.name]] == truth


def test_the_mcap_file_is_the_recording_itself(exported, walked):
    assert exported("mcap") == walked.path.read_bytes()


def test_a_walked_run_fills_its_table(table):
    """Every column has values, and what only a run has is unknown after its end."""
    assert all(table[column.name].null_count < table.num_rows for column in COLUMNS)
    assert table["rig"].to_pylist()[-1] == "disarmed"
    assert table["error_mm"].to_pylist()[-1] is None
    assert table["error_mm"].null_count < 5
    assert all(earlier < later for earlier, later in itertools.pairwise(table["time_s"].to_pylist()))


def test_names_are_unique_and_carry_their_units(table):
    assert len({column.name for column in COLUMNS}) == len(COLUMNS)
    endings = {"s": "_s", "mm": "_mm", "deg": "_deg", "deg/s": "_deg_s", "px": "_px", "px^2": "_px2"}
    endings |= {"A": "_A", "mT": "_mT", "ms": "_ms", "Hz": "_Hz", "mm^2": "_mm2", "deg^2": "_deg2"}
    for column in COLUMNS:
        assert column.unit == "1" or column.name.endswith(endings.get(column.unit, "_mm_deg"))
        assert table.schema.field(column.name).metadata == {
            b"unit": column.unit.encode(),
            b"description": column.description.encode(),
        }


def test_every_table_for_analysis_brings_the_settings_along(table, matlab):
    about = table.schema.metadata
    assert json.loads(about[b"settings"])["run"]["controller"]["name"] == "geometric"
    assert json.loads(about[b"outcome"])["state"] == "finished"
    assert matlab["settings"].run.gait.sweep_deg == pytest.approx(10.0)
    assert matlab["settings"].rig.limits.current_A.tolist() == [8.0, 8.0, 8.0]
    assert matlab["units"].error_mm == "mm"
    assert matlab["descriptions"].error_mm.startswith("/reference")


def test_a_torn_recording_is_exported_as_far_as_it_goes(walked, tmp_path, rows):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(walked.path.read_bytes()[: walked.path.stat().st_size // 2])
    sink = io.BytesIO()
    export(Job(torn, "csv"), sink)
    found = list(csv.DictReader(io.StringIO(sink.getvalue().decode())))
    assert 20 < len(found) < len(rows)
    assert found == rows[: len(found)]


@pytest.mark.parametrize("format", ["svg", "mat", "parquet", "mp4"])
def test_every_form_takes_a_torn_recording(walked, tmp_path, format):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(walked.path.read_bytes()[: walked.path.stat().st_size // 2])
    sink = io.BytesIO()
    export(Job(torn, format, overlay=True), sink)
    assert len(sink.getvalue()) > 1000


def test_memory_does_not_grow_with_the_run(tmp_path, monkeypatch):
    """In batches of 25 ticks here, so that a short run has many of them."""
    monkeypatch.setattr(export_table, "AT_ONCE", 25)
    bench = RecordingsBench()
    peaks = []
    for index, duration in enumerate((2.0, 2.0, 8.0)):
        id = bench.record(tmp_path, Walk(duration=duration, frame_rate=0.0, index=index))
        tracemalloc.start()
        with open(tmp_path / f"{index}.csv", "wb") as sink:
            export(Job(tmp_path / "recordings" / f"{id}.mcap", "csv"), sink)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    _, short, long = peaks  # the first one also loads what all need
    assert long <= 1.3 * short


@pytest.mark.parametrize("content", [b"", b"no recording at all", None])
def test_what_is_no_recording_is_refused_in_words(tmp_path, content):
    path = tmp_path / "run.mcap"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ExportError, match=r"run\.mcap"):
        export(Job(path, "csv"), io.BytesIO())


def test_the_figure_says_what_walked_and_how_well(exported, walked):
    drawn = exported("svg").decode()
    with Recording.open(walked.path) as recording:
        metrics = (recording.outcome or {})["metrics"]
    for words in (
        "geometric on eight",
        "sweep 10°, tilt 25°",
        f"ME {metrics['normalized_mean_error']:.4f}",
        f"mean {metrics['mean_error_mm']:.2f} mm",
        "x, mm",
        "error, mm",
        "finished",
    ):
        assert words in drawn
    assert drawn == exported("svg").decode(), "the same run gives the same figure"


def test_the_figure_is_a_picture_too(exported):
    picture = cv2.imdecode(np.frombuffer(exported("png"), np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    assert picture.shape == (702, 1300, 3)


def test_the_film_lasts_as_long_as_the_run(exported, walked):
    with av.open(io.BytesIO(exported("mp4")), "r") as film:
        shown = [picture.time for picture in film.decode(video=0)]
    with Recording.open(walked.path) as recording:
        taken = sorted(picture.captured_s for picture in recording.frames())
    assert shown == pytest.approx([time - taken[0] for time in taken], abs=1e-4)
    assert shown[-1] == pytest.approx(4.2, abs=0.3)


def test_a_picture_that_was_late_has_its_place_in_the_film():
    order = [3, 0, 1, 2, 4, 12, 5, 6, 7, 8, 9, 10, 11, 13]
    pictures = [Picture(0.1 * place, 0.1 * number, b"") for place, number in enumerate(order)]
    assert [round(10 * picture.captured_s) for picture in in_order(pictures)] == sorted(order)


def test_a_film_in_a_file_can_be_jumped_in(walked, tmp_path):
    export_file(Job(walked.path, "mp4"), tmp_path / "film.mp4")
    written = (tmp_path / "film.mp4").read_bytes()
    assert written.index(b"moov") < written.index(b"mdat")


def test_the_overlay_stands_on_the_robot_when_its_picture_was_taken(walked):
    """End A's mark, drawn from the estimate, is where the tracker saw that end in the very same picture."""
    model = build_machine(RigFile(), realtime=False).camera_model
    with Recording.open(walked.path) as recording, Overlay.of(walked.path) as overlay:
        settings, seen = recording.settings, sightings(recording)
        for picture in itertools.islice(recording.frames(), 5, None, 5):
            drawn = overlay.drawn(np.zeros((480, 640, 3), np.uint8), picture.captured_s)
            v, u = np.nonzero((drawn == END_A).all(axis=2))
            captured = min(seen, key=lambda time, now=picture.captured_s: abs(time - now))
            assert captured == pytest.approx(picture.captured_s, abs=1e-6)
            assert (u.mean(), v.mean()) == pytest.approx(end_a(seen[captured], settings, model), abs=1.5)


def sightings(recording: Recording) -> dict[float, Any]:
    """Where the robot was seen, by the capture time since the run's start, s."""
    first = next(iter(recording.messages(["/state"])))
    begin = cast(dict, first.data)["time_s"] - first.time_s
    said = (cast(dict, entry.data) for entry in recording.messages(["/measurement"]))
    return {each["captured_s"] - begin: each for each in said if "x_mm" in each}


def end_a(seen: dict[str, Any], settings: dict[str, Any], model: CameraModel) -> tuple[float, float]:
    """u, v of end A in the picture, px."""
    pose = Pose(seen["x_mm"] * MM, seen["y_mm"] * MM, math.radians(seen["heading_deg"]))
    end = pivot_point(pose, PIVOT_A, settings["rig"]["robot"]["length_mm"] * MM)
    return model.to_pixel(*end, settings["body_height_mm"] * MM)


def test_a_run_without_pictures_has_no_film(tmp_path):
    still = walk(tmp_path, duration=0.5, frames_Hz=0.0)
    with pytest.raises(ExportError, match="without pictures"):
        export(Job(still.path, "mp4"), io.BytesIO())


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("x_mm", {"x_mm": "far"}),
        ("x_mm", {"x_mm": True}),
        ("x_mm", {"x_mm": 10**400}),
        ("x_mm", {}),
        ("tick", {"tick": 1.5}),
        ("tick", {"tick": 2**60}),
        ("rig", {"rig": 3}),
        ("current_x_A", {"commanded_A": []}),
        ("current_x_A", {"commanded_A": {"x": 1}}),
        ("run_s", {"run": [1]}),
    ],
)
def test_a_value_of_another_kind_is_unknown(name, message):
    (column,) = named([name])
    assert column.of({column.topic: message}) is None
    assert column.of({}) is None


@pytest.mark.parametrize(
    ("label", "name"),
    [
        ("", "1.csv"),
        ("first try", "1_first-try.csv"),
        ("../../etc/passwd", "1_etc-passwd.csv"),
        ('a"b\r\nSet-Cookie: c', "1_a-b-Set-Cookie-c.csv"),
        ("Größe μ", "1_Gr-e.csv"),
        ("...", "1.csv"),
        ("x" * 300, f"1_{'x' * 60}.csv"),
    ],
)
def test_a_file_name_is_safe_whatever_the_label(label, name):
    assert file_name("1", label, ".csv") == name
    assert re.fullmatch(r"[A-Za-z0-9._-]+", name)
