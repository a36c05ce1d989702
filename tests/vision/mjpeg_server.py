"""A network camera in a process of its own: MJPEG over HTTP, 80x64 px, of a grey that grows.

python -m tests.vision.mjpeg_server PORT RATE [LOGIN]: prints its address; LOGIN is USER:PASSWORD.
"""

from __future__ import annotations

import base64
import sys
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import cv2
import numpy as np

WIDTH, HEIGHT = 80, 64


class Camera(BaseHTTPRequestHandler):
    rate = 30.0
    login = ""

    def do_GET(self) -> None:
        expected = f"Basic {base64.b64encode(self.login.encode()).decode()}"
        if self.login and self.headers.get("Authorization") != expected:
            self.send_response(401)
            self.send_header("WWW-Authenticate", 'Basic realm="camera"')
            self.end_headers()
            return
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        try:
            self.stream()
        except OSError:  # nobody looks any more
            return

    def stream(self) -> None:
        number = 0
        while True:
            grey = np.full((HEIGHT, WIDTH, 3), 16 + number % 200, np.uint8)
            jpeg = cv2.imencode(".jpg", grey)[1].tobytes()
            header = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
            self.wfile.write(header.encode() + jpeg + b"\r\n")
            self.wfile.flush()
            number += 1
            time.sleep(1.0 / self.rate)

    def log_message(self, format: str, *args: object) -> None:
        """Says nothing."""


def main(port: str, rate: str, login: str = "") -> None:
    Camera.rate, Camera.login = float(rate), login
    server = ThreadingHTTPServer(("127.0.0.1", int(port)), Camera)
    server.daemon_threads = True
    print(f"http://127.0.0.1:{server.server_port}/video", flush=True)
    server.serve_forever()


if __name__ == "__main__":
    main(*sys.argv[1:])
