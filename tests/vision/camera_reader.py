"""Reads a camera in a process of its own and prints a line of JSON for each frame, trouble and note.

python -m tests.vision.camera_reader URI WIDTH HEIGHT RATE [EXPOSURE]: until a line comes in; then it closes the camera
and prints how long that took.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from typing import Any

from vision.sources.opening import CameraRequest, open_camera


def main(uri: str, width: str, height: str, rate: str, exposure: str = "") -> None:
    request = CameraRequest(
        (int(width), int(height)), float(rate), exposure=float(exposure) if exposure else None
    )
    camera = open_camera(uri, request)
    asked_to_end = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.readline(), asked_to_end.set()), daemon=True).start()
    while not asked_to_end.is_set():
        frame = camera.read(0.034)
        for note in camera.take_notes():
            say(note=note.message, severity=note.severity)
        if frame is None:
            say(trouble=camera.trouble, at=camera.now())
        else:
            grey = float(frame.image.mean())
            say(
                index=frame.index,
                captured_at=frame.captured_at,
                at=camera.now(),
                grey=grey,
                identity=camera.identity,
            )
    begin = time.monotonic()
    camera.close()
    say(closed_after=time.monotonic() - begin)


def say(**line: Any) -> None:
    print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
