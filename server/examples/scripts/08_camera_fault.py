"""On a simulated rig: take a picture, unplug the camera while the robot walks, and watch the rig let go by itself."""

import sys
from pathlib import Path

from rig import armed, rig, wait_for

with rig("a fault") as client:
    if not client.get("/state").json()["simulated"]:
        sys.exit("This rig is real; faults can be put into a simulated one only (pivotrig serve --sim).")
    wait_for(client, lambda state: state["tracking"] == "locked")
    Path("plate.jpg").write_bytes(client.get("/camera/snapshot.jpg").content)
    try:
        with armed(client):
            client.post("/runs", json={"duration_s": 60, "label": "camera unplugged"})
            wait_for(client, lambda state: state["run"] is not None and state["run"]["elapsed_s"] > 1.0)
            client.post("/simulation/faults", json={"name": "camera_unplugged"})
            state = wait_for(client, lambda state: state["rig"] != "running")
            print(f"{state['rig']}: {state['reason']}")
            print("currents, A:", state["currents_A"])
    finally:
        client.delete("/simulation/faults")
