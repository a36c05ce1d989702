"""Try sweeps and tilts in simulation, beside the rig: best set, and the table of all runs."""

import time
from pathlib import Path

from rig import rig

DEFINITION = {
    "name": "sweep and tilt by script",
    "design": "grid",
    "repeats": 2,
    "axes": [
        {"of": "gait.sweep_deg", "values": [20, 30, 40]},
        {"of": "gait.tilt_deg", "values": [20, 30]},
    ],
}

with rig("a study") as client:
    study = client.post("/studies", json={"definition": DEFINITION}).json()
    while study["state"] in ("planned", "running"):
        time.sleep(0.5)
        study = client.get(f"/studies/{study['id']}").json()
        print(f"{study['state']}: {study['done']} of {study['total']}")
    table = Path("study.csv")
    table.write_bytes(client.get(f"/studies/{study['id']}/table.csv").content)
    print(f"{table}: {len(table.read_text().splitlines()) - 1} rows")
