"""The file of a walked run: a sound MCAP file for everybody's reader, with every digit of what the rig knew."""

from __future__ import annotations

import base64
import json
import math
from itertools import pairwise
from pathlib import Path

import pytest
from mcap.reader import make_reader

from server.api import ticks
from server.recording.tick_json import as_tick
from server.recording.topics import EACH_TICK, TOPICS
from server.recording.writing.recorder import TAIL
from server.recording.writing.run_file import FLUSH
from tests.server.mcap_doctor import examine
from tests.server.recorded_walk import record_walk

PERIOD = 1.0 / 60.0
JPEG = b"\xff\xd8\xff"
TYPES = {
    "number": (int, float),
    "integer": int,
    "string": str,
    "boolean": bool,
    "object": dict,
    "array": list,
}


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    return record_walk(tmp_path_factory.mktemp("walk"), "walk-1", duration=3.0, frames_Hz=20.0)


@pytest.fixture(scope="module")
def messages(walked):
    """(topic, schema, log time, publish time, data) of each, in the order of time, by the public reader."""
    found = []
    with walked.path.open("rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            assert schema is not None
            said = json.loads(schema.data), message.log_time, message.publish_time, json.loads(message.data)
            found.append((channel.topic, *said))
    return found


def of(messages, topic):
    return [data for name, _, _, _, data in messages if name == topic]


def by_tick(messages):
    """The messages of each tick, by topic."""
    each_tick = {topic.name for topic in EACH_TICK}
    found = {}
    for topic, _, _, _, data in messages:
        if topic in each_tick:
            found.setdefault(data["tick"], {})[topic] = data
    return found


def attachment(walked, name):
    with walked.path.open("rb") as file:
        return next(
            json.loads(each.data) for each in make_reader(file).iter_attachments() if each.name == name
        )


def test_the_file_is_sound(walked):
    statistics = examine(walked.path)
    assert statistics.message_count > 10 * 3.0 / PERIOD


def test_a_chunk_lasts_a_quarter_of_a_second_at_most(walked):
    with walked.path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    chunks = summary.chunk_indexes
    lengths = [(chunk.message_end_time - chunk.message_start_time) * 1e-9 for chunk in chunks]
    assert max(lengths) <= FLUSH
    assert math.fsum(lengths) >= 3.0 - len(lengths) * 2 * PERIOD


def test_every_tick_of_the_run_is_there_and_half_a_second_after_it(walked, messages):
    recorded = [data["tick"] for data in of(messages, "/state")]
    assert recorded == list(range(recorded[0], recorded[-1] + 1))
    running = [tick for tick, seen in walked.snapshots.items() if seen.run is not None]
    assert set(running) <= set(recorded)
    assert recorded[-1] <= running[-1] + (TAIL + PERIOD) / PERIOD


def test_every_message_is_as_its_schema_says(messages):
    for topic, schema, _, _, data in messages:
        validate(data, schema, topic)


def validate(value, schema, where):
    """The part of JSON schema that we write; what is not described is not there."""
    expected = TYPES[schema["type"]]
    assert isinstance(value, expected), f"{where}: {value!r}"
    assert schema["type"] in ("boolean", "array", "object", "string") or not isinstance(value, bool), where
    if schema["type"] == "object":
        assert set(schema["required"]) <= set(value) <= set(schema["properties"]), where
        for name, inner in value.items():
            validate(inner, schema["properties"][name], f"{where}.{name}")
    if schema["type"] == "array":
        assert schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", math.inf), where
        for inner in value:
            validate(inner, schema["items"], f"{where}[]")


@pytest.mark.parametrize("topic", TOPICS, ids=lambda topic: topic.name)
def test_every_property_has_a_meaning_a_unit_and_a_type_that_foxglove_knows(topic):
    require_described(topic.schema)
    assert topic.schema["title"] == topic.schema_name
    assert {"time_s", "tick"} <= set(topic.schema["required"])


def require_described(schema):
    """Foxglove takes one plain type for each field, and arrays of numbers, words or objects."""
    assert schema["type"] == "object"
    for name, each in schema["properties"].items():
        assert each["description"], name
        assert each["unit"], name
        assert each["type"] in TYPES, name
        inner = each["items"] if each["type"] == "array" else each
        assert inner["type"] != "array", name
        if inner["type"] == "object":
            require_described(inner)


def test_units_in_names_are_those_of_the_schema():
    endings = {"_mm": "mm", "_deg": "deg", "_deg_s": "deg/s", "_s": "s", "_A": "A", "_mT": "mT", "_ms": "ms"}
    for topic in TOPICS:
        for name, each in topic.schema["properties"].items():
            ending = max((end for end in endings if name.endswith(end)), key=len, default="")
            if ending and each["type"] != "object" and not name.startswith("covariance"):
                assert each["unit"] == endings[ending], f"{topic.name}.{name}"


def test_a_recorded_tick_is_the_tick_that_was_told(walked, messages):
    for tick, found in by_tick(messages).items():
        told = ticks.state(walked.snapshots[tick])
        told.pop("recording")
        recorded = as_tick(found)
        assert recorded.pop("recording")["state"] == "off"
        require_same(told, recorded, f"tick {tick}")


def require_same(told, recorded, where):
    """Up to the rounding of what is told."""
    if isinstance(told, dict):
        assert told.keys() == recorded.keys(), where
        for name, value in told.items():
            require_same(value, recorded[name], f"{where}.{name}")
    elif isinstance(told, list):
        assert len(told) == len(recorded), where
        for index, value in enumerate(told):
            require_same(value, recorded[index], f"{where}[{index}]")
    elif isinstance(told, float):
        digits = len(repr(told).partition(".")[2])
        assert recorded == pytest.approx(told, abs=0.51 * 10.0 ** -min(digits, 4), rel=1e-12), where
    else:
        assert recorded == told, where


def test_every_digit_survives(walked, messages):
    for tick, found in by_tick(messages).items():
        seen = walked.snapshots[tick]
        assert found["/state"]["time_s"] == seen.time
        assert found["/estimate"]["x_mm"] == seen.pose.x * 1e3
        assert found["/estimate"]["heading_deg"] == math.degrees(seen.pose.heading)
        assert tuple(found["/currents"]["measured_A"]) == seen.measured_currents
        assert found["/pose"]["pose"]["position"] == {"x": seen.pose.x, "y": seen.pose.y, "z": 0.0}


def test_a_covariance_has_the_sigmas_on_its_diagonal(messages):
    for each in of(messages, "/estimate"):
        xx, xy, xh, yx, yy, yh, hx, hy, hh = each["covariance_mm_deg"]
        sigmas = each["sigma_x_mm"], each["sigma_y_mm"], each["sigma_heading_deg"]
        assert (xy, xh, yh) == (yx, hx, hy)
        assert [math.sqrt(v) for v in (xx, yy, hh)] == pytest.approx(sigmas, rel=1e-9)


def test_the_corners_of_the_field_lead_to_where_it_is(messages):
    """Who keeps the corners of all ticks knows the field at every instant of the run."""
    heading = None
    for each in of(messages, "/field"):
        for corner in each["corners"]:
            heading = corner["heading_deg"]
            assert corner["time_s"] <= each["time_s"]
        assert heading == each["heading_deg"]
        assert each["full_at_s"] < math.inf


def test_log_times_are_utc_and_go_on_as_the_rig_s_time_does(walked, messages):
    started = round(walked.row.started_at.timestamp() * 1e6) * 1000
    first = walked.snapshots[of(messages, "/state")[0]["tick"]]
    zero = first.time - first.run.elapsed
    for topic, _, log_time, _, data in messages:
        if topic == "/state":
            assert log_time - started == pytest.approx((data["time_s"] - zero) * 1e9, abs=2.0)


def test_messages_stand_in_the_order_of_time(messages):
    times = [log_time for _, _, log_time, _, _ in messages]
    assert times == sorted(times)
    ticks_at = [log_time for topic, _, log_time, _, _ in messages if topic == "/state"]
    assert all(earlier < later for earlier, later in pairwise(ticks_at))


def test_a_picture_stands_beside_the_tick_that_it_came_with(walked, messages):
    frames = of(messages, "/camera")
    assert walked.row.frames == len(frames)
    times = [data["time_s"] for data in of(messages, "/state")]
    assert len(frames) == pytest.approx((times[-1] - times[0]) * 20.0, abs=1.5)
    for frame in frames:
        assert frame["captured_s"] == walked.snapshots[frame["tick"]].captured_at
        assert base64.b64decode(frame["data"]).startswith(JPEG)


def test_a_picture_is_published_when_it_was_captured(messages):
    states = {data["tick"]: (log_time, data) for topic, _, log_time, _, data in messages if topic == "/state"}
    for topic, _, log_time, published, data in messages:
        if topic == "/camera":
            at, state = states[data["tick"]]
            assert log_time == at
            assert (log_time - published) * 1e-9 == pytest.approx(
                state["time_s"] - data["captured_s"], abs=1e-8
            )


def test_settings_tell_how_the_run_was_made(walked):
    settings = attachment(walked, "settings.json")
    assert settings["run"]["id"] == "walk-1"
    assert settings["run"]["controller"]["name"] == "geometric"
    assert settings["rig"]["recording"]["frames_Hz"] == 20.0
    assert settings["seed"] == 1
    assert {"pivotrig", "python", "numpy", "firmware"} <= set(settings["versions"])
    assert settings["revision"] is None or len(settings["revision"]) == 40
    assert len(settings["reference_points_mm"]) > 100
    assert settings["camera"]["size_px"] == [640, 480]


def test_the_rig_file_inside_gives_the_same_rig_again(walked, tmp_path):
    from server.rig_file import load_rig_file

    settings = attachment(walked, "settings.json")
    (tmp_path / "rig.toml").write_text(settings["rig_toml"])
    again = load_rig_file(tmp_path / "rig.toml")
    assert again.to_recorded() == settings["rig"]


def test_the_outcome_is_that_of_the_catalogue(walked):
    outcome = attachment(walked, "outcome.json")
    assert outcome["state"] == walked.row.state == "finished"
    assert outcome["metrics"] == walked.row.metrics
    assert outcome["frames_left_out"] == 0
    assert outcome["failure"] == ""
    assert walked.row.recording_state == "complete"
    assert walked.row.size_bytes == walked.path.stat().st_size


def test_the_overview_has_the_series_of_the_charts(walked):
    overview = attachment(walked, "overview.json")
    lengths = {len(series) for series in overview.values()}
    assert len(lengths) == 1
    assert overview["time_s"][-1] == pytest.approx(3.0, abs=0.6)
    assert {"error_mm", "x_mm", "x_measured_mm", "x_reference_mm", "current_x_A", "measured_z_A"} <= set(
        overview
    )
    assert len(walked.row.sparkline) == 60


def test_the_selection_and_the_lens_stand_at_the_beginning(messages):
    assert [topic for topic, *_ in messages[:2]] == ["/selection", "/camera/calibration"]
    (chosen,) = of(messages, "/selection")
    assert chosen["trajectory"] == "eight"
    assert json.loads(chosen["gait"])["sweep_deg"] == 30.0
    assert len(chosen["reference_x_mm"]) == len(chosen["reference_y_mm"])


def test_the_events_of_the_run_are_told(messages):
    told = [(line["level"], line["message"]) for line in of(messages, "/events")]
    assert (2, "walking") in told
    assert (2, "run finished") in told


def test_the_readme_lists_the_topics():
    readme = (Path(__file__).parents[2] / "README.md").read_text()
    for topic in TOPICS:
        assert f"| `{topic.name}` | `{topic.schema_name}` | {topic.kind.__doc__} |" in readme
