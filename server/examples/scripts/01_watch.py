"""Look at the rig: its state, its pose and what has happened. Changes nothing."""

from rig import rig

with rig("a watcher") as client:
    state = client.get("/state").json()
    print(f"{state['rig']}: {state['reason']}; the robot is {state['tracking']}")
    if state["pose"] is not None:
        print("pose: {x_mm:.1f} mm, {y_mm:.1f} mm, {heading_deg:.1f}°".format(**state["pose"]))
    print(f"loop: {state['loop']['rate_Hz']} Hz")
    for event in client.get("/events", params={"limit": 5}).json()["events"]:
        print(f"{event['at']} {event['severity']}: {event['message']}")
