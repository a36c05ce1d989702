"""The file of one run: ticks, pictures and events in, an MCAP file out. Belongs to the recorder's writing thread."""

from __future__ import annotations

import fcntl
import json
import math
import time
from pathlib import Path
from typing import Any

import msgspec

from control.news import Announcement
from control.runs import Selection
from control.snapshot import Snapshot
from server.api.choices import selection_json
from server.recording import foxglove
from server.recording.clock import RunClock
from server.recording.conditions import reference_points
from server.recording.messages import OfTick, SelectionMessage
from server.recording.names import JSON, METADATA, OUTCOME, OVERVIEW, SETTINGS
from server.recording.provenance import versions
from server.recording.topics import CALIBRATION, CAMERA, EACH_TICK, EVENTS, SELECTION, TOPICS
from server.recording.writing.disk import Disk, DiskFile, sync_folder
from server.recording.writing.mcap_writer import McapWriter
from server.recording.writing.pictures import Picture
from vision.camera_model import CameraModel

FLUSH = 0.25
"""A chunk is written at least this often, s: with the second of `SYNC`, a crash costs 1.25 s (faults.md, row 24)."""
SYNC = 1.0
"""The disk is waited for this often, s."""
LARGEST_CHUNK = 4 << 20
"""Bytes; pictures of a large camera end a chunk before its time."""
MEGA = 1e6


class DiskFull(OSError):
    """Less is free than has to stay free."""

    def __init__(self, free: int, keep: int) -> None:
        super().__init__(
            f"{free / MEGA:.0f} MB are free on the disk, and recording.keep_free_MB = {keep / MEGA:.0f} have to stay "
            "free; delete runs or make room"
        )


