"""A site of somebody else's: its page tries what a hostile page can try upon a rig, and says what it got."""

from __future__ import annotations

import contextlib
import json
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

ATTACK = """<!doctype html><title>elsewhere</title><script type="module">
const rig = RIG;
const got = (window.got = {});
const body = JSON.stringify({});
const simple = { method: "POST", mode: "no-cors", credentials: "include", body };
const tries = {
  read: async () => (await fetch(`${rig}/api/v1/state`, { credentials: "include" })).status,
  act: async () => (await fetch(`${rig}/api/v1/arm`, { method: "POST", credentials: "include",
    headers: { "Content-Type": "application/json" }, body })).status,
  stop: async () => (await fetch(`${rig}/api/v1/estop`, simple)).type,
  beacon: async () => navigator.sendBeacon(`${rig}/api/v1/estop`, body),
  picture: () => loaded("img", `${rig}/api/v1/camera/snapshot.jpg`),
  stream: () => loaded("img", `${rig}/api/v1/camera/stream.mjpg`),
  module: () => loaded("script", `${rig}/static/main.js`),
  telemetry: () => heard("/api/v1/telemetry"),
  camera: () => heard("/api/v1/camera"),
  scene: () => heard("/scene"),
};
const ws = rig.replace("http", "ws");
const loaded = (kind, src) => new Promise((done) => {
  const element = Object.assign(document.createElement(kind), { src });
  element.onload = () => done("loaded");
  element.onerror = () => done("refused");
  document.body.append(element);
});
const heard = (path) => new Promise((done) => {
  const socket = new WebSocket(ws + path);
  socket.onopen = () => done("open");
  socket.onmessage = () => done("message");
  socket.onerror = () => done("refused");
});
for (const [name, attempt] of Object.entries(tries)) {
  got[name] = await attempt().catch((error) => error.name);
}
const frame = Object.assign(document.createElement("iframe"), { name: "into" });
document.body.append(frame);
const form = Object.assign(document.createElement("form"),
  { action: `${rig}/api/v1/estop`, method: "POST", enctype: "text/plain", target: "into" });
form.append(Object.assign(document.createElement("input"), { name: '{"x":"', value: '"}' }));
document.body.append(form);
frame.onload = () => { got.done = true; };
form.submit();
</script><body></body>"""


class Page(BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        assert isinstance(self.server, Site)
        page = ATTACK.replace("RIG", json.dumps(self.server.rig)).encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(page)))
        self.end_headers()
        self.wfile.write(page)

    def log_message(self, format: str, *args: object) -> None:
        """Nothing: the page keeps what it got."""


class Site(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, rig: str) -> None:
        super().__init__(("127.0.0.1", 0), Page)
        self.rig = rig


@contextlib.contextmanager
def site_against(rig: str) -> Iterator[str]:
    """The address of its page, under another name than the rig's so that it is another site, too."""
    with Site(rig) as site:
        thread = threading.Thread(target=site.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            yield f"http://localhost:{site.server_address[1]}/"
        finally:
            site.shutdown()
            thread.join()
