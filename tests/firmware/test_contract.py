"""The numbers that host and firmware share come from one source."""

from __future__ import annotations

from control.firmware import contract


def test_the_committed_header_is_the_one_that_the_hosts_definitions_give() -> None:
    written = contract.HEADER.read_text(encoding="utf-8")
    assert written == contract.rendered(), "run `python -m control.firmware.contract`"