class RunFile:
    """size: bytes that are in the file and whole.  ticks, frames: written.

    Everything raises OSError where the disk does; the file is then what it was at the last flush.
    """

    def __init__(self, path: Path, disk: Disk, settings: dict[str, Any], keep_free: int) -> None:
        """keep_free: bytes that have to stay free on the disk."""
        self.path = path
        self._disk = disk
        self._keep_free = keep_free
        self._encode = msgspec.json.Encoder().encode
        self._clock: RunClock | None = None
        self._chunk_from = math.inf
        self._flushed = self._synced = time.monotonic()
        self._tick = 0
        self._time = 0.0
        self.ticks = self.frames = 0
        self._file = disk.create(path)
        try:
            fcntl.flock(self._file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
            self._writer = _begun(self._file, settings)
            sync_folder(path.parent)
        except BaseException:
            self._file.close()
            path.unlink(missing_ok=True)
            raise
        self._channels = {topic.name: self._register(topic.name) for topic in TOPICS}

    @property
    def size(self) -> int:
        return self._writer.size

    def begin(self, clock: RunClock, selection: Selection, camera: CameraModel) -> None:
        """What stands at the beginning of every run, on the disk before the first tick."""
        self._clock, self._time = clock, clock.zero
        self.select(selection)
        utc = clock.start
        self._add(CALIBRATION.name, _calibration(camera, clock), utc, utc)
        self.flush()
        self._sync()

    def tick(self, snapshot: Snapshot) -> None:
        """All messages of one tick."""
        if snapshot.time - self._chunk_from >= FLUSH or self._writer.waiting > LARGEST_CHUNK:
            self.flush()
        clock = self._running
        utc = clock.tick(snapshot.time)
        self._tick, self._time = snapshot.tick, snapshot.time
        self._chunk_from = min(self._chunk_from, snapshot.time)
        seen = snapshot.captured_at
        captured = utc if seen is None else clock.utc(seen)
        for topic in EACH_TICK:
            message = topic.of(snapshot, utc) if topic.of is not None else None
            if message is not None:
                published = captured if topic.name == "/measurement" else utc
                self._add(topic.name, message, utc, published)
        self.ticks += 1

    def picture(self, picture: Picture) -> None:
        """The picture of the newest tick, or one that comes late."""
        clock = self._running
        captured = clock.utc(picture.captured_at)
        message = foxglove.CompressedImage(
            time_s=self._time,
            tick=self._tick,
            timestamp=foxglove.time_of(captured),
            frame_id=foxglove.CAMERA_FRAME,
            format="jpeg",
            captured_s=picture.captured_at,
            frame=picture.index,
            data=picture.jpeg,
        )
        self._add(CAMERA.name, message, clock.newest, captured)
        self.frames += 1

    def event(self, line: Announcement) -> None:
        clock = self._running
        message = foxglove.Log(
            time_s=line.time,
            tick=self._tick,
            timestamp=foxglove.time_of(clock.utc(line.time)),
            level=foxglove.LEVELS.get(line.severity, 0),
            message=line.message,
            name=line.code,
            file="",
            line=0,
        )
        self._add(EVENTS.name, message, clock.newest, clock.utc(line.time))

    def select(self, selection: Selection) -> None:
        """What the run uses from now on."""
        chosen = selection_json(selection)
        x, y = zip(*reference_points(selection), strict=True)
        message = SelectionMessage(
            time_s=self._time,
            tick=self._tick,
            controller=selection.controller.name,
            controller_parameters=json.dumps(chosen["controller"]["parameters"]),
            trajectory=selection.trajectory.name,
            trajectory_parameters=json.dumps(chosen["trajectory"]["parameters"]),
            gait=json.dumps(chosen["gait"]),
            reference_x_mm=x,
            reference_y_mm=y,
        )
        utc = self._running.newest
        self._add(SELECTION.name, message, utc, utc)

    def flush_if_due(self) -> None:
        """By this computer's clock; the rig's may be slower, or stand still."""
        now = time.monotonic()
        if now - self._flushed >= FLUSH:
            self.flush()
        if now - self._synced >= SYNC:
            self._check_room()
            self._sync()

    def flush(self) -> None:
        self._flushed, self._chunk_from = time.monotonic(), math.inf
        self._writer.flush()

    def finish(self, outcome: dict[str, Any], overview: dict[str, Any]) -> None:
        """The end of the run; the file is whole and on the disk."""
        utc = self._clock.newest if self._clock is not None else 0
        self.flush()
        self._writer.attach(OVERVIEW, JSON, self._encode(overview), utc)
        self._writer.attach(OUTCOME, JSON, self._encode(outcome), utc)
        self._writer.finish()
        self._file.sync()

    def close(self) -> None:
        """Give the file and its lock back, finished or not."""
        self._file.close()

    @property
    def _running(self) -> RunClock:
        if self._clock is None:
            raise RuntimeError("a run file is written to after `begin`")
        return self._clock

    def _register(self, name: str) -> int:
        topic = next(topic for topic in TOPICS if topic.name == name)
        return self._writer.register(name, topic.schema_name, json.dumps(topic.schema).encode())

    def _add(self, topic: str, message: OfTick, log_time: int, publish_time: int) -> None:
        self._writer.add(self._channels[topic], log_time, publish_time, self._encode(message))

    def _sync(self) -> None:
        self._file.sync()
        self._synced = time.monotonic()

    def _check_room(self) -> None:
        free = self._disk.free(self.path.parent)
        if not free >= self._keep_free:
            raise DiskFull(free, self._keep_free)


def _begun(file: DiskFile, settings: dict[str, Any]) -> McapWriter:
    """The file with its head, and with what a torn one has to have above all: under which conditions it was made."""
    writer = McapWriter(file, f"pivotrig {versions()['pivotrig']}")
    run = settings["run"]
    words = {
        "run": run["id"],
        "label": run["label"],
        "started_at": run["started_at"],
        "controller": run["controller"]["name"],
        "trajectory": run["trajectory"]["name"],
        "rig": settings["rig"]["name"],
        "simulated": str(settings["simulated"]).lower(),
        "format": str(settings["format"]),
        "version": settings["versions"]["pivotrig"],
    }
    writer.describe(METADATA, words)
    writer.attach(SETTINGS, JSON, msgspec.json.encode(settings), 0)
    return writer


def _calibration(camera: CameraModel, clock: RunClock) -> foxglove.CameraCalibration:
    width, height = camera.size
    fx, fy, cx, cy = camera.fx, camera.fy, camera.cx, camera.cy
    return foxglove.CameraCalibration(
        time_s=clock.zero,
        tick=0,
        timestamp=foxglove.time_of(clock.start),
        frame_id=foxglove.CAMERA_FRAME,
        width=width,
        height=height,
        distortion_model="plumb_bob",
        D=camera.distortion,
        K=(fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0),
        R=(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        P=(fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0),
    )
