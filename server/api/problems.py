"""Errors as RFC 9457 problem documents: what was wrong, what is allowed, nothing of the program's inside."""

from __future__ import annotations

import http
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from fastapi import FastAPI, Request, WebSocket
from fastapi.exceptions import RequestValidationError, WebSocketRequestValidationError
from pydantic import ValidationError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response

from control.registry import UnknownName
from control.safety import Refused
from control.trajectories import OutsideWorkspace
from control.wrong_values import SECRET_FIELDS
from server.catalogue.errors import BadCursor, CatalogueError, NoSuchRun, NotNow

SHOWN_LENGTH = 80

MOST_ERRORS = 100
"""Offending fields that are listed of one request; who sends more has another problem."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One refused request. errors: the offending fields, for a rejected body.  members: more of the document."""

    status: int
    title: str
    detail: str
    errors: tuple[Mapping[str, Any], ...] = ()
    headers: Mapping[str, str] = field(default_factory=dict)
    members: Mapping[str, Any] = field(default_factory=dict)

    def body(self) -> dict[str, Any]:
        document: dict[str, Any] = {
            "type": "urn:pivotrig:" + self.title.lower().replace(" ", "-"),
            "title": self.title,
            "status": self.status,
            "detail": self.detail,
        }
        if self.errors:
            document["errors"] = [dict(error) for error in self.errors]
        return {**document, **self.members}

    def response(self) -> Response:
        return JSONResponse(
            self.body(), self.status, dict(self.headers), media_type="application/problem+json"
        )


class Rejected(Exception):
    """A request that cannot be met, with the problem to answer."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.detail)
        self.problem = problem


def not_found(detail: str) -> Rejected:
    return Rejected(Problem(404, "Not found", detail))


def invalid(errors: Iterable[Mapping[str, Any]]) -> Problem:
    """A body or query whose fields are not acceptable; nothing has been changed."""
    listed = tuple(islice(errors, MOST_ERRORS))
    words = "; ".join(
        f"{error['field']}: {error['message']}" if error["field"] else error["message"] for error in listed
    )
    return Problem(422, "Not acceptable", words or "The request is not acceptable.", listed)


def invalid_field(location: tuple[str | int, ...], message: str, allowed: str = "") -> Problem:
    return invalid([offence(location, message, allowed)])


def offence(location: Iterable[Any], message: str, allowed: str = "") -> dict[str, Any]:
    """One offending field: where it is, what is wrong with it in words, and what is allowed."""
    path = [part if isinstance(part, int) else str(part) for part in location]
    error: dict[str, Any] = {"loc": path, "field": ".".join(str(part) for part in path), "message": message}
    if allowed:
        error["allowed"] = allowed
    return error


def offences(errors: Iterable[Mapping[str, Any]], prefix: tuple[str | int, ...] = ()) -> list[dict[str, Any]]:
    """Pydantic's list of errors, in words, without the values that cannot be written in JSON."""
    first = islice(errors, MOST_ERRORS)
    return [offence(location(error, prefix), message(error), allowed(error)) for error in first]


def location(error: Mapping[str, Any], prefix: tuple[str | int, ...]) -> tuple[Any, ...]:
    where = tuple(error.get("loc", ()))
    if error["type"] == "json_invalid" or where == ("body",):
        return (*prefix, "body")
    return (*prefix, *(where[1:] if where[:1] in (("body",), ("query",), ("path",)) else where))


def message(error: Mapping[str, Any]) -> str:
    kind, context = error["type"], error.get("ctx") or {}
    if kind == "json_invalid":
        return f"the body is not JSON: {context.get('error', 'it cannot be read')}"
    if kind == "missing":
        return "is missing"
    if kind == "extra_forbidden":
        return "is not a known field"
    words = error["msg"].removeprefix("Value error, ").removeprefix("Input should be ")
    return (
        f"must be {words}{received(error)}"
        if error["msg"].startswith("Input should be ")
        else words + received(error)
    )


def received(error: Mapping[str, Any]) -> str:
    """What came, for the values that a person can compare with what is allowed."""
    value = error.get("input")
    if not SECRET_FIELDS.isdisjoint(error.get("loc", ())):
        return ""
    if isinstance(value, bool) or value is None:
        return f", not {str(value).lower() if value is not None else 'null'}"
    if isinstance(value, int | float):
        return (
            f", not {value:g}" if abs(value) < 1e300 and math.isfinite(value) else ", not an endless number"
        )
    if isinstance(value, str):
        return f", not {value[:SHOWN_LENGTH]!a}"
    return ""


BOUNDS = {"gt": "more than {}", "ge": "at least {}", "lt": "less than {}", "le": "at most {}"}


def allowed(error: Mapping[str, Any]) -> str:
    context = error.get("ctx") or {}
    if "expected" in context:
        return str(context["expected"])
    bounds = [words.format(context[key]) for key, words in BOUNDS.items() if key in context]
    return "a finite number" if error["type"] == "finite_number" else ", ".join(bounds)


def install(app: FastAPI) -> None:
    """Answer every error of the application as a problem document."""
    app.add_exception_handler(Rejected, on_rejected)
    app.add_exception_handler(Refused, on_refused)
    app.add_exception_handler(UnknownName, on_unknown_name)
    app.add_exception_handler(RequestValidationError, on_invalid)
    app.add_exception_handler(ValidationError, on_invalid)
    app.add_exception_handler(WebSocketRequestValidationError, on_invalid_socket)
    app.add_exception_handler(OutsideWorkspace, on_outside)
    app.add_exception_handler(CatalogueError, on_catalogue)
    app.add_exception_handler(HTTPException, on_http)


async def on_rejected(_: Request, error: Exception) -> Response:
    assert isinstance(error, Rejected)
    return error.problem.response()


async def on_refused(_: Request, error: Exception) -> Response:
    return Problem(409, "Refused", str(error)).response()


async def on_outside(_: Request, error: Exception) -> Response:
    return invalid_field(("trajectory", "parameters"), str(error)).response()


async def on_catalogue(_: Request, error: Exception) -> Response:
    detail = str(error)
    if isinstance(error, NoSuchRun):
        return Problem(404, "Not found", detail).response()
    if isinstance(error, NotNow):
        return Problem(409, "Refused", detail).response()
    if isinstance(error, BadCursor):
        return invalid_field(("cursor",), detail).response()
    return Problem(503, "No catalogue", detail).response()


async def on_unknown_name(_: Request, error: Exception) -> Response:
    return invalid_field(("name",), str(error)).response()


async def on_invalid(_: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError | ValidationError)
    return invalid(offences(error.errors())).response()


async def on_invalid_socket(socket: WebSocket, error: Exception) -> None:
    assert isinstance(error, WebSocketRequestValidationError)
    await socket.send_denial_response(invalid(offences(error.errors())).response())


async def on_http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    title = http.HTTPStatus(error.status_code).phrase.capitalize()
    return Problem(
        error.status_code, title, explanation(request, error), headers=error.headers or {}
    ).response()


def explanation(request: Request, error: HTTPException) -> str:
    if error.status_code == 404:
        return f"There is nothing at {request.url.path}; /docs lists what there is."
    if error.status_code == 405:
        options = (error.headers or {}).get("Allow", "another method")
        return f"{request.url.path} does not take {request.method}; it takes {options}."
    return error.detail


def internal_error() -> Problem:
    """What a mistake of the program's own is answered with; the log has the rest."""
    return Problem(
        500,
        "Internal error",
        "The server made a mistake; its log says which. The rig's state is at /api/v1/state.",
    )
