"""The process of a study: nobody but itself writes its answer."""

import json
import subprocess

from control.studies.definition import StudyDefinition
from server.studies.child import PROGRAM
from server.studies.store import StudyStore

SHORT = """
name = "one short run"
duration_s = 1.0
[trajectory]
name = "circle"
parameters = { radius_mm = 5.0 }
[gait]
time_law = "wait"
[plant]
name = "noslip"
"""
TALKATIVE = """
from control.controllers import controllers
from control.controllers.geometric import Geometric

print("here I am")


@controllers.register
class Talkative(Geometric):
    name = "talkative"
"""
ANSWERED_WITHIN = 60.0
"""On a busy computer, s; it takes about 4."""


def test_what_a_plug_in_prints_does_not_come_between_the_lines_of_a_study_s_progress(tmp_path):
    plugin = tmp_path / "talkative.py"
    plugin.write_text(TALKATIVE)
    study = StudyStore(tmp_path).create(StudyDefinition.from_toml(SHORT))
    with subprocess.Popen(
        [*PROGRAM, "carry-out", "1", str(tmp_path), study.id, str(plugin)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        lines = process.stdout.read().splitlines()
        assert process.wait(ANSWERED_WITHIN) == 0
    assert [json.loads(line)["done"] for line in lines] == [1]
    assert study.state == "finished"
