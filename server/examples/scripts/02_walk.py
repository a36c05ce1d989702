"""Walk a small eight, wait for its end, print the figures and keep the table."""

from pathlib import Path

from rig import armed, rig, wait_for

with rig("an eight") as client:
    wait_for(client, lambda state: state["tracking"] == "locked")
    with armed(client):
        run = client.post(
            "/runs",
            json={
                "controller": {"name": "planner", "parameters": {}},
                "trajectory": {
                    "name": "eight",
                    "parameters": {"width_mm": 40, "height_mm": 40, "period_s": 60},
                },
                "duration_s": 5,
                "label": "an eight by script",
            },
        ).json()
        wait_for(client, lambda state: state["run"] is None or state["rig"] != "running", timeout_s=120)
    done = client.get(f"/runs/{run['id']}").json()
    print(
        f"{done['state']}: mean error {done['metrics']['mean_error_mm']:.2f} mm in {done['metrics']['steps']} steps"
    )
    table = Path("eight.csv")
    table.write_bytes(client.get(f"/runs/{run['id']}/samples.csv").content)
    print(f"{table}: {len(table.read_text().splitlines()) - 1} rows")
