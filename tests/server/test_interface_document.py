"""The OpenAPI document: whole, and kept by the server for whatever somebody sends."""

import contextlib
import os
from urllib.parse import urlsplit

import hypothesis
import pytest
import requests
import schemathesis
from hypothesis import HealthCheck, Phase, settings
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.processes import served

FULL = os.environ.get("PIVOTRIG_FULL") == "1"
CASES = 40 if FULL else 2
"""Requests of each operation."""
WITHIN = 60.0
"""Longest that an answer may take, s; an export makes a figure first."""
ENDLESS = "/api/v1/camera/stream.mjpg"
CHECKS = [not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance]
NOT_NOW = 503
"""Of a rig without a picture, say: no mistake of the server's."""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with served(tmp_path_factory.mktemp("data"), "--sim") as server:
        server.until(lambda state: state["tracking"] == "locked")
        yield server


@pytest.fixture(scope="module")
def document(server):
    return requests.get(f"{server.address}/openapi.json", timeout=10).json()


def operations(document):
    return [
        (place, method, operation)
        for place, methods in document["paths"].items()
        for method, operation in methods.items()
    ]


def references(value):
    if isinstance(value, dict):
        if isinstance(value.get("$ref"), str):
            yield value["$ref"]
        for each in value.values():
            yield from references(each)
    elif isinstance(value, list):
        for each in value:
            yield from references(each)


def test_every_operation_says_what_it_does_and_what_it_answers(document):
    listed = operations(document)
    assert len({operation["operationId"] for _, _, operation in listed}) == len(listed) > 90
    for place, method, operation in listed:
        assert operation["summary"], (method, place)
        assert operation["tags"], (method, place)
        answers = operation["responses"]
        [first, *_] = [status for status in answers if status.startswith("2")]
        assert first == "204" or answers[first]["content"], (method, place)
        assert {"401", "403", "422", "429"} <= set(answers), (method, place)


def test_every_reference_of_the_document_leads_somewhere(document):
    found = set(references(document))
    assert len(found) > 40
    for reference in found:
        place = document
        for name in reference.removeprefix("#/").split("/"):
            place = place[name]


def test_who_may_come_in_unasked_is_said(document):
    open_places = {place for place, _, operation in operations(document) if operation["security"] == []}
    assert open_places == {"/api/v1/health", "/api/v1/login"}
    assert set(document["components"]["securitySchemes"]) == {"bearer", "session"}


def test_whatever_is_sent_is_answered_as_the_document_says(server):
    schema = schemathesis.openapi.from_url(f"{server.address}/openapi.json")
    asked = 0
    for found in schema.get_all_operations():
        operation = found.ok()
        if operation.path == ENDLESS:
            continue
        asked += tried(operation, server.address)
        with contextlib.suppress(Exception):
            server.post("/disarm")
    assert asked >= 90 * CASES / 2
    assert server.get("/health")["status"] == "ok"


def tried(operation, address):
    count = 0

    @hypothesis.given(case=operation.as_strategy())
    @hypothesis.seed(20)
    @settings(
        max_examples=CASES,
        deadline=None,
        database=None,
        phases=[Phase.explicit, Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    def attempt(case):
        nonlocal count
        count += 1
        answer = case.call(base_url=address, timeout=WITHIN)
        checks = CHECKS if answer.status_code != NOT_NOW else CHECKS[1:]
        case.validate_response(answer, checks=checks)

    attempt()
    return count


def test_the_endless_stream_is_of_the_kind_that_is_said(server, document):
    [kind] = document["paths"][ENDLESS]["get"]["responses"]["200"]["content"]
    with requests.get(server.address + ENDLESS, stream=True, timeout=10) as answer:
        assert answer.headers["content-type"].split(";")[0] == kind
        assert answer.raw.read(10)
    assert urlsplit(answer.url).path == ENDLESS
