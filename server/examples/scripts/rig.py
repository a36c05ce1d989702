"""What all examples share: where the rig is, who asks, and what a refusal says.

Needs httpx (pip install httpx). The rig's address is the first argument, by default this computer's; a rig that asks
for a token gets the one in the environment variable PIVOTRIG_TOKEN.
"""

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx

ADDRESS = sys.argv[1] if len(sys.argv) > 1 else "http://127.0.0.1:8000"
TOKEN = os.environ.get("PIVOTRIG_TOKEN", "")


def told(answer: httpx.Response) -> None:
    """End with the rig's own words when it refuses something."""
    if answer.is_error:
        answer.read()
        sys.exit(f"{answer.request.method} {answer.request.url.path}: {answer.json()['detail']}")


@contextmanager
def rig(name: str) -> Iterator[httpx.Client]:
    """A client of the rig's interface, which lets others operate when it ends. The name is what they see until then."""
    headers = {"X-Client": name} | ({"Authorization": f"Bearer {TOKEN}"} if TOKEN else {})
    hooks = {"response": [told]}
    address = f"{ADDRESS}/api/v1"
    try:
        with httpx.Client(base_url=address, headers=headers, timeout=30.0, event_hooks=hooks) as client:
            try:
                yield client
            finally:
                client.delete("/operator")
    except httpx.TransportError as error:
        sys.exit(f"{ADDRESS}: {error}. Is this the rig's address, and does its server run?")


@contextmanager
def armed(client: httpx.Client) -> Iterator[None]:
    """Current may flow within; afterwards it may not, whatever has happened meanwhile."""
    client.post("/arm")
    try:
        yield
    finally:
        client.post("/disarm")


def wait_for(client: httpx.Client, holds, timeout_s: float = 60.0) -> dict:
    """The first state that is as wanted. Asking is also the sign of life that an attended run needs every 2 s."""
    end = time.monotonic() + timeout_s
    while not holds(state := client.get("/state").json()):
        if time.monotonic() > end:
            sys.exit(f"gave up after {timeout_s:g} s: the rig is {state['rig']} ({state['reason']})")
        time.sleep(0.1)
    return state
