"""Row 30 of faults.md: huge uploads, slow bodies and floods, while the robot walks."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.processes import served

pytestmark = pytest.mark.exclusive

SECONDS = 15.0
GROWTH = 60 << 20
"""What a flood may leave in memory, bytes: the buffers that Python and the allocator keep for the next one."""

REFUSED = {
    "huge": {"413"},
    "wide": {"413", "422"},
    "deep": {"422"},
    "slow": {"408"},
    "quick": {"404"},
    "garbage": {"400"},
    "silent": {"closed"},
    "letters": {"closed"},
    "chatter": {"1008"},
    "shout": {"1009"},
}
"""What each attacker may hear."""


def resident(process: int) -> int:
    [line] = [
        line for line in Path(f"/proc/{process}/status").read_text().splitlines() if line.startswith("VmRSS")
    ]
    return int(line.split()[1]) << 10


def attack(address: str, seconds: float) -> dict[str, int]:
    command = [sys.executable, "-m", "tests.faults.attackers", address, str(seconds)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=seconds + 30, check=True)
    return json.loads(done.stdout)


def test_a_flood_is_refused_the_robot_walks_on_and_memory_stays_flat(tmp_path: Path) -> None:
    with served(tmp_path, "--sim") as server:
        attack(server.address, 3.0)  # what is loaded with the first of each kind is no growth
        server.start_walking()
        run = server.get("/state")["run"]["id"]
        before = resident(server.process.pid)
        heard = attack(server.address, SECONDS)
        state = server.get("/state")
        assert state["rig"] == "running", state["reason"]
        assert state["run"]["id"] == run
        assert resident(server.process.pid) - before < GROWTH
        answers = {name: {key.split()[1] for key in heard if key.startswith(name + " ")} for name in REFUSED}
        assert {name: found - REFUSED[name] for name, found in answers.items() if found - REFUSED[name]} == {}
        assert all(answers.values()), heard
        codes = {event["code"] for event in server.get("/events")["events"] if event["severity"] == "error"}
        assert codes == set()
        time.sleep(1.0)
        assert server.get("/health")["status"] == "ok"
