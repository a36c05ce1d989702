"""JSON as the standard has it: no NaN, no infinity, no lone surrogates, nothing nested without end."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Coroutine
from typing import Any, NoReturn

from fastapi import Request, Response
from fastapi.routing import APIRoute


def parse(body: bytes) -> Any:
    """The value of a JSON text; raises json.JSONDecodeError with a reason in words."""
    try:
        text = body.decode("utf-8")
    except UnicodeDecodeError as error:
        raise json.JSONDecodeError("it is not UTF-8 text", "", error.start) from None
    try:
        value = json.loads(
            text,
            parse_constant=refuse_constant,
            parse_float=finite,
            parse_int=bounded,
            object_pairs_hook=fields,
        )
        json.dumps(value, ensure_ascii=False).encode("utf-8")
    except UnicodeEncodeError:
        raise json.JSONDecodeError("it has half of a surrogate pair in a string", text, 0) from None
    except RecursionError:
        raise json.JSONDecodeError("it is nested too deeply", text, 0) from None
    return value


def refuse_constant(name: str) -> NoReturn:
    raise json.JSONDecodeError(f"{name} is not a number in JSON; send a finite number", name, 0)


def finite(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        raise json.JSONDecodeError("a number is too large; send a finite number", digits, 0)
    return value


MOST_FIELDS = 1000
"""Of one object; the widest honest one, a rig file, has some twenty."""


def fields(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refused here, since each unknown field would be an error of its own to put into words."""
    if len(pairs) > MOST_FIELDS:
        raise json.JSONDecodeError(f"an object has {len(pairs)} fields; send at most {MOST_FIELDS}", "", 0)
    return dict(pairs)


LONGEST_INTEGER = 18
"""Digits of the longest integer taken; everything here fits into 64 bits."""


def bounded(digits: str) -> int:
    if len(digits) > LONGEST_INTEGER + 1:
        raise json.JSONDecodeError(f"an integer has more than {LONGEST_INTEGER} digits", digits[:20], 0)
    return int(digits)


class StrictRequest(Request):
    async def json(self) -> Any:
        return parse(await self.body())


class StrictRoute(APIRoute):
    """A route whose body is read by `parse`."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handler = super().get_route_handler()

        async def handle(request: Request) -> Response:
            return await handler(StrictRequest(request.scope, request.receive))

        return handle
