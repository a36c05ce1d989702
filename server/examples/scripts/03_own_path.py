"""Save a path of your own, look how long it is, and choose it for the next run."""

from rig import rig

POINTS_MM = [[-30, -30], [-10, -35], [10, -30], [20, -15], [20, 5]]

with rig("my paths") as client:
    known = [each["name"] for each in client.get("/trajectories").json()]
    if "my bow" not in known:
        client.post(
            "/trajectories",
            json={"name": "my bow", "points_mm": POINTS_MM, "closed": False, "speed_mm_s": 2.0},
        )
    shown = client.post("/trajectories/preview", json={"name": "my bow"}).json()
    print(f"{shown['length_mm']:.1f} mm in {shown['duration_s']:.1f} s")
    selection = client.get("/selection").json()
    client.put("/selection", json=selection | {"trajectory": {"name": "my bow", "parameters": {}}})
    print("chosen:", client.get("/selection").json()["trajectory"]["name"])
