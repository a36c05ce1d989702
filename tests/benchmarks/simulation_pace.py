"""How much faster than real time the complete simulated rig runs: pixels, bytes, board, plant and loop."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile

EIGHT = ["--controller", "geometric", "--trajectory", "eight", "--sweep", "10", "--tilt", "25"]


def report() -> None:
    print("\ncomplete simulated rig, one eight (125.66 s), as fast as it goes; the reference is real time")
    print(f"{'plant':8} {'':12} {'wall':>9} {'times real time':>16} {'mean error':>12} {'steps':>6}")
    for plant in ("noslip", "slip"):
        for recorded in (True, False):
            _walk(plant, recorded)


def _walk(plant: str, recorded: bool) -> None:
    """Recorded as by default, ten pictures a second, or not at all."""
    command = [sys.executable, "-m", "server", "run", *EIGHT, "--plant", plant, "--seed", "1", "--json"]
    with tempfile.TemporaryDirectory() as data:
        command += ["--duration", "125.66", "--data", data, *(() if recorded else ("--no-record",))]
        result = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    pace = result["simulated_s"] / result["wall_s"]
    error, name = result["mean_error_mm"], "recorded" if recorded else "not recorded"
    print(f"{plant:8} {name:12} {result['wall_s']:7.2f} s {pace:16.1f} {error:9.2f} mm {result['steps']:6d}")
