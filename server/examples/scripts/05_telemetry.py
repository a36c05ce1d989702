"""Live telemetry for a moment, ten ticks a second. Needs websockets (pip install websockets)."""

import json

from rig import ADDRESS, TOKEN
from websockets.sync.client import connect

address = ADDRESS.replace("http", "ws", 1) + "/api/v1/telemetry?rate_Hz=10&client=a+listener"
headers = {"Authorization": f"Bearer {TOKEN}"} if TOKEN else {}
with connect(address, additional_headers=headers) as socket:
    ticks = 0
    while ticks < 10:
        message = json.loads(socket.recv())
        if message["type"] == "tick":
            ticks += 1
            print(f"{message['time_s']:.2f} s {message['rig']} {message['tracking']}")
        else:
            print("heard:", message["type"])
