"""`pivotrig runs replay`: the dashboard, opened at a recording."""

import json
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest
from recordings_bench import RecordingsBench, Walk
from typer.testing import CliRunner

from server.commands.runs import app

READY = re.compile(r"dashboard: (http://127\.0\.0\.1:\d+)/#replay=(\S+)")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    data, bench = tmp_path_factory.mktemp("recorded"), RecordingsBench()
    return data, [bench.record(data, Walk(1.0, frame_rate=0.0, index=index)) for index in range(2)]


def test_it_serves_a_disarmed_simulated_rig_and_leads_to_both_runs(recorded):
    data, ids = recorded
    command = ["runs", "replay", "last", ids[0], "--no-open", "--data", str(data)]
    script = Path(sys.executable).with_name("pivotrig")
    with subprocess.Popen([script, *command], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            ready = READY.fullmatch(process.stdout.readline().strip())
            assert ready is not None
            url, shown = ready.groups()
            assert shown == f"{ids[1]},{ids[0]}"
            state = json.load(urllib.request.urlopen(f"{url}/api/v1/state"))
            assert (state["rig"], state["simulated"]) == ("disarmed", True)
            overview = json.load(urllib.request.urlopen(f"{url}/api/v1/runs/{ids[0]}/overview"))
            assert overview["frames"] == 0
        finally:
            process.send_signal(signal.SIGTERM)
    assert process.returncode == 0


def test_what_cannot_be_shown_is_refused_in_words(recorded):
    data, ids = recorded
    for arguments, words in (
        ([*ids, "last"], "one can be shown, or two"),
        (["nobody"], "nobody"),
        ([], "Missing argument"),
    ):
        refused = CliRunner().invoke(app, ["replay", *arguments, "--no-open", "--data", str(data)])
        assert refused.exit_code == 2
        assert words in refused.output.replace("\n", " ")
    path = data / "recordings" / f"{ids[1]}.mcap"
    path.rename(path.with_suffix(".away"))
    lost = CliRunner().invoke(app, ["replay", ids[1], "--no-open", "--data", str(data)])
    path.with_suffix(".away").rename(path)
    assert lost.exit_code == 1
    assert "no recording" in lost.output
