"""Somebody who calibrates a simulated camera over REST."""

import asyncio
import contextlib

import httpx
import numpy as np

from server.app import create_app
from server.archive import Archive
from server.assembly import build_machine
from server.calibration.optics import assumed_model
from server.rig import Rig
from server.rig_changes import RigChanges
from server.rig_file import RigStore

PATIENCE = 30.0
GRID = np.array([(x, y) for x in np.linspace(-0.06, 0.06, 7) for y in np.linspace(-0.06, 0.06, 7)])


class Wizard:
    """Somebody at the page of a served rig with its file."""

    def __init__(self, rig, path, api):
        self.rig, self.path, self.api = rig, path, api

    async def ask(self, verb, path, status=200, /, **body):
        answer = await self.api.request(verb, path, json=body or None)
        assert answer.status_code == status, answer.text
        return answer.json()

    async def show(self, pose="flat", shown=True):
        return await self.ask("PUT", "/simulation/board", shown=shown, pose=pose)

    async def until(self, condition):
        async with asyncio.timeout(PATIENCE):
            while not condition(state := await self.ask("GET", "/state")):
                await asyncio.sleep(0.02)
        return state

    def position_error(self):
        """RMS over the workspace of where the rig places what its camera sees, m."""
        machine = self.rig.machine
        truth = assumed_model(machine.settings.camera)
        away = machine.camera_model.to_workspace(truth.to_image(GRID)) - GRID
        return float(np.sqrt(np.mean(np.sum(away**2, axis=1))))


@contextlib.asynccontextmanager
async def wizard(serve, path, as_run=lambda settings: settings):
    store = RigStore(path)
    archive = Archive.open(path.parent)
    rig = Rig(build_machine(as_run(store.settings), realtime=True), recorder=archive.recorder)
    changes = RigChanges(rig, store, as_run)
    async with (
        serve(create_app(rig, archive, changes=changes)) as at,
        httpx.AsyncClient(base_url=at.url + "/api/v1", timeout=PATIENCE) as api,
    ):
        yield Wizard(rig, path, api)
