"""`pivotrig runs edit`, `delete` and `prune`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer
from pydantic import ValidationError

from server.commands.answers import one_line
from server.commands.outcome import FAILED, USAGE, DataOption, console, fail
from server.commands.run_choice import RunArgument, RunsArgument, id_of, opened_shelf
from server.commands.sizes import days, gigabytes, size_text
from server.section import in_words

if TYPE_CHECKING:
    from server.catalogue.records import Loose, RunRecord

NAMED = 10
"""Runs that are named before one is asked whether they may go."""

YesOption = Annotated[bool, typer.Option("--yes", help="Delete without asking.")]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")]


def edit(
    id: RunArgument,
    label: Annotated[str | None, typer.Option(help="A name.")] = None,
    notes: Annotated[str | None, typer.Option(help="Whatever is worth remembering.")] = None,
    tag: Annotated[list[str] | None, typer.Option(help="Add a tag; may be given again.")] = None,
    untag: Annotated[list[str] | None, typer.Option(help="Take a tag away; may be given again.")] = None,
    pin: Annotated[bool | None, typer.Option("--pin/--unpin", help="A pinned run is never deleted.")] = None,
    data: DataOption = None,
    as_json: JsonOption = False,
) -> None:
    """Change label, notes, tags or pin of a run."""
    given = {"label": label, "notes": notes, "pinned": pin}
    changes = {name: value for name, value in given.items() if value is not None}
    if not (changes or tag or untag):
        raise fail("say what is to be changed: --label, --notes, --tag, --untag, --pin or --unpin", USAGE)
    from server.catalogue.edits import edit as edit_run
    from server.catalogue.record_json import record_json

    with opened_shelf(data) as shelf:
        record = shelf.catalogue.get(id_of(shelf.catalogue, id))
        if tag or untag:
            changes["tags"] = [each for each in (*record.tags, *(tag or ())) if each not in (untag or ())]
        record = edit_run(shelf, record.id, _checked(changes))
    if as_json:
        print(json.dumps(record_json(record), allow_nan=False))
    else:
        tags = ", ".join(record.tags) or "no tags"
        print(f"{record.id}  {record.label or '(no label)'}  [{tags}]{'  pinned' if record.pinned else ''}")


def _checked(changes: dict[str, Any]) -> dict[str, Any]:
    """Within the same bounds as over REST."""
    from server.api.run_bodies import RunEdit

    try:
        return RunEdit(**changes).model_dump(exclude_none=True)
    except ValidationError as error:
        raise fail(f"the run cannot be changed like that:\n{in_words(error)}", USAGE) from error


def delete(ids: RunsArgument, yes: YesOption = False, data: DataOption = None) -> None:
    """Delete runs with their recordings."""
    from server.catalogue.deleting import delete_run, require_deletable

    with opened_shelf(data) as shelf:
        found = [id_of(shelf.catalogue, id) for id in dict.fromkeys(ids)]
        records = [shelf.catalogue.get(id) for id in dict.fromkeys(found)]
        for record in records:
            require_deletable(record)
        _ask(records, yes)
        for record in records:
            delete_run(shelf, record.id)
    print(f"deleted: {_amount(records)}")


def prune(
    older_than: Annotated[str | None, typer.Option(help="Runs older than this, such as 30d.")] = None,
    until_size: Annotated[
        str | None, typer.Option(help="The oldest, until all recordings take this, such as 20GB.")
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only say what would go.")] = False,
    yes: YesOption = False,
    data: DataOption = None,
    as_json: JsonOption = False,
) -> None:
    """Delete old runs. Pinned ones, and those that go on, always stay."""
    if older_than is None and until_size is None:
        raise fail("say which runs may go: --older-than 30d, --until-size 20GB, or both", USAGE)
    from server.catalogue.retention import Policy, prunable
    from server.catalogue.retention import prune as prune_runs

    policy = Policy(days(older_than) if older_than else 0.0, gigabytes(until_size) if until_size else 0.0)
    with opened_shelf(data) as shelf:
        chosen = prunable(shelf, policy)
        if chosen and not dry_run:
            _ask(chosen, yes)
            chosen = prune_runs(shelf, policy)
    if as_json:
        ids, size = [run.id for run in chosen], sum(run.size_bytes for run in chosen)
        print(json.dumps({"runs": ids, "bytes": size, "dry_run": dry_run}))
    else:
        print(f"{'would go' if dry_run else 'deleted'}: {_amount(chosen)}")


def _ask(runs: Sequence[RunRecord | Loose], yes: bool) -> None:
    """Ends the command unless the person agrees, or has said --yes."""
    if yes:
        return
    for run in runs[:NAMED]:
        console.print(f"  {run.id}  {run.label}  {size_text(run.size_bytes)}", markup=False, highlight=False)
    if len(runs) > NAMED:
        console.print(f"  and {len(runs) - NAMED} more")
    console.print(f"Delete {_amount(runs)}? This cannot be undone. (y/N)", end=" ")
    if one_line().strip().lower() not in ("y", "yes"):
        raise fail("nothing was deleted; agree when asked, or say --yes", FAILED)


def _amount(runs: Sequence[RunRecord | Loose]) -> str:
    number = "1 run" if len(runs) == 1 else f"{len(runs)} runs"
    return f"{number}, {size_text(sum(run.size_bytes for run in runs))}"
