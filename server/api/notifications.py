"""Who outside is told of a fault or of the end of a study: a try of what the rig file says."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from starlette.requests import HTTPConnection

from control.safety import Refused
from server.api.access import TheRig
from server.api.body import StrictRoute
from server.api.problems import Problem, Rejected
from server.notification_section import shown_webhook
from server.notifier import Notifier
from server.own_thread import in_a_thread
from server.webhook import Call, NotDelivered

router = APIRouter(prefix="/notifications", tags=["notifications"], route_class=StrictRoute)

trying = asyncio.Lock()
"""One at a time: each keeps a thread waiting for the other side."""


async def the_notifier(connection: HTTPConnection) -> Notifier:
    return connection.app.state.notifier


TheNotifier = Annotated[Notifier, Depends(the_notifier)]


@router.post("/test")
async def test(rig: TheRig, notifier: TheNotifier) -> dict[str, Any]:
    """Send one notification to the webhook of the rig file, once, and say what came of it."""
    section = rig.settings.notifications
    if not section.webhook_url:
        raise Refused("no webhook is set; give notifications.webhook_url an address and save it first")
    if trying.locked():
        raise Refused("a test is under way already; wait for its answer")
    body = notifier.body("test", "this is a test, sent by hand from the dashboard")
    async with trying:
        call = Call(section.webhook_url, section.timeout_s)
        try:
            status = await in_a_thread(partial(call.post, body), "webhook's test")
        except NotDelivered as error:
            raise Rejected(Problem(502, "Not delivered", f"It was not delivered: {error}.")) from error
        finally:
            call.break_off()  # the server may end, or who has asked may have gone
    return {"status": status, "to": shown_webhook(section.webhook_url), "sent": body}
