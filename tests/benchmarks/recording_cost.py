"""What recording costs the loop: on against off in turns, in one run of a rig that walks in real time.

Recorded is every camera frame (60 Hz, 640x480), six times as many as by default.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from control.gait import Gait
from control.runs import Choice, RunRequest, Selection
from control.safety import Refused
from control.snapshot import RigState
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.run_recording import RunRecording
from server.serving import TURN
from server.settings import RigFile

BLOCK = 1.0
"""Seconds of one side, then it is the other's turn: whatever else the computer does meets both alike."""
SETTLING = 0.2
"""Seconds after each change that are not counted: what waits is written, or begins to be."""
ROUNDS = 40
RATE = 60.0
ENCODER = "encoder"
"""In the name of the thread that makes JPEG of the frames."""
RECORDER = "record"
"""In the names of all of the recorder's threads."""
SETTINGS = RigFile.model_validate({"recording": {"frames_Hz": RATE}})
WALK = Selection(Choice("geometric"), Choice("eight"), Gait(sweep=math.radians(10.0)))


@dataclass(slots=True)
class Side:
    """Frame-in to bytes-out of all ticks on one side, s, and shares of one core, by thread."""

    latencies: list[float] = field(default_factory=list)
    shares: list[dict[str, float]] = field(default_factory=list)

    def percentile(self, share: float) -> float:
        return float(np.percentile(self.latencies, share))

    def share(self, *, encoder: bool) -> float:
        """Of the recorder's threads, mean of all blocks, %."""
        blocks = [
            sum(value for name, value in block.items() if (ENCODER in name) is encoder)
            for block in self.shares
        ]
        return 100.0 * float(np.mean(blocks))


def report(rounds: int = ROUNDS, block: float = BLOCK) -> None:
    print(
        f"\nrecording every frame of 640x480 at {RATE:.0f} Hz, on and off in turns, {rounds} x {block:.0f} s each"
    )
    on, off = asyncio.run(measure(rounds, block))
    print(f"{'':12} {'latency p50':>12} {'latency p99':>12} {'ticks':>8}")
    for name, side in (("not recorded", off), ("recorded", on)):
        p50, p99 = side.percentile(50.0) * 1e3, side.percentile(99.0) * 1e3
        print(f"{name:12} {p50:9.3f} ms {p99:9.3f} ms {len(side.latencies):8d}")
    p50, p99 = (on.percentile(share) / off.percentile(share) for share in (50.0, 99.0))
    print(f"{'ratio':12} {p50:12.3f} {p99:12.3f}   (at most 1.03 and 1.10)")
    print(f"recorder, without its encoder: {on.share(encoder=False):.1f} % of one core (at most 10 %)")
    print(f"its JPEG encoder:              {on.share(encoder=True):.1f} % of one core")


async def measure(rounds: int, block: float) -> tuple[Side, Side]:
    """With recording, and without."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(TURN)
    try:
        with tempfile.TemporaryDirectory() as folder:
            return await _in_turns(Path(folder), rounds, block)
    finally:
        sys.setswitchinterval(before)


async def _in_turns(folder: Path, rounds: int, block: float) -> tuple[Side, Side]:
    archive = Archive.open(folder)
    rig = Rig(build_machine(SETTINGS, realtime=True), recorder=archive.recorder)
    on, off = Side(), Side()
    await rig.start()
    try:
        await _walk(rig)
        sides = (on, rig._recording), (off, RunRecording(None))
        for _ in range(rounds):
            for side, recording in sides:
                rig._recording = recording
                await _block(rig, side, block)
            await _walk_on(rig)
        rig._recording = sides[0][1]
    finally:
        await rig.stop()
        archive.close()
    return on, off


async def _block(rig: Rig, side: Side, duration: float) -> None:
    """Some ticks, and what the recorder's threads work meanwhile."""
    await asyncio.sleep(SETTLING)
    kept = rig.machine.loop._timing._latencies
    kept.clear()
    before = _worked()
    await asyncio.sleep(duration)
    side.latencies += tuple(kept)
    side.shares.append({name: (worked - before[name]) / duration for name, worked in _worked().items()})


async def _walk_on(rig: Rig) -> None:
    """A busy computer may have made the rig hold."""
    if rig.snapshot.rig is RigState.HELD:
        with contextlib.suppress(Refused):
            await rig.resume_run()


async def _walk(rig: Rig) -> None:
    """Start a run that does not end by itself."""
    while rig.snapshot.faults or rig.snapshot.pose is None or rig.snapshot.rig is not RigState.DISARMED:
        await asyncio.sleep(0.05)
    await rig.arm()
    await asyncio.sleep(0.5)
    await rig.start_run(RunRequest(WALK, passes=1000.0))


def _worked() -> dict[str, float]:
    """Processor time of each of the recorder's threads, s."""
    threads = [thread for thread in threading.enumerate() if RECORDER in thread.name]
    return {thread.name: _seconds(thread) for thread in threads}


def _seconds(thread: threading.Thread) -> float:
    assert thread.ident is not None
    return time.clock_gettime(time.pthread_getcpuclockid(thread.ident))
