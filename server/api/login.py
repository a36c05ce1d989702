"""The way in for people: a token becomes a session, kept by the browser in a cookie that no script can read."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Request, Response
from pydantic import Field
from starlette.datastructures import Headers

from server.access.guard import COOKIE, Guard, caller_address
from server.access.sessions import IDLE
from server.access.tokens import LONGEST
from server.api.body import StrictRoute
from server.api.problems import Problem, Rejected
from server.api.schemas import Edge

router = APIRouter(tags=["access"], route_class=StrictRoute)


class LoginBody(Edge):
    token: Annotated[str, Field(min_length=1, max_length=LONGEST)] = Field(
        title="Token", description="As it was printed when it was made."
    )


@router.post("/login")
async def login(body: LoginBody, request: Request, response: Response) -> dict[str, Any]:
    """Open a session; the answer sets its cookie and says the role."""
    guard: Guard = request.app.state.guard
    answer = guard.log_in(body.token, caller_address(request.scope))
    if isinstance(answer, Problem):
        raise Rejected(answer)
    cookie, role = answer
    response.set_cookie(
        COOKIE,
        cookie,
        max_age=int(IDLE),
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
    )
    return {"role": role.name.lower()}


@router.post("/logout", status_code=204)
async def logout(request: Request, response: Response) -> None:
    """End the session, with everything that it has open."""
    guard: Guard = request.app.state.guard
    guard.log_out(Headers(scope=request.scope))
    response.delete_cookie(COOKIE)
