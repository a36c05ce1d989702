"""Unattended runs, one after the other. A run belongs to the server, and goes on if this computer fails.

When the script ends by itself, or is refused something, nobody watches the night any more: it disarms.
"""

from rig import armed, rig, wait_for

SWEEPS_DEG = (20, 30)

with rig("overnight") as client:
    wait_for(client, lambda state: state["tracking"] == "locked")
    client.post("/operator", json={"note": "sweeps overnight, please do not touch"})
    with armed(client):
        for sweep in SWEEPS_DEG:
            if client.get("/state").json()["rig"] == "disarmed":
                client.post("/arm")
            run = client.post(
                "/runs",
                json={
                    "gait": {"sweep_deg": sweep},
                    "duration_s": 3,
                    "unattended": True,
                    "label": f"sweep {sweep}°",
                    "tags": ["overnight"],
                },
            ).json()
            state = wait_for(
                client, lambda state: state["run"] is None or state["rig"] == "held", timeout_s=300
            )
            if state["rig"] == "held":  # an hour later somebody may have to look; here the night ends
                client.post("/runs/current/stop")
                print("held:", state["reason"])
                break
            done = client.get(f"/runs/{run['id']}").json()
            print(f"sweep {sweep}°: {done['state']}, mean error {done['metrics']['mean_error_mm']:.2f} mm")
