"""The saved rig file from one start of the program to the next."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from server.rig_file import load_rig_file
from tests.processes import served


def serve(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "server", "serve", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


def test_what_was_changed_is_there_at_the_next_start_though_the_server_was_killed(tmp_path: Path) -> None:
    with served(tmp_path) as server:
        server.send("PATCH", "/rig", {"name": "Bench 13", "limits": {"field_mT": 12.0}})
        os.kill(server.process.pid, signal.SIGKILL)
        server.process.wait(10)
    with served(tmp_path) as server:
        rig = server.get("/rig")
    assert (rig["name"], rig["limits"]["field_mT"]) == ("Bench 13", 12.0)
    assert rig["file"]["path"] == str(tmp_path / "rig.toml")


def test_a_corrupt_saved_file_is_named_with_its_line_and_left_alone(tmp_path: Path) -> None:
    saved = tmp_path / "rig.toml"
    saved.write_text('name = "Bench 14"\n[limits]\nfield_mT = "strong"\n')
    answer = serve("--data", str(tmp_path))
    assert answer.returncode == 2
    assert f"{saved} cannot be used" in answer.stderr
    assert "limits.field_mT: Input should be a valid number" in answer.stderr
    assert "(line 3)" in answer.stderr
    assert "Traceback" not in answer.stderr
    assert saved.read_text() == 'name = "Bench 14"\n[limits]\nfield_mT = "strong"\n'


def test_a_real_rig_that_is_only_simulated_for_now_keeps_its_devices_in_the_file(tmp_path: Path) -> None:
    saved = tmp_path / "rig.toml"
    saved.write_text('[camera]\nuri = "v4l://7"  # above the plate\n[link]\nport = "/dev/ttyACM0"\n')
    with served(tmp_path, "--sim") as server:
        rig = server.get("/rig")
        assert rig["simulated"] is True
        assert rig["file"]["overridden"] == ["camera.uri", "link.port"]
        server.send("PATCH", "/rig", {"limits": {"field_mT": 12.0}})
        assert server.get("/rig")["simulated"] is True
    after = load_rig_file(saved)
    assert (after.camera.uri, after.link.port, after.limits.field_mT) == ("v4l://7", "/dev/ttyACM0", 12.0)
    assert "# above the plate" in saved.read_text()
