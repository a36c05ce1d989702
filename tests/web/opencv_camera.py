"""Writes `opencv_points.json`: where OpenCV sees points of the plate through cameras of several kinds."""

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np

FILE = Path(__file__).with_name("opencv_points.json")
INTRINSICS = {"fx": 1292.3, "fy": 1287.9, "cx": 321.4, "cy": 238.2}
# Turned over to look down, with a lean; the vector of a rotation, rad.
LEANS = {"straight": (np.pi, 0.0, 0.0), "leaning": (np.pi - 0.21, 0.12, -0.3)}
# k1, k2, p1, p2, k3.
LENSES = {
    "ideal": (0.0,) * 5,
    "barrel": (-0.28, 0.11, 0.0, 0.0, 0.0),
    "crooked": (-0.12, 0.02, 0.004, -0.003, 0.01),
}
TRANSLATION_MM = (4.0, -3.0, 350.0)
PLACES_MM = [
    (x, y, height) for x in (-55.0, 0.0, 31.5) for y in (-42.0, 12.25, 40.0) for height in (0.0, 3.0)
]


def seen(lean: tuple[float, ...], lens: tuple[float, ...]) -> dict[str, Any]:
    rotation = cv2.Rodrigues(np.array(lean))[0]
    matrix = np.array(
        [[INTRINSICS["fx"], 0, INTRINSICS["cx"]], [0, INTRINSICS["fy"], INTRINSICS["cy"]], [0, 0, 1]]
    )
    points, _ = cv2.projectPoints(
        np.array(PLACES_MM), np.array(lean), np.array(TRANSLATION_MM), matrix, np.array(lens)
    )
    model = {
        **INTRINSICS,
        "distortion": lens,
        "rotation": rotation.ravel().tolist(),
        "translation_mm": TRANSLATION_MM,
    }
    return {"model": model, "places_mm": PLACES_MM, "points_px": points.reshape(-1, 2).tolist()}


def table() -> dict[str, Any]:
    cameras = {
        f"{lean_name}, {lens_name}": seen(lean, lens)
        for lean_name, lean in LEANS.items()
        for lens_name, lens in LENSES.items()
    }
    return json.loads(json.dumps(cameras))


if __name__ == "__main__":
    FILE.write_text(json.dumps(table(), separators=(",", ":")) + "\n")
