"""The program's log: its lines for people and for machines, its files, and what floods do to it."""

import json
import logging
import time

import pytest

from server.watching import log as program_log
from server.watching.log import REPEATS, LogChoice, LogFileError, logging_to
from tests.processes import served

logger = logging.getLogger("pivotrig.test")


def lines(path):
    return path.read_text(encoding="utf-8").splitlines()


def test_lines_are_json_objects_with_a_time_and_no_line_makes_another(tmp_path):
    path = tmp_path / "logs" / "pivotrig.log"
    with logging_to(LogChoice(as_json=True, file=path, level="info")):
        logger.info("a line with\na break and %s", "\x1b[31mcolour")
        logger.debug("not asked for")
        try:
            raise ValueError("odd")
        except ValueError:
            logger.exception("it failed")
    first, second = map(json.loads, lines(path))
    assert first["message"] == "a line with\na break and \x1b[31mcolour"
    assert (first["level"], first["logger"]) == ("info", "pivotrig.test")
    assert first["at"].endswith("+00:00")
    assert "ValueError: odd" in second["traceback"]


def test_words_for_people_cannot_be_forged(tmp_path):
    path = tmp_path / "log"
    with logging_to(LogChoice(file=path)):
        logger.warning("name: %s", "x\n2026-01-01 error root: forged\x1b[2J")
    [line] = lines(path)
    assert "\\n2026" in line
    assert "\x1b" not in line


def test_a_flood_of_one_kind_of_line_is_cut_short_and_counted(tmp_path, monkeypatch):
    path = tmp_path / "log"
    with logging_to(LogChoice(file=path)):
        for number in range(5000):
            logger.warning("the same again: %d", number)
        logger.warning("another")
        monkeypatch.setattr(program_log, "WINDOW", 0.0)
        time.sleep(0.01)
        logger.warning("the same again: %d", 5000)
    found = lines(path)
    assert len(found) == REPEATS + 2
    assert f"{5000 - REPEATS} more" in found[-1]


def test_files_are_rotated_and_bounded(tmp_path, monkeypatch):
    monkeypatch.setattr(program_log, "FILE_BYTES", 2000)
    path = tmp_path / "log"
    with logging_to(LogChoice(file=path)):
        for number in range(400):
            logger.warning(f"line {number} " + "x" * 50)
    files = sorted(tmp_path.iterdir())
    assert len(files) == program_log.FILES
    assert all(file.stat().st_size <= 2000 for file in files)


def test_a_log_that_cannot_be_written_is_said_in_words(tmp_path):
    (tmp_path / "file").write_text("")
    with (
        pytest.raises(LogFileError, match="--log-file"),
        logging_to(LogChoice(file=tmp_path / "file" / "log")),
    ):
        pass


def test_the_rigs_events_are_in_the_log_of_the_program(tmp_path):
    path = tmp_path / "pivotrig.log"
    log_options = ("--log-format", "json", "--log-file", str(path), "--log-level", "info")
    with served(tmp_path / "data", *log_options) as server:
        server.until(lambda state: state["tracking"] == "locked")
        server.post("/estop")
        server.process.terminate()
        assert server.process.wait(10) == 0
    events = [entry for entry in map(json.loads, lines(path)) if entry["logger"] == "pivotrig.events"]
    [estop] = [entry for entry in events if entry["code"] == "estop"]
    assert (estop["severity"], estop["level"]) == ("error", "error")
    assert estop["rig_time_s"] > 0.0
