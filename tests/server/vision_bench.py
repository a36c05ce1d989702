"""A served rig whose colours are changed, over REST and in its file."""

from __future__ import annotations

import contextlib
import tomllib

import httpx
from rig_file_bench import RigFileBench

from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.rig import Rig
from server.rig_changes import RigChanges
from server.rig_file import RigStore

BLUE = {"hue_deg": [200.0, 260.0], "saturation": [80, 255], "value": [40, 255]}
RED = {"hue_deg": [340.0, 20.0], "saturation": [110, 255], "value": [60, 255]}
COMMENTED = "[vision]\nvalue = [60, 255]   # a red robot\n"


class VisionBench(RigFileBench):
    """A served rig with its file, asked for what the robot looks like."""

    async def robot_px(self) -> tuple[float, float]:
        """Where the robot is in the picture."""
        await self.until("/vision", lambda vision: vision["tracking"] == "locked")
        pose = self.rig.snapshot.pose
        assert pose is not None
        return self.rig.machine.camera_model.to_pixel(pose.x, pose.y, self.rig.machine.body_height)

    async def change(self, **changes) -> httpx.Response:
        return await self.api.patch("/vision", json=changes)

    def in_use(self) -> dict:
        """The colours that the tracker itself has."""
        colour = self.rig.machine.tracker._settings.colour
        return {
            "hue_deg": list(colour.hue),
            "saturation": list(colour.saturation),
            "value": list(colour.value),
        }

    def on_disk(self) -> dict:
        return tomllib.loads(self.path.read_text())["vision"]


@contextlib.asynccontextmanager
async def bench(serve, store: RigStore):
    archive = Archive.open(store.path.parent)
    rig = Rig(build_machine(store.settings, realtime=True), recorder=archive.recorder)
    changes = RigChanges(rig, store, lambda settings: settings)
    async with serve(create_app(rig, archive, changes=changes)) as at:
        one = VisionBench(at, rig, store.path)
        async with one.api:
            yield one
