"""Swing the robot by hand for two seconds. Each order holds for 0.3 s at most, so a script that dies stops it."""

import time

from rig import armed, rig, wait_for

with rig("a jog") as client:
    before = wait_for(client, lambda state: state["tracking"] == "locked")["pose"]["heading_deg"]
    with armed(client):
        end = time.monotonic() + 2.0
        while time.monotonic() < end:
            client.post("/manual", json={"pivot": 1, "rate_deg_s": 20})
            time.sleep(0.1)
        after = client.get("/state").json()["pose"]["heading_deg"]
    print(f"turned by {(after - before + 180) % 360 - 180:.0f}°")
