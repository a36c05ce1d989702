"""`pivotrig study`: many runs from one definition, as a batch or on a rig."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from server.commands.outcome import USAGE, DataOption, RigOption, fail, open_rig_store
from server.commands.plugin_option import PluginOption, load_plugins
from server.commands.study_choice import opened_store
from server.commands.study_progress import print_outcome, say, time_text
from server.commands.study_sitting import Sitting, sit
from server.environment import check_environment

if TYPE_CHECKING:
    from control.studies.checking import Survey
    from control.studies.definition import StudyDefinition
    from server.studies.store import StudyStore
    from server.studies.study import Study

JobsOption = Annotated[
    int, typer.Option("--jobs", min=0, max=1024, help="Processes of a batch; 0: one for each processor core.")
]
DaskOption = Annotated[
    str | None,
    typer.Option("--dask", metavar="URL", help="Scheduler of a Dask cluster for a batch, tcp://HOST:8786."),
]
YesOption = Annotated[bool, typer.Option("--yes", help="Consent to current through the coils of a real rig.")]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")]


def study(
    file: Annotated[Path, typer.Argument(metavar="FILE.toml", help="Definition of the study.")],
    jobs: JobsOption = 0,
    dask: DaskOption = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the newest unfinished study of this definition.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Only check it, and say what it will take.")
    ] = False,
    rig: RigOption = None,
    data: DataOption = None,
    plugin: PluginOption = None,
    yes: YesOption = False,
    as_json: JsonOption = False,
) -> None:
    """Carry out a study: every set of values, as often as its definition says; a batch or on the rig."""
    check_environment()
    load_plugins(plugin)
    definition = read_definition(file)
    sitting = Sitting(jobs, dask, rig, data, yes, as_json)
    with opened_store(data) as store:
        known = to_resume(store, definition) if resume else None
        survey = surveyed(definition, sitting)
        if dry_run:
            print_outcome(foreseen(definition, survey, sitting), as_json=as_json)
            return
        tell(definition, survey, sitting)
        sit(known or store.create(definition), sitting)


def read_definition(file: Path) -> StudyDefinition:
    """The definition in a TOML file; ends the command where it cannot be used."""
    from control.studies.definition import StudyDefinition
    from control.studies.errors import StudyError

    try:
        return StudyDefinition.from_toml(file.read_text("utf-8"))
    except OSError as error:
        raise fail(f"cannot read {file}: {error.strerror or error}", USAGE) from error
    except (StudyError, UnicodeDecodeError) as error:
        raise fail(f"{file}: {error}", USAGE) from error


def to_resume(store: StudyStore, definition: StudyDefinition) -> Study:
    """The newest unfinished study of exactly this definition; ends the command where there is none."""
    from server.studies.changes import differences

    if (same := store.newest_like(definition)) is not None:
        return same
    if (named := store.newest_named(definition.name)) is not None:
        changed = "; ".join(differences(named.definition, definition))
        raise fail(
            f"the definition has changed since the study {named.id} was begun: {changed}. "
            f"`pivotrig studies resume {named.id}` goes on with it as it was; without --resume a new study begins",
            USAGE,
        )
    raise fail(f"there is no unfinished study {definition.name!r}; leave --resume out to begin one", USAGE)


def surveyed(definition: StudyDefinition, sitting: Sitting) -> Survey:
    """Every set was looked at; ends the command with all that is wrong."""
    from control.studies.checking import check
    from control.studies.errors import StudyError

    workspace = None
    if definition.on == "rig":
        workspace = 0.5e-3 * open_rig_store(sitting.rig, sitting.data).settings.limits.workspace_mm
    try:
        return check(definition, workspace)
    except StudyError as error:
        raise fail(f"the study {definition.name!r} cannot be carried out:\n{error}", USAGE) from error


def foreseen(definition: StudyDefinition, survey: Survey, sitting: Sitting) -> dict[str, object]:
    """What the study will take, by name."""
    from server.studies.expectation import expected_wall

    simulated = definition.on == "rig" and open_rig_store(sitting.rig, sitting.data).settings.is_simulated
    return {
        "name": definition.name,
        "on": definition.on,
        "sets": survey.sets,
        "runs": survey.runs,
        "rig_s": round(survey.walking + survey.resting, 1),
        "wall_s": round(expected_wall(definition, survey, sitting.jobs, headless=simulated), 1),
    }


def tell(definition: StudyDefinition, survey: Survey, sitting: Sitting) -> None:
    """The same in a sentence, before it begins; on stderr."""
    found = foreseen(definition, survey, sitting)
    sets = "1 set" if survey.sets == 1 else f"{survey.sets} sets"
    runs = "1 run" if survey.runs == 1 else f"{survey.runs} runs"
    walking = time_text(survey.walking + survey.resting)
    say(
        f"{definition.name}: {sets}, {runs}, {walking} of rig time; about {time_text(float(str(found['wall_s'])))}"
    )
